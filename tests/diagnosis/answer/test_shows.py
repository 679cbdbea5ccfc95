"""Where the residual exceeds the noise: what stands out is found, what does not is not."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from diagnosis.answer.shows import LEVEL, intervals, shows
from models.housner.identification import IDENTIFICATION

WINDOWS, SAMPLES = 14, 60


def shown(where: tuple[int, ...], explained: bool) -> Any:
    """Two recordings of 14 windows each; noise of one, and a mismatch in the windows ``where``."""
    shape = (2 * WINDOWS, 1, SAMPLES)
    missing = np.zeros(shape)
    missing[list(where)] = 2.0 * np.sin(np.linspace(0.0, 6.0, SAMPLES))
    values = np.random.default_rng(3).normal(size=shape) + missing
    measured = SimpleNamespace(
        identification=IDENTIFICATION,
        recordings=tuple(
            SimpleNamespace(name=f"run_{r}", time_step=0.01, time=np.arange(WINDOWS * SAMPLES) * 0.01) for r in range(2)
        ),
        channels=("rotation_1",),
        lead=0,
        windows=tuple(
            SimpleNamespace(recording=r, first=w * SAMPLES, samples=SAMPLES) for r in range(2) for w in range(WINDOWS)
        ),
        time_steps=np.full(2 * WINDOWS, 0.01),
        recording_of=np.repeat(np.arange(2), WINDOWS),
        first=np.tile(np.arange(WINDOWS) * SAMPLES, 2),
        base=np.zeros((2 * WINDOWS, SAMPLES)),
        mask=np.ones(shape, bool),
        sigma=np.ones(shape[:2]),
        values=values,
        leading=values[:, 0],
    )
    after = missing if explained else np.zeros(shape)
    return SimpleNamespace(measured=measured, before=np.zeros(shape), after=after)


@pytest.mark.parametrize("explained", [True, False])
def test_the_windows_with_the_mismatch_are_found(explained: bool) -> None:
    first = shows(shown((20, 21, 22, 23), explained), explained)[0]
    assert first.recording == "run_1" and first.share > 0.6
    step = SAMPLES * 0.01
    assert first.start == pytest.approx(6 * step, abs=step) and first.end == pytest.approx(10 * step, abs=step)


def test_all_scans_together_are_wrong_at_most_as_often_as_said() -> None:
    scans, wrong, tries = 6, 0, 60
    for seed in range(tries):
        rng = np.random.default_rng(seed)
        excess = rng.chisquare(20, size=(scans, WINDOWS))
        found = [next(intervals(each, LEVEL / scans, rng)) for each in excess]
        wrong += any(ends != (0, WINDOWS - 1) for ends in found)
    assert wrong <= 8  # .05 of 60 is 3, with probability .997 at most 8
