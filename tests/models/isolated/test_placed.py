"""Instruments at the levels of a building: what they read from its poses against its own observables and states."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid

from models.base import History
from models.errors import InputError
from models.isolated.reference import run as reference
from models.kinematics import Place
from models.shaking import Shaking
from tests.models.isolated.buildings import HOUSE, LAWS, MODEL, chain, two_tones
from tests.models.requests import asked

UNEQUAL = {**{k: v for k, v in HOUSE.items() if k != "total_mass"}, "levels": 3.0, "storey_stiffness": 3e7}
MASSES = {"level_mass_1": 9e4, "level_mass_2": 6e4, "level_mass_3": 3e4}
VALUES = {**UNEQUAL, **MASSES, **LAWS["bouc_wen, n 1"]}


def ran(step: float) -> tuple[History, Shaking, tuple[np.ndarray, np.ndarray]]:
    shaking = two_tones(step=step)
    return MODEL.simulate(VALUES, shaking), shaking, (shaking.horizontal, np.zeros_like(shaking.horizontal))


def read(place: Place, step: float) -> np.ndarray:
    history, shaking, ground = ran(step)
    size = shaking.horizontal.size
    poses = {name: x[:size] for name, x in history.channels.items() if x.ndim == 1}
    return place.read(poses, step, ground)


def test_displacements_and_drifts_are_those_of_the_levels() -> None:
    history, shaking, _ = ran(0.01)
    x = history.channels["level_displacement_x"][:, : shaking.horizontal.size]
    for k in range(3):
        np.testing.assert_array_equal(read(Place("displacement", k + 1, z=2.0), 0.01), x[k])
        below = x[k] - (x[k - 1] if k else 0.0)
        np.testing.assert_array_equal(read(Place("displacement", k + 1, relative_to="body_below"), 0.01), below)


@pytest.mark.parametrize(
    ("place", "exact"),
    [
        (Place("velocity", 1), lambda h: h.channels["bearing_velocity"]),
        (Place("acceleration", 3, relative_to="absolute"), lambda h: h.channels["level_acceleration_x"][2]),
        (Place("acceleration", 2, 0.0, 0.0, "across", "absolute"), lambda h: h.channels["level_acceleration_x"][1]),
        (Place("force", 1), lambda h: -h.channels["bearing_force"]),
        (Place("force", 3), lambda h: MASSES["level_mass_3"] * h.channels["level_acceleration_x"][2]),
    ],
)
def test_rates_and_forces_are_those_of_the_model(place: Place, exact: Callable[[History], np.ndarray]) -> None:
    history, shaking, _ = ran(0.01)
    true = exact(history)[: shaking.horizontal.size]
    np.testing.assert_allclose(read(place, 0.01), true, rtol=0, atol=1e-12 * np.max(np.abs(true)))


@pytest.mark.parametrize("body", [1, 2, 3])
def test_rates_are_those_of_the_displacements(body: int) -> None:
    """Their integrals, by the trapezoidal rule: to the square of the step."""
    errors = []
    for step in (0.01, 0.005):
        x, v = (read(Place(what, body), step) for what in ("displacement", "velocity"))
        a = read(Place("acceleration", body, relative_to="base"), step)
        moved, gained = (cumulative_trapezoid(rate, dx=step, initial=0.0) for rate in (v, a))
        errors.append([np.max(np.abs(x - moved)) / np.max(np.abs(x)), np.max(np.abs(v - gained)) / np.max(np.abs(v))])
    assert np.max(errors[0]) < 0.02
    np.testing.assert_allclose(np.divide(errors[0], errors[1]), 4.0, rtol=0.3)


def test_the_reference_places_the_levels_alike() -> None:
    building, shaking = chain(VALUES), two_tones()
    own = MODEL.poses(building, reference.run(building, asked(shaking, samples=301)).samples)
    fast = MODEL.simulate(VALUES, shaking, duration=3.0).channels
    for k in (1, 2, 3):
        name = f"underside_{k}_x"
        np.testing.assert_allclose(own[name][0], fast[name], rtol=0, atol=1e-3 * np.max(np.abs(fast[name])))


@pytest.mark.parametrize(
    ("place", "why"),
    [
        (Place("displacement", 4), "body 4 and model isolated has 3 bodies"),
        (Place("displacement", 1, direction="z"), "move to the right and left alone"),
        (Place("rotation", 2), "move to the right and left alone"),
        (Place("uplift", 1), "move to the right and left alone"),
        (Place("force", 1, direction="z"), "move to the right and left alone"),
    ],
)
def test_what_levels_do_not_do_is_refused(place: Place, why: str) -> None:
    with pytest.raises(InputError, match=why):
        MODEL.check_place("gauge", place, VALUES)
    with pytest.raises(InputError, match="gauge is on body 2 and model isolated has one body"):
        MODEL.check_place("gauge", Place("displacement", 2), {})
