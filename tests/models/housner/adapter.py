"""The three integrators of the block behind one face, as the tests use them."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from models.base import FloatArray
from models.housner import newmark, reference
from models.housner.block import Block, build
from models.housner.lanes import run as lanes
from models.shaking import Shaking

INTEGRATORS = ("lanes", "reference", "newmark")
EXACT = ("lanes", "reference")
"""Integrators whose error is far below the digits of the oracles at any sensible step."""


def rectangle(alpha: float, p: float = 2.0, g: float = 9.80665, **more: float) -> dict[str, float]:
    """Solid rectangle of slenderness ``alpha`` (rad) and p (s-1): R = 3 g/(4 p^2)."""
    radius = 3.0 * g / (4.0 * p**2)
    size = {"width": 2.0 * radius * np.sin(alpha), "height": 2.0 * radius * np.cos(alpha)}
    return {**size, "mass": 1000.0, "gravity": g, **more}


def outcomes(
    integrator: str,
    block: Block,
    shaking: Shaking,
    scale: FloatArray,
    *,
    tail: float = 10.0,
    linear: bool = False,
) -> dict[str, FloatArray]:
    """Outputs ``(n,)`` of n lanes."""
    if integrator == "lanes":
        table = lanes.run(block, shaking, scale, tail=tail, linear=linear).result
        return lanes.outputs(block, table)
    if integrator == "newmark":
        return newmark.run(block, shaking, scale, tail=tail, linear=linear).outputs
    runs = [
        reference.run(block.take([k]), shaking, float(scale[k]), tail=tail, linear=linear).outputs
        for k in range(block.size)
    ]
    return {name: np.array([run[name] for run in runs]) for name in runs[0]}


def history(
    integrator: str,
    values: Mapping[str, float],
    shaking: Shaking,
    *,
    initial: Mapping[str, float],
    linear: bool = False,
) -> tuple[dict[str, float], FloatArray, list[tuple[float, str]]]:
    """Outputs, rotation at the samples, and events, of one free or forced run as long as the record."""
    block = build(values, vertical=shaking.vertical is not None)
    one = np.ones(1)
    if integrator == "lanes":
        start = {name: np.array([value]) for name, value in initial.items()}
        result = lanes.run(
            block, shaking, one, linear=linear, initial=start, samples=shaking.horizontal.size, log=1000
        )
        assert result.rotation is not None and result.events is not None
        table = lanes.outputs(block, result.result)
        return {k: float(v[0]) for k, v in table.items()}, result.rotation[0], list(result.events[0])
    if integrator == "newmark":
        steps = newmark.run(block, shaking, one, tail=0.0, linear=linear, initial=initial)
        events = [(e.time, e.kind) for e in steps.events[0]]
        return {k: float(v[0]) for k, v in steps.outputs.items()}, steps.rotation[0], events
    run = reference.run(block, shaking, tail=0.0, linear=linear, initial=initial)
    return run.outputs, run.rotation, [(e.time, e.kind) for e in run.events]
