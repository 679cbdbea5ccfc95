"""Displacements of the centres against the chain of bodies drawn from the ground up."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from models.base import FloatArray
from models.interface.layered import LayeredWall
from models.interface.model import MODEL
from tests.models.interface.walls import SHORT

SIZE, SAMPLES = 3, 5


def turned(angle: FloatArray) -> FloatArray:
    """The direction of a body's height as a complex number, x to the right, turned clockwise."""
    return np.asarray(1j * np.exp(-1j * angle))


def over_the_edge(half_width: FloatArray, angle: FloatArray) -> FloatArray:
    """What a body that rolls over its edge moves on: it turns about the corner towards which it leans."""
    return np.sign(angle) * half_width[:, None] * (1.0 - np.cos(angle))


def drawn(wall: LayeredWall, state: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Displacements (n, m) of the centre of the wall and of that of the block: lower half, upper half, block."""
    toe = 1.0 if wall.toe_held else 0.0
    t1, t2, _, z2 = np.moveaxis(state[:, :, :4], 2, 0)
    x1, x2, tm, zm = np.moveaxis(state[:, :, 8:12], 2, 0) if state.shape[2] == 16 else (0.0, 0.0, t1, 0.0)
    offset = 0.0 if wall.effects is None else wall.effects.top_offset[:, None]
    half = 0.5 * wall.height_1[:, None]
    foot = x1 + toe * over_the_edge(wall.base_half_width, t1)
    middle = foot + half * turned(t1)
    lower = foot + 0.5 * half * turned(t1)
    upper = middle + (zm + 0.5 * half) * turned(tm)
    joint = middle + (zm + half + wall.top_thickness_in_height[:, None] + z2) * turned(tm)
    slip = x2 + toe * over_the_edge(wall.top_half_width, t2 - tm)
    block = joint + slip * np.exp(-1j * tm) + (wall.centre_2[:, None] * 1j + offset) * np.exp(-1j * t2)
    return np.real(0.5 * (lower + upper)), np.real(block)


@pytest.mark.parametrize("mechanisms", [{}, {"sliding.friction": 0.3, "eccentricity.offset_top": 0.07}])
@pytest.mark.parametrize("largest", [0.02, 3.0])
@pytest.mark.parametrize("toe_held", [False, True])
def test_the_centres(mechanisms: dict[str, float], largest: float, toe_held: bool) -> None:
    height = np.linspace(1.0, 1.4, SIZE)
    wall = replace(MODEL.build({**SHORT, "wall_height": height, **mechanisms}), toe_held=toe_held)
    draws = np.random.default_rng(1).uniform(-1.0, 1.0, (SIZE, SAMPLES, 16 if mechanisms else 8))
    state = draws * largest
    state[:, 0] = 0.0
    seen = MODEL.observe(wall, state)
    for name, found in zip(("displacement_1_x", "displacement_2_x"), drawn(wall, state), strict=True):
        np.testing.assert_allclose(seen[name], found, rtol=1e-12, atol=1e-14)


def test_the_centres_of_a_wall_that_cannot_stand_are_no_numbers() -> None:
    wall = MODEL.build(SHORT)
    state = np.full((1, 2, 8), np.nan)
    assert np.isnan(MODEL.observe(wall, state)["displacement_2_x"]).all()
