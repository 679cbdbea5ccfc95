"""Walls on rubber as the tests use them: the illustrative short and long wall, and random ones."""

from __future__ import annotations

from typing import Any

import numpy as np

import models
from models.interface.layered import LayeredWall

MODEL = models.get("interface")
SHORT: dict[str, Any] = {
    "wall_length": 0.72,
    "wall_height": 1.8,
    "wall_thickness": 0.138,
    "wall_density": 900.0,
    "top_mass": 5000.0,
    "top_length": 2.0,
    "top_height": 0.6,
    "layer_thickness": 0.01,
    "layer_modulus": 4.5e6,
    "damping_ratio": 0.0544,
    "gravity": 9.81,
}
LONG = {**SHORT, "wall_length": 2.0, "damping_ratio": 0.0167}


def wall(values: dict[str, Any], **options: str) -> LayeredWall:
    """Coefficients of one wall."""
    return MODEL.build(values, options)


def undamped(values: dict[str, Any]) -> dict[str, Any]:
    """The same without dashpots."""
    return {**{k: v for k, v in values.items() if k != "damping_ratio"}, "base_damping": 0.0, "top_damping": 0.0}


def block_on_strip(stiffness: float, damping: float = 0.0) -> dict[str, Any]:
    """A block of 1000 kg, h = 1 m, b/h = 1/4 on a strip, as a wall and a slice of it bonded on top."""
    low, high = 1.98, 0.02
    return {
        "wall_length": 0.5,
        "wall_height": low,
        "wall_mass": 1000.0 * low / (low + high),
        "top_mass": 1000.0 * high / (low + high),
        "top_length": 0.5,
        "top_height": high,
        "base_layer_thickness": 0.01,
        "base_stiffness": stiffness,
        "base_damping": damping,
        "gravity": 9.81,
    }


def stacked(walls: list[dict[str, float]]) -> dict[str, np.ndarray]:
    """Walls of their own as one set of arrays."""
    return {name: np.array([one[name] for one in walls]) for name in walls[0]}


def random_wall(rng: np.random.Generator) -> dict[str, float]:
    """A wall within and around the range of the study on the rubber interface."""
    return {
        "aspect_ratio": float(rng.uniform(0.35, 1.2)),
        "wall_height": float(rng.uniform(1.2, 3.0)),
        "wall_thickness": 0.138,
        "wall_density": float(rng.uniform(700.0, 1500.0)),
        "top_mass": float(rng.uniform(1000.0, 6000.0)),
        "top_length": float(rng.uniform(0.4, 2.5)),
        "top_height": float(rng.uniform(0.3, 0.9)),
        "layer_thickness": 0.01,
        "base_layer_modulus": float(np.exp(rng.uniform(np.log(2e6), np.log(2e7)))),
        "top_layer_modulus": float(np.exp(rng.uniform(np.log(2e6), np.log(2e7)))),
        "damping_ratio": float(rng.uniform(0.01, 0.12)),
    }
