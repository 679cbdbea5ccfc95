"""The two stacks of the published numbers, and random ones."""

from __future__ import annotations

import numpy as np

from models.base import FloatArray
from models.stacked.equation import motion
from models.stacked.model import MODEL
from models.stacked.reference.choice import Corners
from models.stacked.stack import Stack

G = 9.81
A = {
    "wall_length": 1.0, "wall_height": 3.0, "wall_mass": 1000.0, "top_mass": 500.0, "top_length": 0.6,
    "top_height": 1.2, "gravity": G,
}  # fmt: skip
B = {**A, "top_height": 3.2}
LANES = ("lanes", "reference")


def random_stacks(rng: np.random.Generator, size: int) -> Stack:
    """Masses from 10 kg to 10 t, half lengths and heights from .1 to 3 m, either block the larger."""

    def spread(low: float, high: float) -> FloatArray:
        return np.exp(rng.uniform(np.log(low), np.log(high), size))

    mass_1, mass_2 = spread(10.0, 1e4), spread(10.0, 1e4)
    b1, b2, h1, h2 = (spread(0.1, 3.0) for _ in range(4))
    zero, one = np.zeros(size), np.ones(size)
    return Stack(
        mass_1=mass_1, inertia_1=mass_1 * (b1**2 + h1**2) / 3.0, centre_1=h1, height_1=2.0 * h1,
        mass_2=mass_2, inertia_2=mass_2 * (b2**2 + h2**2) / 3.0, centre_2=h2,
        half_length_1=b1, half_joint=b2, base_pivot=b1, top_pivot=b2, shift_1=zero, shift_2=zero,
        gravity=np.full(size, G), offset=zero, vertical_factor=zero,
        base_restitution=np.full(size, np.nan), top_restitution=np.full(size, np.nan),
        base_factor=one, top_factor=one, viscous=zero, coulomb=zero,
        pitch_per_acceleration=zero, pitch_low_pass=10.0 * one,
    )  # fmt: skip


def random_wall(rng: np.random.Generator) -> dict[str, float]:
    """Parameters of a wall of 1 to 4 m with a block on top, of any relative size."""
    height = float(rng.uniform(1.0, 4.0))
    aspect = float(rng.uniform(0.15, 0.6))
    return {
        "wall_height": height,
        "aspect_ratio": aspect,
        "wall_mass": float(rng.uniform(200.0, 3000.0)),
        "top_mass": float(np.exp(rng.uniform(np.log(50.0), np.log(5000.0)))),
        "top_length": height * aspect * float(rng.uniform(0.3, 1.5)),
        "top_height": float(rng.uniform(0.1, 1.0)) * height,
    }


def random_walls(seed: int, count: int) -> tuple[Stack, FloatArray]:
    """Walls with their onset accelerations."""
    rng = np.random.default_rng(seed)
    walls = [random_wall(rng) for _ in range(count)]
    values = {name: np.array([wall[name] for wall in walls]) for name in walls[0]}
    values["pivot_inset.inset_over_half_width_top"] = rng.uniform(0.0, 0.2, count)
    values["restitution.factor_on_housner_base"] = rng.uniform(0.8, 1.0, count)
    values["eccentricity.offset_over_half_width"] = rng.uniform(-0.1, 0.1, count)
    values["viscous_damping.rate"] = rng.uniform(0.0, 0.3, count)
    onset = MODEL.derive(values)["onset_acceleration"]
    return MODEL.build(values, vertical=True), onset * rng.uniform(1.2, 4.0, count)


def at_rest(stack: Stack, a: float | FloatArray, gravity: float | FloatArray = G) -> Corners:
    """Forces on the resting stack under base acceleration ``a``."""
    return lambda c1, c2: motion(stack, c1, c2, (0.0, 0.0), (0.0, 0.0), (a, gravity, 0.0), False)
