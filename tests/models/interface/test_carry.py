"""States that no sensor holds, carried along the rotations: those of the wall that made them."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from models.runs import Prescribed
from models.shaking import Shaking, Shakings
from tests.models.interface.carried import AHEAD, COUNT, HELD, MARKS, NOISE, STEP, WALL, recorded, seen
from tests.models.interface.walls import MODEL

MAXWELL = {"maxwell.arm_stiffness_ratio": 0.6, "maxwell.relaxation_time": 0.1}


def shaking() -> Shaking:
    time = STEP * np.arange(COUNT)
    rng = np.random.default_rng(5)
    pieces = np.interp(time, np.arange(0.0, 8.0, 0.1), rng.normal(size=80))
    signal = pieces * np.exp(-(((time - 3.0) / 1.5) ** 2))
    return Shaking(STEP, 1.5 * signal / np.max(np.abs(signal)))


def carried(values: dict[str, Any], motion: dict[str, np.ndarray], **more: Any) -> dict[str, np.ndarray]:
    return MODEL.carry(values, shaking(), Prescribed(motion, MARKS, np.zeros(1, np.int64)), **more)


def in_windows(values: dict[str, Any], channels: Any, carried: dict[str, np.ndarray]) -> np.ndarray:
    """Rotations (2, windows, samples) from the true rotations and rates at the marks, and what was carried there."""
    initial = {name: channels[name][MARKS] for name in HELD} | {name: x[0] for name, x in carried.items()}
    ran = MODEL.trajectories(values, shaking(), first=MARKS, samples=AHEAD, initial=initial)
    return np.stack([ran["rotation_1"], ran["rotation_2"]])


@pytest.mark.parametrize("law", [{}, MAXWELL])
def test_windows_from_carried_states_are_parts_of_the_run(law: dict[str, float]) -> None:
    values = WALL | law
    channels = MODEL.simulate(values, shaking()).channels
    found = carried(values, {name: channels[name][None] for name in HELD})
    np.testing.assert_allclose(found["displacement_z_1"][0], -channels["compression_base"][MARKS], rtol=2e-3, atol=1e-7)
    np.testing.assert_allclose(found["displacement_z_2"][0], -channels["compression_top"][MARKS], rtol=2e-3, atol=1e-7)
    peak = np.max(np.abs(channels["rotation_1"]))
    assert peak > 2.0 * MODEL.derive(values)["uplift_rotation"][0]  # it lifts, so its compression changes
    assert np.max(np.abs(in_windows(values, channels, found) - recorded(channels))) < 1e-3 * peak
    relaxed = np.max(np.abs(in_windows(values, channels, {}) - recorded(channels)))
    assert relaxed > (0.02 if law else 1e-3) * peak


def test_noise_of_the_measured_motion_hardly_enters_what_is_carried() -> None:
    values = WALL | MAXWELL
    channels = MODEL.simulate(values, shaking()).channels
    wrong = in_windows(values, channels, carried(values, seen(channels))) - recorded(channels)
    sigma = NOISE * np.max(np.abs(recorded(channels)))
    assert np.sqrt(np.mean(wrong**2)) < 0.2 * sigma


def test_lanes_do_not_depend_on_one_another_and_what_cannot_stand_carries_nothing() -> None:
    channels = MODEL.simulate(WALL, shaking()).channels
    motion = {name: channels[name][None] for name in HELD}
    soft = np.array([4.0e7, 4.0e4, 8.0e7])
    each = MODEL.carry({**WALL, "base_stiffness": soft}, shaking(), Prescribed(motion, MARKS, np.zeros(3, np.int64)))
    for name, together in each.items():
        assert np.all(np.isnan(together[1]))
        for k in (0, 2):
            np.testing.assert_array_equal(together[k], carried({**WALL, "base_stiffness": soft[k]}, motion)[name][0])


def test_walls_on_bases_that_move_apart_are_carried_as_each_alone() -> None:
    values = WALL | MAXWELL
    channels = MODEL.simulate(values, shaking()).channels
    motion = {name: channels[name][None] for name in HELD}
    bases = [shaking(), replace(shaking(), horizontal=1.1 * shaking().horizontal)]
    each_lane = Shakings.of_lanes([bases[0], bases[1], bases[0]])
    together = MODEL.carry(values, each_lane, Prescribed(motion, MARKS, np.zeros(3, np.int64)))
    each = [MODEL.carry(values, base, Prescribed(motion, MARKS, np.zeros(1, np.int64))) for base in bases]
    for name, x in together.items():
        for k, base in enumerate((0, 1, 0)):
            np.testing.assert_array_equal(x[k], each[base][name][0])
    assert any(np.any(x[0] != x[1]) for x in together.values())


def test_a_run_cut_in_two_carries_what_the_whole_one_does() -> None:
    values = WALL | MAXWELL
    channels = MODEL.simulate(values, shaking()).channels
    motion = {name: channels[name][None] for name in HELD}
    whole, cut = carried(values, motion), 1100
    first, begun = np.zeros(1, np.int64), MARKS[cut < MARKS] - cut
    at_cut = MODEL.carry(values, shaking(), Prescribed(motion, np.array([cut]), first))
    later = MODEL.carry(
        values, shaking(), Prescribed({name: x[:, cut:] for name, x in motion.items()}, begun, first + cut),
        initial={name: x[:, 0] for name, x in at_cut.items()},
    )  # fmt: skip
    for name, x in later.items():
        scale = np.max(np.abs(whole[name]))
        np.testing.assert_allclose(x[0], whole[name][0, cut < MARKS], atol=2e-4 * scale)


def test_walls_along_motions_of_their_own_are_carried_as_each_alone_to_its_last_mark() -> None:
    """Of two recordings, the shorter one ends before the other."""
    values = WALL | MAXWELL
    channels = MODEL.simulate(values, shaking()).channels
    motions = [{name: s * channels[name][None] for name in HELD} for s in (1.0, 0.7)]
    both = {name: np.concatenate([motion[name] for motion in motions]) for name in HELD}
    first = np.zeros(3, np.int64)
    row, last = np.array([0, 1, 1]), np.array([MARKS[-1], MARKS[1], MARKS[-1]])
    together = MODEL.carry(values, shaking(), Prescribed(both, MARKS, first, row, last))
    for name, x in together.items():
        for k, count in enumerate((MARKS.size, 2, MARKS.size)):
            alone = carried(values, motions[row[k]])[name][0]
            np.testing.assert_array_equal(x[k, :count], alone[:count])


@pytest.mark.parametrize(
    "effect",
    [
        {"wall_flexibility.flexural_stiffness_ratio": 10.0}, {"wall_flexibility.flexural_stiffness_ratio": 400.0},
        {"interface_shear.shear_over_normal": 0.5}, {"interface_shear.shear_over_normal": 20.0},
        {"sliding.friction": 1.5}, {"coulomb_damping.over_m_g_b": 0.03},
    ],
    ids=str,
)  # fmt: skip
def test_coordinates_beside_the_prescribed_rotations_stay_with_them_however_stiff(effect: dict[str, float]) -> None:
    """A bend that every setting of the lower half changed rang; a base that friction held began with a push."""
    values = WALL | effect
    channels = MODEL.simulate(values, shaking()).channels
    exact = {name: channels[name][None] for name in HELD}
    wrong = in_windows(values, channels, carried(values, exact)) - recorded(channels)
    assert np.max(np.abs(wrong)) < 1e-4 * np.max(np.abs(channels["rotation_1"]))
    wrong = in_windows(values, channels, carried(values, seen(channels))) - recorded(channels)
    assert np.sqrt(np.mean(wrong**2)) < 0.6 * NOISE * np.max(np.abs(recorded(channels)))


def test_a_base_that_slips_is_carried_along_its_motion() -> None:
    """Without noise only: where slip begins and ends is a matter of less than the noise of the rotations."""
    values = WALL | {"sliding.friction": 0.06}
    channels = MODEL.simulate(values, shaking()).channels
    found = carried(values, {name: channels[name][None] for name in HELD})
    peak = np.max(np.abs(channels["rotation_1"]))
    assert np.max(np.abs(in_windows(values, channels, found) - recorded(channels))) < 1e-4 * peak
    assert np.max(np.abs(found["velocity_x_1"])) > 1e-2


@pytest.mark.parametrize("name, nearly", [("wall_flexibility", 400.0), ("interface_shear", 1e4), ("sliding", 60.0)])
def test_windows_of_a_wall_that_is_nearly_stiff_are_those_of_the_plain_wall(name: str, nearly: float) -> None:
    """At a step as coarse as a logger's, and from rotations with noise."""
    channels = MODEL.simulate(WALL, shaking()).channels
    motion = seen(channels, slice(None, None, 5))
    base = replace(shaking(), time_step=5 * STEP, horizontal=shaking().horizontal[::5])
    asked, values = Prescribed(motion, MARKS // 5, np.zeros(1, np.int64)), {}
    (parameter,) = (p.name for p in MODEL.mechanisms[name].parameters)
    values[f"{name}.{parameter}"] = nearly
    ran = []
    for own in (WALL, WALL | values):
        held = {name: x[0, MARKS // 5] for name, x in motion.items()}
        initial = held | {name: x[0] for name, x in MODEL.carry(own, base, asked).items()}
        ran.append(MODEL.trajectories(own, base, first=MARKS // 5, samples=AHEAD // 5, initial=initial)["rotation_1"])
    assert np.max(np.abs(ran[1] - ran[0])) < 0.02 * np.max(np.abs(channels["rotation_1"]))
