"""Blocks, shakings and typical sizes of every mechanism of the one-block model, for the tests."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

import models
from models.base import FloatArray
from models.housner.lanes import run as lanes
from models.housner.reference import run as reference
from models.runs import Request, Run
from models.shaking import Shaking
from models.tables import KNOTS, SIDES, row

HOUSNER = models.get("housner")
WALL = {"width": 0.5, "height": 2.0, "mass": 900.0}
ALPHA = float(np.arctan(0.25))
P = float(HOUSNER.derive(WALL)["frequency_parameter"][0])

TYPICAL: dict[str, dict[str, float]] = {
    "vertical_acceleration": {"kappa": 0.8},
    "sliding": {"friction": 0.27},
    "pivot_inset": {"inset_over_half_width": 0.15},
    "rounded_corner": {"radius_over_half_width": 0.2},
    "crushing": {"inset_per_rotation": 1.5},
    "tilt": {"tilt": 0.01},
    "eccentricity": {"offset_over_half_width": 0.08},
    "flexible_joint": {"angle": 0.006},
    "added_stiffness": {"over_m_g_R": 0.3, "gap": 0.03},
    "table_pitch": {"pitch_per_acceleration": 0.001, "low_pass_hz": 8.0},
    "restitution": {"factor_on_housner": 0.9},
    "velocity_restitution": {"beta": 0.3},
    "bounce": {"contact_restitution": 0.3},
    "viscous_damping": {"rate": 0.3},
    "coulomb_damping": {"over_m_g_b": 0.05},
    "quadratic_damping": {"coefficient": 2.0},
    "degradation": {"loss_of_restitution_per_impact": 0.02, "floor": 0.8},
    "wall_flexibility": {"first_frequency": 12.0},
    "table_force": {
        "reach_rotation": 0.1, "reach_rate": 0.4, "reach_base": 4.0, "oscillator_motion": 0.05,
        "oscillator_force": 0.04, "oscillator_frequency": 2.0, "oscillator_damping": 0.05,
    }
    | {
        row(term, side, knot): size * math.sin(2.0 * knot + len(term) + (side == "above")) * (knot > 0 or jumps)
        for term, size, jumps in (
            ("rotation", 0.1, True), ("rate", 0.05, False), ("damping", 0.1, True), ("friction", 0.03, True),
            ("base", 0.1, False), ("base_damping", 0.1, False), ("outward", 0.1, True),
            ("impact", 0.03, True),
        )
        for side in SIDES
        for knot in range(KNOTS)
    },
}  # fmt: skip


def dotted(name: str, values: Mapping[str, Any]) -> dict[str, Any]:
    return {f"{name}.{parameter}": value for parameter, value in values.items()}


def pulse(amplitude: float, period: float, *, rest: float = 2.5, step: float = 0.005, up: float = 0.4) -> Shaking:
    """One full sine of acceleration (m s-2), a vertical one of twice the frequency, then quiet."""
    time = np.arange(round((period + rest) / step) + 1) * step
    inside = time <= period
    across = np.where(inside, amplitude * np.sin(2 * np.pi * time / period), 0.0)
    vertical = np.where(inside, up * amplitude * np.sin(4 * np.pi * time / period), 0.0)
    return Shaking(step, across, vertical, vertical_acts=False)


def free(duration: float, step: float = 0.005) -> Shaking:
    return Shaking(step, np.zeros(round(duration / step) + 1), np.zeros(round(duration / step) + 1), False)


@dataclass(frozen=True)
class Response:
    """One run: outputs, and theta, theta', shift at the samples; events as (time, kind)."""

    outputs: dict[str, float]
    rotation: FloatArray
    rate: FloatArray
    shift: FloatArray
    events: tuple[tuple[float, str], ...]


def by_lanes(
    values: Mapping[str, Any], shaking: Shaking, initial: Mapping[str, float] | None = None, refinement: int = 1
) -> Response:
    """One run by the kernel, as long as the record."""
    block = HOUSNER.build(values, vertical=shaking.vertical is not None and shaking.vertical_acts)
    return _response(lanes.run(block, _request(shaking, initial), refinement))


def by_reference(values: Mapping[str, Any], shaking: Shaking, initial: Mapping[str, float] | None = None) -> Response:
    """The same by the reference."""
    block = HOUSNER.build(values, vertical=shaking.vertical is not None and shaking.vertical_acts)
    return _response(reference.run(block, _request(shaking, initial)))


def _request(shaking: Shaking, initial: Mapping[str, float] | None) -> Request:
    start = {name: np.array([value]) for name, value in (initial or {}).items()}
    return Request(shaking, np.ones(1), initial=start, samples=shaking.horizontal.size, log=2000)


def _response(run: Run) -> Response:
    outputs = {name: float(values[0]) for name, values in run.outputs.items()}
    return Response(outputs, *np.moveaxis(run.samples[0], -1, 0), tuple((e.time, e.kind) for e in run.events[0]))


def released(start: float) -> float:
    """Energy (J) that `WALL` has at rest at the rotation ``start`` over standing upright."""
    b, h = WALL["width"] / 2, WALL["height"] / 2
    return WALL["mass"] * 9.80665 * (b * np.sin(start) + h * np.cos(start) - h)
