"""Buildings on rubber: what is left out of their bearings is named, and nothing where nothing is."""

from __future__ import annotations

import numpy as np
import pytest

import models
from diagnosis import diagnose
from diagnosis.answer.result import Diagnosis
from grids.recordings.base import Recording
from grids.specimen import Specimen
from models.shaking import Shaking

STEP, COUNT = 0.02, 2200
BODY = {"levels": 1.0, "total_mass": 1.0, "rubber_thickness": 0.2}
BEARINGS = {"bearing_stiffness": 14.0, "bearing_damping": 0.5}
SPECIMEN = Specimen(
    title="a body on rubber", model="isolated", parameters=BODY,
    calibrate={"bearing_stiffness": (2.0, 60.0), "bearing_damping": (0.05, 5.0)},
)  # fmt: skip


def made(name: str, peak: float, seed: int, **laws: float) -> Recording:
    """A simulated test with 1 % noise; the base has energy from .15 to 4 Hz."""
    rng = np.random.default_rng(seed)
    time = STEP * np.arange(COUNT)
    frequency = np.fft.rfftfreq(COUNT, STEP)
    spectrum = np.fft.rfft(rng.normal(size=COUNT)) * (frequency > 0.15) * np.exp(-0.5 * (frequency / 2.0) ** 2)
    envelope = np.clip(time - 5.0, 0.0, 5.0) / 5.0 * np.exp(-np.clip(time - 30.0, 0.0, None) / 5.0)
    base = np.fft.irfft(spectrum, COUNT) * envelope
    base *= peak / np.max(np.abs(base))
    ran = models.get("isolated").simulate({**BODY, **BEARINGS, **laws}, Shaking(STEP, base), duration=time[-1])
    x = np.asarray(ran.channels["level_displacement_x"])
    x = x + 0.01 * np.std(x) * rng.normal(size=x.shape)
    return Recording(name, STEP, time, {"base_acceleration_x": base, "level_displacement_x": x}, ("0",))


def answer(**laws: float) -> Diagnosis:
    runs = [made("small", 1.0, 1, **laws), made("large", 2.5, 2, **laws)]
    return diagnose(SPECIMEN, runs, [made("larger", 4.0, 3, **laws)])


def test_nothing_is_named_where_nothing_is_missing() -> None:
    found = answer()
    assert found.verdict == "nothing_missing" and not found.effects
    for name, true in BEARINGS.items():
        assert found.base[name].estimate == pytest.approx(true, rel=0.02)


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
    (beyond,) = found.extrapolated
    assert beyond.recording == "larger" and beyond.peak > 1.1 * beyond.learned
    assert "larger reaches" in found.statement and "extrapolates" in found.statement
