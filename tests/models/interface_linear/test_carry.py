"""States of linear walls that no sensor holds, carried along the rotations: those of the wall that made them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from models.runs import Prescribed
from models.shaking import Shaking, Shakings
from tests.models.interface.carried import AHEAD, COUNT, HELD, MARKS, NOISE, STEP, WALL, recorded, seen
from tests.models.interface_linear.walls import MODEL


def shaking(vertical: bool = False) -> Shaking:
    """Noise of up to .1 s that dies away on both sides; vertically half as strong, later."""
    time, rng = STEP * np.arange(COUNT), np.random.default_rng(5)
    pieces = np.interp(time, np.arange(0.0, 8.0, 0.1), rng.normal(size=80))
    signal = pieces * np.exp(-(((time - 3.0) / 1.5) ** 2))
    signal *= 1.5 / np.max(np.abs(signal))
    return Shaking(STEP, signal, 0.5 * np.roll(signal, 130) if vertical else None)


def carried(values: dict[str, Any], base: Shaking, motion: dict[str, np.ndarray], **more: Any) -> dict[str, np.ndarray]:
    return MODEL.carry(values, base, Prescribed(motion, MARKS, np.zeros(1, np.int64)), **more)


def moved(values: dict[str, Any], base: Shaking, **more: Any) -> Any:
    """Channels of a run that lifts the wall."""
    channels = MODEL.simulate(values, base, **more).channels
    assert np.max(np.abs(channels["rotation_1"])) > 1.5 * MODEL.derive(values)["uplift_rotation"][0]
    return channels


def in_windows(values: dict[str, Any], base: Shaking, channels: Any, carried: dict[str, np.ndarray]) -> np.ndarray:
    """Rotations (2, windows, samples) from the true rotations and rates at the marks, and what was carried there."""
    initial = {name: channels[name][MARKS] for name in HELD} | {name: x[0] for name, x in carried.items()}
    ran = MODEL.trajectories(values, base, first=MARKS, samples=AHEAD, initial=initial)
    return np.stack([ran["rotation_1"], ran["rotation_2"]])


@pytest.mark.parametrize("vertical", [False, True])
@pytest.mark.parametrize("law", [{}, {"pivot_inset.inset_over_half_width": 0.1}])
def test_windows_from_carried_states_are_parts_of_the_run(law: dict[str, float], vertical: bool) -> None:
    """Exact between samples: nothing but where a joint is held at its switch may differ."""
    values, base = WALL | law, shaking(vertical)
    channels = moved(values, base)
    found = carried(values, base, {name: channels[name][None] for name in HELD})
    assert set(found) == {"displacement_z_1", "displacement_z_2", "velocity_z_1", "velocity_z_2"}
    for k, joint in ((1, "base"), (2, "top")):
        true = -channels[f"compression_{joint}"][MARKS]
        np.testing.assert_allclose(found[f"displacement_z_{k}"][0], true, rtol=1e-4, atol=1e-8)
    wrong = np.abs(in_windows(values, base, channels, found) - recorded(channels))
    assert np.max(wrong) < 1e-3 * np.max(np.abs(channels["rotation_1"]))


def test_noise_of_the_measured_motion_hardly_enters_what_is_carried() -> None:
    base = shaking()
    channels = moved(WALL, base)
    wrong = in_windows(WALL, base, channels, carried(WALL, base, seen(channels))) - recorded(channels)
    assert np.sqrt(np.mean(wrong**2)) < 0.2 * NOISE * np.max(np.abs(recorded(channels)))


def test_lanes_do_not_depend_on_one_another_and_what_cannot_stand_carries_nothing() -> None:
    channels, base = moved(WALL, shaking()), shaking()
    motion = {name: channels[name][None] for name in HELD}
    bases = [base, Shaking(STEP, 1.1 * base.horizontal), base]
    soft = np.array([4.0e7, 4.0e4, 8.0e7])
    along = Prescribed(motion, MARKS, np.zeros(3, np.int64))
    each = MODEL.carry({**WALL, "base_stiffness": soft}, Shakings.of_lanes(bases), along)
    for name, together in each.items():
        assert np.all(np.isnan(together[1]))
        for k in (0, 2):
            alone = carried({**WALL, "base_stiffness": soft[k]}, bases[k], motion)[name][0]
            np.testing.assert_array_equal(together[k], alone)


def test_a_run_cut_in_two_carries_what_the_whole_one_does() -> None:
    base = shaking()
    channels, first, cut = moved(WALL, base), np.zeros(1, np.int64), 1100
    motion = {name: channels[name][None] for name in HELD}
    whole, begun = carried(WALL, base, motion), MARKS[cut < MARKS] - cut
    at_cut = MODEL.carry(WALL, base, Prescribed(motion, np.array([cut]), first))
    later = MODEL.carry(
        WALL, base, Prescribed({name: x[:, cut:] for name, x in motion.items()}, begun, first + cut),
        initial={name: x[:, 0] for name, x in at_cut.items()},
    )  # fmt: skip
    for name, x in later.items():
        np.testing.assert_array_equal(x[0], whole[name][0, cut < MARKS])
