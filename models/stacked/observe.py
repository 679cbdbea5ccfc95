"""From states to what instruments would see, and back from given states."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import Any

import numpy as np

from models.base import FloatArray
from models.observed import Observed
from models.stacked.account import OVERTURNED_1, OVERTURNED_2
from models.stacked.equation import vectors
from models.stacked.stack import Stack

HALF_TURN = np.pi / 2.0


def initial_state(initial: Mapping[str, Any], size: int) -> dict[str, FloatArray]:
    """theta_1, r and their rates ``(n,)`` from rotations against the base.

    The upper block is seated on the wall where its rotation (or rate) is not given.
    """
    found = {}
    for name, first, second in (("q", "rotation_1", "rotation_2"), ("w", "rotation_rate_1", "rotation_rate_2")):
        lower = np.broadcast_to(np.asarray(initial.get(first, 0.0), float), (size,))
        upper = np.broadcast_to(np.asarray(initial.get(second, lower), float), (size,))
        found[f"{name}1"], found[f"{name}2"] = lower, upper - lower
    return found


def settled_history(trace: FloatArray, table: FloatArray) -> FloatArray:
    """States ``(n, samples, 4)`` in which an overturned body stays at pi/2 after the last state computed."""
    trace = trace.copy()
    for lane in np.flatnonzero(~np.isnan(table[:, OVERTURNED_2])):
        rotation = trace[lane, :, 0] + np.array([[0.0], [1.0]]) * trace[lane, :, 1]
        beyond = np.any(np.abs(rotation) >= HALF_TURN - 1e-6, axis=0)
        moved = np.flatnonzero(np.any(trace[lane] != 0.0, axis=1))
        stop = int(np.argmax(beyond)) if beyond.any() else int(moved[-1]) + 1 if moved.size else 0
        if stop == 0 or (stop >= trace.shape[1] and not beyond.any()):
            continue
        last = rotation[:, stop - 1]
        down = np.array([not np.isnan(table[lane, OVERTURNED_1]), True])
        end = np.where(down, np.copysign(HALF_TURN, last), last)
        trace[lane, stop:] = [end[0], end[1] - end[0], 0.0, 0.0]
    return trace


def observe(stack: Stack, trace: FloatArray) -> Observed:
    """The observables ``(n, samples)`` of states ``(n, samples, 4)``: theta_1, r and their rates."""
    wide = stack.take((slice(None), None))
    q1, q2, w1, w2 = np.moveaxis(trace, -1, 0)

    @cache
    def displacements() -> tuple[FloatArray, FloatArray]:
        s1, s2 = np.where(q1 >= 0.0, 1.0, -1.0), np.where(q2 >= 0.0, 1.0, -1.0)
        v = vectors(wide, s1, s2, (q1, q2), False)
        pivot = s1 * wide.base_pivot
        return pivot + v.ax - wide.shift_1, pivot + v.dx - wide.shift_2

    return Observed(
        {
            "rotation_1": lambda: q1,
            "rotation_2": lambda: q1 + q2,
            "rotation_rate_1": lambda: w1,
            "rotation_rate_2": lambda: w1 + w2,
            "displacement_1_x": lambda: displacements()[0],
            "displacement_2_x": lambda: displacements()[1],
            "contact_1": lambda: ((q1 == 0.0) & (w1 == 0.0)).astype(float),
            "contact_2": lambda: ((q2 == 0.0) & (w2 == 0.0)).astype(float),
        }
    )
