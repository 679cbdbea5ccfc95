"""The block of a case: what the laboratory knows of it, and what it is."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

GRAVITY = 9.80665
TOLERANCE = {"width": 0.005, "height": 0.005, "mass": 0.01}
DENSITY = (1400.0, 2400.0)
LENGTH = (0.4, 1.2)


@dataclass(frozen=True)
class Block:
    """Nominal and true values (SI) of width, height and mass; the tolerances are relative sigmas."""

    nominal: Mapping[str, float]
    true: Mapping[str, float]


def draw(rng: np.random.Generator) -> Block:
    """A masonry pier, 1-2.6 m high, width over height .11-.28, within tolerance of its drawing."""
    height = round(float(rng.uniform(1.0, 2.6)), 2)
    width = round(height * float(rng.uniform(0.11, 0.28)), 3)
    mass = round(width * height * float(rng.uniform(*DENSITY)) * float(rng.uniform(*LENGTH)), 1)
    nominal = {"width": width, "height": height, "mass": mass}
    true = {name: value * (1.0 + TOLERANCE[name] * float(rng.normal())) for name, value in nominal.items()}
    return Block(nominal, true)
