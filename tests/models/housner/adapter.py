"""The three integrators of the block behind the model's face, as the tests use them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

import models
from models.base import Event, FloatArray, History
from models.housner.block import Block
from models.housner.reference import run as reference
from models.runs import Request
from models.shaking import Shaking

MODEL = models.get("housner")
SUMMED = tuple(quantity.name for quantity in MODEL.outputs if not quantity.peak_of)
"""Outputs that a run sums up; those read off histories take a second run, of every sample."""
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
    values: Mapping[str, float],
    shaking: Shaking,
    scale: FloatArray,
    *,
    tail: float = 10.0,
    linear: bool = False,
    outputs: Sequence[str] = SUMMED,
) -> dict[str, NDArray[Any]]:
    """``outputs`` ``(n,)`` of one block under n scales of the shaking."""
    return MODEL.evaluate(
        values,
        shaking,
        np.atleast_1d(scale),
        outputs=outputs,
        tail=tail,
        options={"formulation": "linear" if linear else "nonlinear"},
        integrator=integrator,
    )


def history(
    integrator: str,
    values: Mapping[str, float],
    shaking: Shaking,
    *,
    initial: Mapping[str, float],
    linear: bool = False,
) -> History:
    """One run as long as the record."""
    return MODEL.simulate(
        values,
        shaking,
        initial=initial,
        options={"formulation": "linear" if linear else "nonlinear"},
        integrator=integrator,
    )


@dataclass(frozen=True)
class Response:
    """Response of one block by the reference: outputs, history at the samples, events."""

    outputs: dict[str, float]
    time: FloatArray
    rotation: FloatArray
    rate: FloatArray
    shift: FloatArray
    events: tuple[Event, ...]


def by_reference(
    block: Block,
    shaking: Shaking,
    scale: float = 1.0,
    *,
    tail: float = 0.0,
    initial: Mapping[str, float] | None = None,
    rtol: float = 1e-10,
) -> Response:
    """One block by the reference."""
    start = {name: np.array([value]) for name, value in (initial or {}).items()}
    request = Request(shaking, np.array([scale]), tail=tail, initial=start)
    run = reference.run(block, request, rtol)
    outputs = {name: float(values[0]) for name, values in run.outputs.items()}
    return Response(outputs, request.times, *np.moveaxis(run.samples[0], -1, 0), run.events[0])
