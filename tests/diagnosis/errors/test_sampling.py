"""Evidence does not grow with the sampling rate when the information does not."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import butter, sosfilt

import models
from diagnosis.errors.model import calibrated
from diagnosis.fit.setup import measure
from diagnosis.search.candidates import candidates
from diagnosis.search.refit import Explanation, extend
from grids.recordings.base import Recording
from models.shaking import Shaking
from tests.diagnosis.made import SPECIMEN, TRUE, motion

FAST = 800.0
STILL = 1.5


def recorded(every: int, seed: int) -> Recording:
    """The damped block at 800 Hz over ``every``, with noise of 1 % of the peak under 40 Hz.

    The base's acceleration is linear between samples at 200 Hz, so that it is the same motion at both rates.
    """
    plain, step = motion(seed), 1.0 / FAST
    lead = np.zeros(round(STILL / plain.time_step))
    coarse = np.concatenate([lead, plain.horizontal, lead])
    time = step * np.arange(round((coarse.size - 1) * plain.time_step / step) + 1)
    shaking = Shaking(step, np.interp(time, plain.time_step * np.arange(coarse.size), coarse))
    ran = models.get("housner").simulate({**TRUE, "viscous_damping.rate": 0.15}, shaking, duration=shaking.duration)
    rotation = np.ravel(ran.channels["rotation_1"])
    noise = sosfilt(butter(2, 40.0, fs=FAST, output="sos"), np.random.default_rng(seed).normal(size=rotation.size))
    seen = rotation + 0.01 * np.max(np.abs(rotation)) * noise / np.std(noise)
    channels = {"base_acceleration_x": shaking.horizontal[::every], "rotation_1": seen[::every]}
    return Recording(f"train_{seed}", every * step, time[::every], channels)


def evidence(every: int) -> float:
    measured = measure(SPECIMEN, [recorded(every, seed) for seed in (1, 6)])
    base = Explanation((), calibrated(SPECIMEN, measured)[0])
    damping = next(c for c in candidates(measured, SPECIMEN) if c.name == "viscous_damping")
    return base.loss - extend(base, damping, damping.null).loss


def test_evidence_at_200_and_800_hz_is_the_same() -> None:
    slow, fast = evidence(4), evidence(1)
    assert slow > 30.0
    assert fast == pytest.approx(slow, rel=0.25)
