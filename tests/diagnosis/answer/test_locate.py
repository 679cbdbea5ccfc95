"""Where the residual exceeds the noise: what stands out is found, what does not is not."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from diagnosis.answer.locate import LEVEL, intervals, locate, phases
from diagnosis.forces import constancy
from models.housner.identification import IDENTIFICATION

WINDOWS, SAMPLES = 14, 60
PLAIN = [constancy.Tested("viscous_damping", "", 400.0)]


def shown(where: tuple[int, ...], explained: bool) -> Any:
    """Two recordings of 14 windows each; noise of one, and a mismatch in the windows ``where``."""
    shape = (2 * WINDOWS, 1, SAMPLES)
    missing = np.zeros(shape)
    missing[list(where)] = 2.0 * np.sin(np.linspace(0.0, 6.0, SAMPLES))
    measured = SimpleNamespace(
        identification=IDENTIFICATION,
        recordings=tuple(SimpleNamespace(name=f"run_{r}", time_step=0.01) for r in range(2)),
        channels=("rotation_1",),
        windows=tuple(
            SimpleNamespace(recording=r, first=w * SAMPLES, samples=SAMPLES) for r in range(2) for w in range(WINDOWS)
        ),
        recording_of=np.repeat(np.arange(2), WINDOWS),
        mask=np.ones(shape, bool),
        sigma=np.ones(shape[:2]),
        values=np.random.default_rng(3).normal(size=shape) + missing,
    )
    after = missing if explained else np.zeros(shape)
    return SimpleNamespace(measured=measured, before=np.zeros(shape), after=after)


@pytest.mark.parametrize("explained", [True, False])
def test_the_windows_with_the_mismatch_are_found(explained: bool) -> None:
    first = locate(shown((20, 21, 22, 23), explained), PLAIN, sensors_only=False, explained=explained)[0]
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


def test_a_dependence_within_chance_is_no_phase() -> None:
    weak = [constancy.Tested("viscous_damping", "", 20.0), constancy.Tested("viscous_damping", "side", 8.0, 1.0)]
    assert phases(IDENTIFICATION, weak) == ("between_impacts",)
    strong = [constancy.Tested("viscous_damping", "", 60.0), constancy.Tested("viscous_damping", "side", 30.0, 1.0)]
    assert phases(IDENTIFICATION, strong) == ("between_impacts", "right")
    assert phases(IDENTIFICATION, [constancy.Tested("restitution", "", 60.0)]) == ("impact",)
