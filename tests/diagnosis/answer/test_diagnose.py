"""The whole chain on simulated recordings."""

from __future__ import annotations

from dataclasses import replace
from importlib import import_module
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from diagnosis import calibrate, diagnose
from diagnosis.answer.assembly import screened
from diagnosis.answer.heldout import Shown
from diagnosis.answer.result import Beyond, Unfit
from diagnosis.fit.setup import measure
from diagnosis.report import diagnosis_json
from diagnosis.search.candidates import candidates
from diagnosis.search.found import MISSING, Search
from diagnosis.search.null import LEAST_P
from models.errors import InputError
from study.provenance import commit, now, versions
from tests.diagnosis.answer.searched import among, searched
from tests.diagnosis.made import SPECIMEN, TRUE, recording
from tests.diagnosis.report.schema import AnswerFile

LOSSY = 0.93
"""Share of Housner's restitution that hidden impacts keep."""


def test_nothing_missing() -> None:
    found = searched().answer
    assert found.verdict == "nothing_missing", found.statement
    alone = calibrate(SPECIMEN, [recording("train_1", 1), recording("train_2", 2)], profile=False)
    assert alone.misfit == pytest.approx(found.train.before, rel=1e-9)
    assert not found.effects and not found.rivals
    assert found.p_value is not None and found.p_value > 0.001
    assert found.holdout is not None and found.holdout.share_of_achievable is None
    for name in ("width", "height"):
        value = found.base[name]
        assert value.low95 - 0.003 * TRUE[name] < TRUE[name] < value.high95 + 0.003 * TRUE[name]


def test_restitution_is_named_and_recovered() -> None:
    found = searched(LOSSY).answer
    assert found.effects[0].name == "restitution", found.statement
    value = found.effects[0].parameters["factor_on_housner"]
    assert value.low95 <= LOSSY <= value.high95
    assert value.high95 - value.low95 < 0.03
    assert found.p_value == found.effects[0].p_value < 1e-3 and found.effects[0].evidence > MISSING
    assert found.errors is not None and found.errors.scatter is not None and found.errors.scatter.estimate < 0.01
    assert found.holdout is not None and found.holdout.share_of_achievable is not None
    assert found.holdout.share_of_achievable > 0.8
    assert found.located[0].effect == "restitution" and found.located[0].where == ("impact",)
    assert found.shows and found.shows[0].where[0] == "between_impacts"
    assert "restitution" in found.statement


def test_the_file_says_which_program_gave_the_answer_and_when() -> None:
    begun = now()
    read = AnswerFile.model_validate_json(diagnosis_json(searched(LOSSY).judged_again())).provenance
    assert begun <= read.made <= now()
    assert (read.commit or "") == commit() and read.rocking_study == versions()["rocking-study"]
    assert read.recordings == ["train_1", "train_2"] and set(read.gain_by_recording) == {"train_1", "train_2"}


def test_a_stopped_search_gives_what_it_has() -> None:
    def stop(text: str, share: float) -> None:
        if text.startswith("looking for a second effect"):
            raise KeyboardInterrupt

    effect = {"restitution": {"factor_on_housner": LOSSY}}
    with among(("restitution", "tilt", "offset")):
        found = diagnose(SPECIMEN, [recording("train_1", 1, effect)], progress=stop)
    assert not found.finished
    assert found.effects and found.effects[0].name == "restitution"
    assert "stopped" in found.statement
    assert not AnswerFile.model_validate_json(diagnosis_json(found)).provenance.finished


def test_an_answer_that_recordings_held_out_contradict_is_not_in_the_library(monkeypatch: pytest.MonkeyPatch) -> None:
    """From the judgement to verdict and statement, with the effects found still told."""
    once = searched(LOSSY)  # before anything is replaced
    judged: list[tuple[str, ...]] = []

    def worse(found: Search, held: Shown) -> tuple[float, float]:
        judged.append(found.chosen.names)
        assert [r.name for r in held.measured.recordings] == ["test_1"]
        return 0.04, 0.07

    monkeypatch.setattr(import_module("diagnosis.answer.verdict"), "contradicted", worse)
    found = once.judged_again()
    assert judged == [("restitution",)]
    assert found.verdict == "not_in_library" and found.contradicted == (0.04, 0.07)
    assert found.effects[0].name == "restitution" and "recordings held out" in found.statement


