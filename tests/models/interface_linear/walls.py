"""Walls of the linear model, scipy's matrix exponential of one configuration, and energies."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.linalg import expm

import models
from models.base import FloatArray
from models.interface.layered import LayeredWall
from models.interface_linear import equation

MODEL: Any = models.get("interface_linear")


def wall(values: dict[str, Any], joints: str = "both") -> LayeredWall:
    """Coefficients of one wall."""
    return MODEL.build(values, {"joints": joints})


def by_exponential(
    one: LayeredWall, sides: tuple[int, int], state: FloatArray, time: float, a: tuple[float, float] = (0.0, 0.0)
) -> FloatArray:
    """q, q' (8,) a ``time`` (s) later in one configuration: exp of the equations with a, its slope, g and 1."""
    mass, damping, stiffness = (matrix[0] for matrix in equation.matrices(one, sides))
    load = equation.loads(one)[0]
    inverse = np.linalg.inv(mass)
    f = np.zeros((11, 11))
    f[:4, 4:8] = np.eye(4)
    f[4:8, :4], f[4:8, 4:8] = -inverse @ stiffness, -inverse @ damping
    f[4:8, 8], f[4:8, 10] = inverse @ load[:, 0], inverse @ load[:, 1]
    f[8, 9] = 1.0
    return np.asarray((expm(f * time) @ np.concatenate([state, a, [one.gravity[0]]]))[:8])


def energy(one: LayeredWall, sides: tuple[int, int], state: FloatArray) -> FloatArray:
    """Kinetic, elastic and gravity's energy (J) of states ``(..., 8)`` in one configuration."""
    mass, _, stiffness = (matrix[0] for matrix in equation.matrices(one, sides))
    load = equation.loads(one)[0, :, 1] * one.gravity[0]
    q, v = state[..., :4], state[..., 4:]
    quadratic = np.einsum("...i,ij,...j", v, mass, v) + np.einsum("...i,ij,...j", q, stiffness, q)
    return np.asarray(0.5 * quadratic - q @ load)
