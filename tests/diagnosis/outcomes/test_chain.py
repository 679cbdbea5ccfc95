"""Outcomes of simulated blocks, from runs to the answer in files and to further runs."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import models
from diagnosis.fit.unknowns import library
from diagnosis.outcomes import OutcomeDiagnosis, diagnose_outcomes, predict_outcomes
from diagnosis.outcomes.candidates import repairs
from diagnosis.outcomes.files import EXTENDED, JSON, PAGE, RUNS, prediction_text, read_answer, write_answer
from grids.motions import Motion
from grids.recordings.outcomes import Outcomes
from grids.specimen import Specimen, read_specimen
from models.base import Mechanism
from models.errors import InputError
from models.model import Model
from study.provenance import program

BLOCK = Specimen(
    "block", "housner", {"height": 1.0, "aspect_ratio": 0.25, "mass": 100.0}, {"aspect_ratio": 0.01, "height": 0.01}
)
SCATTER = 0.12
STEP = 0.01


def runs_of(seed: int, hidden: dict[str, float], groups: int = 6, each: int = 6) -> Outcomes:
    """Motions of a few sines in an envelope, each at several scales, and what becomes of the block."""
    rng = np.random.default_rng(seed)
    model = models.get(BLOCK.model)
    time = STEP * np.arange(300)
    motions, names, fell = [], [], []
    for group in range(groups):
        sines = [rng.normal() * np.sin(2 * np.pi * f * time + rng.uniform(0, 6)) for f in rng.uniform(0.8, 4.0, 5)]
        shape = np.sum(sines, axis=0) * np.exp(-(((time - 1.4) / 0.6) ** 2))
        for scale in np.geomspace(2.0, 14.0, each):
            motion = Motion(f"{group}-{len(motions)}", STEP, shape / np.abs(shape).max() * scale)
            motions.append(motion)
            names.append(f"group {group}")
            values = {k: np.array([v]) for k, v in {**BLOCK.parameters, **hidden}.items()}
            placed = np.exp(SCATTER * rng.normal(size=1))
            out = model.evaluate(values, motion.shaking(), placed, outputs=("overturned",), tail=5.0)["overturned"]
            fell.append(bool(out[0]))
    return Outcomes("runs", tuple(m.name for m in motions), tuple(motions), tuple(names), np.array(fell))


@pytest.fixture(scope="module", autouse=True)
def few_suspects() -> Iterator[None]:
    """One effect of a handful of mechanisms: the whole library takes minutes."""
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr("diagnosis.outcomes.candidates.library", lambda model: dict(_suspects(model)))
        patched.setattr("diagnosis.outcomes.chain.MOST", 1)
        yield


def _suspects(model: Model) -> Iterator[tuple[str, Mechanism]]:
    for name, mechanism in library(model).items():
        if name in ("pivot_inset", "restitution", "base_gain", "delay"):
            yield name, mechanism


@pytest.fixture(scope="module")
def with_inset(few_suspects: None) -> OutcomeDiagnosis:
    return diagnose_outcomes(BLOCK, runs_of(3, {"pivot_inset.inset_over_half_width": 0.25}, groups=4))


@pytest.mark.slow
def test_a_base_that_is_narrower_is_said_and_improves_the_predictions(with_inset: OutcomeDiagnosis) -> None:
    found = with_inset
    assert found.verdict in ("missing", "cannot_tell_apart")
    said = {found.effects[0].effect_class, *(rival.effect_class for rival in found.rivals)}
    assert "contact_geometry" in said
    assert found.p_value <= 0.01
    assert "delay" in found.not_tried
    base, extended = found.predictor("base model").scores, found.predictor("extended model").scores
    assert extended.log_loss.value < base.log_loss.value - 0.1
    assert extended.accuracy.value > base.accuracy.value
    assert base.false_stands > base.false_falls
    assert found.wrong[0].predicted == "stands" and found.wrong[0].standard_score > 2.0
    assert "overturned where the base model stands" in found.statement


@pytest.mark.slow
def test_nothing_is_said_to_be_missing_when_nothing_is() -> None:
    found = diagnose_outcomes(BLOCK, runs_of(4, {}, groups=4, each=4))
    assert found.verdict == "nothing_missing"
    assert not found.effects
    assert found.p_value > 0.01


@pytest.mark.slow
def test_the_answer_predicts_further_runs_from_its_folder(with_inset: OutcomeDiagnosis, tmp_path: Path) -> None:
    for name, text in ((JSON, "{}"), ("fit.nc", "curves"), (EXTENDED, 'file = "law.csv"'), ("law.csv", "a law")):
        (tmp_path / name).write_text(text)
    write_answer(with_inset, BLOCK, tmp_path)
    assert not (tmp_path / "fit.nc").exists() and not (tmp_path / "law.csv").exists()
    answer = json.loads((tmp_path / JSON).read_text())
    assert answer["verdict"] == with_inset.verdict
    assert answer["effects"][0]["parameters"]
    assert program().keys() <= answer["provenance"].keys()
    assert set(answer["scores"]) == {"base model", "extended model", "PGA", "PGV"}
    page = (tmp_path / PAGE).read_text()
    assert "<svg" in page and "http" not in page.replace("http://www.w3.org", "")
    assert len(list(csv.reader((tmp_path / RUNS).read_text().splitlines()))) == 1 + len(with_inset.runs)
    assert read_specimen(tmp_path / EXTENDED).mechanisms.keys() == {e.name for e in with_inset.effects}
    specimen, posterior = read_answer(tmp_path)
    further = runs_of(11, {"pivot_inset.inset_over_half_width": 0.25})
    assert further.overturned is not None
    prediction = predict_outcomes(specimen, posterior, replace(further, overturned=None))
    right = np.mean((prediction.chance > 0.5) == further.overturned)
    assert right > 0.8
    assert np.all((prediction.low95 <= prediction.high95) & (prediction.chance > 0.0) & (prediction.chance < 1.0))
    assert prediction_text(prediction).count("\n") == 1 + further.size


@pytest.mark.slow
def test_outcomes_turned_round_are_not_explained_and_asked_about() -> None:
    """Motions that overturn stand and the others fall: no group is off as a whole, but nothing is predicted."""
    runs = runs_of(5, {}, groups=4, each=4)
    assert runs.overturned is not None
    found = diagnose_outcomes(BLOCK, replace(runs, overturned=~runs.overturned, column="fell"))
    assert found.verdict == "not_in_library"
    assert found.predictor("base model").scores.log_loss.value > np.log(2.0)
    assert "are 0 and 1 swapped in column 'fell'?" in found.statement
    assert found.slope_p_value < 0.01


def test_too_few_runs_are_refused() -> None:
    few = runs_of(1, {}, groups=1, each=4)
    with pytest.raises(InputError, match="at least 10 runs are needed"):
        diagnose_outcomes(BLOCK, few)
    with pytest.raises(InputError, match="of no run whether it overturned"):
        diagnose_outcomes(BLOCK, replace(few, overturned=None))


def test_runs_of_one_group_are_refused_before_anything_is_simulated() -> None:
    with pytest.raises(InputError, match=r"all 12 runs are of one group, 'group 0'.*two ground motions"):
        diagnose_outcomes(BLOCK, runs_of(1, {}, groups=1, each=12))


def test_a_vertical_motion_that_is_left_out_may_be_what_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    """A wall on rubber takes it by default, so that it may only be missing where the specimen leaves it out."""
    monkeypatch.setattr("diagnosis.outcomes.candidates.library", library)
    wall, shaken = models.get("interface"), [Motion("m", STEP, np.zeros(10), vertical=np.zeros(10))]
    for vertical, missing in ((None, False), (False, True), (True, False)):
        found, refused = repairs(wall, replace(BLOCK, model="interface", vertical=vertical), shaken)
        assert ("vertical_acceleration" in {one.name for one in found}) is missing
        assert ("vertical_acceleration" in refused) is not missing


def test_a_folder_without_an_answer_is_named(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"holds no extended\.toml"):
        read_answer(tmp_path)
