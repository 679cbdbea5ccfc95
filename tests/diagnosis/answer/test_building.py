"""Buildings on rubber: what is left out of their bearings is named, and nothing where nothing is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diagnosis import diagnose
from diagnosis.answer.result import Diagnosis
from diagnosis.fit.setup import measure
from models.errors import InputError
from models.kinematics import Place
from tests.diagnosis.buildings import BEARINGS, SPECIMEN, made


def answer(**laws: float) -> Diagnosis:
    runs = [made("small", 1.0, 1, **laws), made("large", 2.5, 2, **laws)]
    return diagnose(SPECIMEN, runs, [made("larger", 4.0, 3, **laws)])


def test_nothing_is_named_where_nothing_is_missing() -> None:
    found = answer()
    assert found.verdict == "nothing_missing" and not found.effects
    for name, true in BEARINGS.items():
        assert found.base[name].estimate == pytest.approx(true, rel=0.02)


def test_a_channel_of_a_level_that_the_specimen_has_not_is_refused() -> None:
    run = made("small", 1.0, 1)
    channels = {**run.channels, "gauge": run.channels["base_acceleration_x"]}
    placed = replace(run, channels=channels, places={"gauge": Place("displacement", 2)})
    with pytest.raises(InputError, match="gauge is on body 2 and model isolated has one body"):
        measure(SPECIMEN, [placed])


@pytest.mark.slow
def test_a_sum_of_two_hysteretic_elements_is_told_from_one() -> None:
    """One yields early, one late: the stiffness that is left after both is .6 times .4 of the first."""
    laws = {
        "bouc_wen.post_yield_ratio": 0.6, "bouc_wen.yield_compression": 0.002, "bouc_wen.exponent": 1.0,
        "bouc_wen_2.post_yield_ratio": 0.4, "bouc_wen_2.yield_compression": 0.03, "bouc_wen_2.exponent": 2.0,
    }  # fmt: skip
    found = answer(**laws)
    assert found.verdict == "missing" and {e.name for e in found.effects} == {"bouc_wen", "bouc_wen_2"}
    ratios = [e.parameters["post_yield_ratio"].estimate for e in found.effects]
    early, late = sorted(e.parameters["yield_compression"].estimate for e in found.effects)
    assert np.prod(ratios) == pytest.approx(0.24, rel=0.05)
    assert early == pytest.approx(0.002, rel=0.2) and late == pytest.approx(0.03, rel=0.1)
    assert found.holdout is not None and found.holdout.share_of_achievable > 0.95


@pytest.mark.slow
def test_hysteresis_is_named_and_predicts_a_larger_run() -> None:
    laws = {"bouc_wen.post_yield_ratio": 0.4, "bouc_wen.yield_compression": 0.008, "bouc_wen.exponent": 1.0}
    found = answer(**laws)
    assert found.effects[0].name == "bouc_wen"
    values = found.effects[0].parameters
    assert values["post_yield_ratio"].estimate == pytest.approx(0.4, abs=0.04)
    assert found.holdout is not None and found.holdout.after < 0.2 * found.holdout.before
    assert not found.located and not found.visited and not found.constancy
    assert found.missing_force is found.other_model is None
    assert not any(effect.stages for effect in found.effects)
    assert found.errors is not None and found.errors.base_drift is found.errors.scatter is None
    (beyond,) = found.extrapolated
    assert beyond.recording == "larger" and beyond.peak > 1.1 * beyond.learned
    assert "larger reaches" in found.statement and "extrapolates" in found.statement