@pytest.mark.parametrize("stage", ["far", "failed"])
def test_windows_far_from_the_noise_and_what_could_not_be_done_are_told(
    stage: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of a block of which nothing else is missing: the verdict, its p-value and the reason."""
    once = searched()

    def refused(*_: Any) -> Any:
        raise InputError("a run cannot be cut there")

    if stage == "far":
        far = (Unfit("train_1", 1.0, 1.6, 30.0), Unfit("train_1", 2.0, 2.5, 19.0))
        monkeypatch.setattr(import_module("diagnosis.answer.verdict"), "unfit_windows", lambda found: far)
    else:
        monkeypatch.setattr(import_module("diagnosis.answer.assembly"), "_horizons", refused)
    found = once.judged_again()
    if stage == "far":
        assert found.verdict == "not_in_library" and found.p_value == LEAST_P
        assert found.missing_force is not None or "train_1, 1.0 to 1.6 s (30 times)" in found.statement
    else:
        assert found.verdict == "nothing_missing" and not found.prediction_horizon
        assert "Could not be done: prediction horizons (a run cannot be cut there)." in found.statement


def test_one_window_far_from_the_noise_is_told_and_changes_no_verdict(monkeypatch: pytest.MonkeyPatch) -> None:
    once = searched()
    far = (Unfit("train_1", 1.0, 1.6, 30.0),)
    monkeypatch.setattr(import_module("diagnosis.answer.verdict"), "unfit_windows", lambda found: far)
    found = once.judged_again()
    assert found.verdict == "nothing_missing" and found.unfit == far
    assert found.p_value is not None and found.p_value > 0.05
    assert "but for one window, and nothing is named as missing" in found.statement
    assert "train_1, 1.0 to 1.6 s (30 times). One event is too little" in found.statement


def test_an_answer_that_needs_more_than_its_range_is_not_in_the_library(monkeypatch: pytest.MonkeyPatch) -> None:
    once = searched(LOSSY)
    judged: list[tuple[str, ...]] = []
    needs = Beyond("restitution", "factor_on_housner", 0.5, 0.4, "1", 60.0)

    def more(found: Search) -> tuple[Beyond, ...]:
        judged.append(found.chosen.names)
        return (needs,)

    monkeypatch.setattr(import_module("diagnosis.answer.verdict"), "beyond_ranges", more)
    found = once.judged_again()
    assert judged == [("restitution",)]
    assert found.verdict == "not_in_library" and found.beyond == (needs,)
    assert found.effects[0].name == "restitution" and "beyond the range of the library" in found.statement


@pytest.mark.parametrize(("doubts", "said"), [([0.003], 0.003), ([], 0.4)])
def test_draws_of_a_suspect_tell_nothing_of_a_doubt(
    monkeypatch: pytest.MonkeyPatch, doubts: list[float], said: float
) -> None:
    """Nothing is named, and they are of the strongest suspect; what speaks against the model has its own p-value."""
    once = searched()
    verdict = import_module("diagnosis.answer.verdict")
    monkeypatch.setattr(verdict, "p_of_doubts", lambda *_: doubts)
    monkeypatch.setattr(import_module("diagnosis.answer.judgement"), "p_of_doubts", lambda *_: doubts)
    monkeypatch.setattr(verdict.bootstrapping, "p_value", lambda *_: LEAST_P if doubts else 0.4)
    assert replace(once, task=replace(once.task, draws=20)).judged_again().p_value == said


@pytest.mark.parametrize("stage", ["intervals", "bootstrap", "before and after"])
def test_ctrl_c_after_the_search_leaves_the_answer(stage: str) -> None:
    pressed = []

    def stop(text: str, share: float) -> None:
        if text.startswith(stage) and not pressed:
            pressed.append(text)
            raise KeyboardInterrupt

    draws = 20 if stage == "bootstrap" else 0
    with among(("restitution", "tilt", "offset")):
        found = diagnose(SPECIMEN, [recording("train_1", 1)], [recording("test_1", 3)], bootstrap=draws, progress=stop)
    assert pressed and found.finished and found.verdict == "nothing_missing"
    assert found.p_value is not None and found.p_value > 0.001 and found.holdout is not None and found.base
    assert found.skipped and "left out" in found.statement
    assert ("bootstrap" in found.skipped[0]) == (stage == "bootstrap")


def test_a_search_stopped_at_once_claims_nothing() -> None:
    def stop(text: str, share: float) -> None:
        if text.startswith("screening"):
            raise KeyboardInterrupt

    found = diagnose(SPECIMEN, [recording("train_1", 1)], [recording("test_1", 3)], progress=stop)
    assert not found.finished and not found.effects and not found.located and found.p_value is None
    assert found.holdout is not None and found.holdout.share_of_achievable is None
    assert "stopped before anything was found" in found.statement and "leaves something out" not in found.statement


def test_every_refit_of_the_screen_is_told_though_later_ones_are_of_several_effects() -> None:
    """Under the errors of the base model, as the forecasts are."""
    some = [replace(one, unknowns=()) for one in candidates(measure(SPECIMEN, [recording("a", 1)]), SPECIMEN)]
    tilt, gain = (next(one for one in some if one.name == name) for name in ("tilt", "gain"))
    alone, stuck = (
        SimpleNamespace(candidates=(one,), loss=loss, fitted=SimpleNamespace(values={}))
        for one, loss in ((tilt, 60.0), (gain, 130.0))
    )
    found: Any = SimpleNamespace(
        singles=[], base=SimpleNamespace(loss=50.0), shorter=None,
        scores=[SimpleNamespace(candidate=one, statistic=30.0) for one in (tilt, gain)],
        at_null=SimpleNamespace(singles=[alone, stuck], base=SimpleNamespace(loss=100.0)),
    )  # fmt: skip
    assert {line.name: line.gain for line in screened(found)} == {"tilt": 40.0, "gain": None}
    longer: Any = SimpleNamespace(scores=[], singles=[], at_null=None, shorter=found)
    assert screened(longer) == screened(found)


def test_priors_hold_what_the_recordings_do_not_tell() -> None:
    tight = replace(SPECIMEN, tolerance={"width": 1e-6, "height": 0.005, "mass": 0.01})
    found = calibrate(tight, [recording("train_1", 1)], profile=False)
    assert found.parameters["width"].estimate == pytest.approx(0.25, rel=1e-5)
    mass = found.parameters["mass"]
    assert mass.estimate == pytest.approx(540.0, rel=1e-6)
    assert mass.high95 - mass.low95 == pytest.approx(2 * 1.96 * 5.4, rel=0.05)


def test_the_profile_rises_from_the_estimate_and_the_bar_moves_on() -> None:
    shares: list[float] = []
    found = calibrate(SPECIMEN, [recording("train_1", 1)], progress=lambda text, share: shares.append(share))
    assert shares == sorted(shares) and len(set(shares)) == len(shares) >= 4 and shares[0] >= 0.0 and shares[-1] < 1.0
    for name, (at, rise) in found.profiles.items():
        value = found.parameters[name]
        assert at[0] <= value.low95 and at[-1] >= value.high95
        near = int(np.argmin(np.abs(at - value.estimate)))
        assert rise[near] == pytest.approx(0.0, abs=0.1)
        assert np.all(np.diff(rise[near:]) > 0.0) and np.all(np.diff(rise[: near + 1]) < 0.0)


def test_calibrating_what_is_known_exactly_is_refused() -> None:
    with pytest.raises(InputError, match=r"nothing to calibrate.*\[tolerance\]"):
        calibrate(replace(SPECIMEN, tolerance={}), [recording("train_1", 1)])


def test_a_range_is_searched_globally() -> None:
    ranged = replace(
        SPECIMEN,
        parameters={"width": 0.25, "mass": 540.0},
        tolerance={"width": 0.002},
        calibrate={"height": (0.9, 3.6)},
    )
    found = calibrate(ranged, [recording("train_1", 1), recording("train_2", 2)], profile=False)
    assert found.parameters["height"].estimate == pytest.approx(TRUE["height"], rel=0.01)
    assert set(found.by_recording) == {"train_1", "train_2"}
    assert 0.8 < found.misfit_per_sample < 1.2


def test_a_recording_that_never_moves_costs_no_calibration() -> None:
    """It has no window: the others are fitted together and alone, and it is said."""
    runs = [recording("train_1", 1), recording("train_2", 2)]
    noise = np.random.default_rng(0).normal(size=runs[0].time.size)
    weak = replace(runs[0], name="weak", channels={**runs[0].channels, "rotation_1": 1e-5 * noise})
    found = calibrate(SPECIMEN, [*runs, weak], profile=False)
    assert set(found.by_recording) == {"train_1", "train_2"}
    assert any("weak holds no window" in said for said in found.seen)
    assert not calibrate(SPECIMEN, [runs[0], weak], profile=False).by_recording


def test_nothing_to_compare_is_said() -> None:
    flat = recording("flat", 1)
    still = replace(
        flat, channels={**flat.channels, "rotation_1": np.random.default_rng(0).normal(size=flat.time.size)}
    )
    with pytest.raises(InputError, match="never exceeds 8 times its noise"):
        diagnose(SPECIMEN, [still])
    with pytest.raises(InputError, match="no recording"):
        diagnose(SPECIMEN, [])


def test_a_held_out_recording_without_motion_is_told_before_the_search() -> None:
    def never(text: str, share: float) -> None:
        raise AssertionError(text)

    moving = recording("train_1", 1)
    noise = 1e-4 * np.random.default_rng(1).normal(size=moving.time.size)
    still = replace(moving, name="still", channels={**moving.channels, "rotation_1": noise})
    with pytest.raises(InputError, match="still"):
        diagnose(SPECIMEN, [moving], [still], progress=lambda text, share: None if share < 0.05 else never(text, share))
