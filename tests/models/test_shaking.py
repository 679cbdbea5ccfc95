"""What a motion of the base keeps for the runs under it, and how it goes on between samples."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import models
from models.shaking import KEPT, Shaking, Shakings


def test_a_result_is_made_once_and_the_oldest_is_forgotten() -> None:
    shaking = Shaking(0.01, np.zeros(5))
    made: list[int] = []

    def make(k: int) -> int:
        made.append(k)
        return k

    for k in (*range(KEPT), *range(KEPT)):
        assert shaking.once(("record", k), lambda k=k: make(k)) == k
    assert made == list(range(KEPT))
    shaking.once(("record", KEPT), lambda: make(KEPT))
    shaking.once(("record", 0), lambda: make(0))  # it had been the oldest
    assert made == [*range(KEPT), KEPT, 0]
    assert Shaking(0.01, np.zeros(5)).once(("record", 0), lambda: 7) == 7


FINE, STIFF = 1600, 40.0


def smooth(frequency: float, sampling: int) -> tuple[np.ndarray, np.ndarray]:
    """Times and a burst of so many Hz: nothing of it lies above half of 50 Hz."""
    time = np.arange(round(3.0 * sampling)) / sampling
    return time, np.sin(2 * np.pi * frequency * time) * np.exp(-(((time - 1.5) / 0.25) ** 2))


def moved(frequency: float, sampling: int, *, band_limited: bool) -> np.ndarray:
    """Displacement of a building on linear bearings (exact under straight lines) at every .02 s."""
    base = smooth(frequency, sampling)[1]
    shaking = Shaking(1.0 / sampling, base, 0.4 * base, band_limited=band_limited)
    body = {"total_mass": 1.0, "bearing_stiffness": STIFF**2, "bearing_damping": 0.2 * STIFF, "rubber_thickness": 0.1}
    channel = models.get("isolated").simulate(body, shaking).channels["bearing_displacement"]
    return np.asarray(channel[:: sampling // 50])


def lost(frequency: float, sampling: int, *, band_limited: bool) -> float:
    """Largest error of the displacement over its peak."""
    true = moved(frequency, FINE, band_limited=True)
    found = moved(frequency, sampling, band_limited=band_limited)
    return float(np.max(np.abs(found - true)) / np.max(np.abs(true)))


def test_straight_lines_between_the_samples_of_a_smooth_motion_take_sinc_squared_of_it() -> None:
    assert abs(lost(10.0, 100, band_limited=False) - (1.0 - np.sinc(0.1) ** 2)) < 2e-3
    assert lost(10.0, 100, band_limited=True) < 1e-4


def test_the_error_under_a_band_limited_motion_is_of_fourth_order() -> None:
    at = [lost(5.0, sampling, band_limited=True) for sampling in (50, 100, 200)]
    assert 14.0 < at[0] / at[1] < 70.0 and 14.0 < at[1] / at[2] < 70.0
    plain = [lost(5.0, sampling, band_limited=False) for sampling in (50, 100)]
    assert 3.7 < plain[0] / plain[1] < 4.3


def test_straight_lines_stay_as_they_are_and_both_components_are_treated_alike() -> None:
    base = smooth(5.0, 100)[1]
    linear = Shaking(0.01, base, 0.4 * base)
    assert linear.lines is linear
    lines = replace(linear, band_limited=True).lines
    assert lines.vertical is not None and not lines.band_limited
    np.testing.assert_allclose(lines.vertical, 0.4 * lines.horizontal, rtol=0, atol=1e-15)
    # what accelerates steadily is a straight line already
    ramp = Shaking(0.01, np.linspace(-1.0, 2.0, 40), band_limited=True).lines.horizontal
    np.testing.assert_allclose(ramp[2:-2], np.linspace(-1.0, 2.0, 40)[2:-2], atol=1e-15)
    assert Shaking(0.01, np.ones(2), band_limited=True).lines.horizontal.tolist() == [1.0, 1.0]


def test_lanes_that_are_taken_leave_the_motions_of_others_behind() -> None:
    """Records are made of what is left: a call with many motions, taken apart lane by lane, would make each of them."""
    each = tuple(Shaking(0.01, np.full(10 + k, float(k))) for k in range(4))
    some = Shakings(each, np.array([0, 1, 3, 3, 2])).take(np.array([2, 1, 3]))
    assert some.each == (each[1], each[3]) and some.of.tolist() == [1, 0, 1]
    assert some.ends.tolist() == [12, 10, 12]
    assert Shakings.of_lanes([each[3], each[1], each[3]]).each == (each[3], each[1])


def test_lanes_under_motions_of_other_steps_do_not_run_together() -> None:
    quick, up = Shaking(0.005, np.zeros(9)), Shaking(0.01, np.zeros(9), np.zeros(9))
    for other in (quick, up):
        with pytest.raises(ValueError, match="one step"):
            Shakings((Shaking(0.01, np.zeros(9)), other), np.array([0, 1]))
