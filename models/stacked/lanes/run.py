"""From stacks and a shaking to the tables of the lane kernel, and back to results."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from models.base import Event, FloatArray
from models.shaking import Shaking
from models.stacked.account import N_ACCOUNT
from models.stacked.declaration import REST_VELOCITY
from models.stacked.equation import products, vectors
from models.stacked.lanes import rows as r
from models.stacked.lanes.advance import advance
from models.stacked.stack import Stack

EVENTS = ("onset", "impact", "change_of_pattern", "rest", "overturned")
LARGEST_PHASE = 0.02
"""Largest growth rate times step; the error of the rule falls with its fourth power."""
CHUNK = 64


@dataclass(frozen=True)
class Lanes:
    """Accounts ``(n, N_ACCOUNT)``; theta_1, r and their rates ``(n, samples, 4)`` and events if asked for."""

    account: FloatArray
    trace: FloatArray | None
    events: tuple[tuple[Event, ...], ...] | None
    steps: int


def fastest_rate(stack: Stack) -> FloatArray:
    """The largest growth rate (s-1) of the upright stack over all configurations.

    M q'' = K q with K = G diag(m1 h1 + m2 (2 h1 + h2), m2 h2) + G m2 h2 (coupling of theta_1 and r).
    """
    weight_2 = stack.gravity * stack.mass_2 * stack.centre_2
    weight = stack.gravity * stack.mass * stack.centre
    rates = [stack.frequency_parameter**2, stack.frequency_parameter_2**2]
    for s2 in (1.0, -1.0):
        upright = vectors(stack, 1.0, s2, (np.zeros(stack.size), np.zeros(stack.size)), False)
        m11, m12, _, m22 = products(stack, upright, upright)
        determinant = m11 * m22 - m12 * m12
        trace = (m22 * weight + m11 * weight_2 - 2.0 * m12 * weight_2) / determinant
        product = (weight * weight_2 - weight_2 * weight_2) / determinant
        rates.append(0.5 * (trace + np.sqrt(np.maximum(trace * trace - 4.0 * product, 0.0))))
    return np.asarray(np.sqrt(np.max(rates, axis=0)))


def substeps(stack: Stack, time_step: float) -> NDArray[np.int64]:
    """Steps per sample of the record, lane by lane: never a matter of which lanes run together."""
    return np.maximum(1, np.ceil(fastest_rate(stack) * time_step / LARGEST_PHASE - 1e-9)).astype(np.int64)


def records(shaking: Shaking, n: int, tail: float) -> tuple[FloatArray, FloatArray, int]:
    """The record at the ends of the steps with its quiet tail, extremes of its chunks, steps of shaking."""
    step = shaking.time_step / n
    quiet = int(np.ceil(tail / step - 1e-9))
    count = shaking.horizontal.size
    shaken = (count - 1) * n
    record = np.zeros((3, shaken + quiet + 2))
    fine = np.arange(shaken + 1) / n
    for row, samples in enumerate((shaking.horizontal, shaking.vertical)):
        if samples is not None:
            record[row, : shaken + 1] = np.interp(fine, np.arange(count), samples)
    record[2, :shaken] = 1.0
    chunks = max(record.shape[1] // CHUNK, 1)
    chunk = np.zeros((2, chunks))
    for c in range(chunks):
        chunk[:, c] = np.max(np.abs(record[:2, c * CHUNK : (c + 1) * CHUNK + 1]), axis=1)
    return record, chunk, shaken


def given_table(stack: Stack, scale: FloatArray, initial: Mapping[str, FloatArray]) -> FloatArray:
    """The constants of the lanes, a line a lane with the columns of `rows`."""
    table = np.zeros((stack.size, r.N_GIVEN))
    lean = np.abs(np.arctan2(stack.offset, stack.gravity))
    own_1 = np.arctan2(stack.base_pivot - np.abs(stack.shift_1), stack.centre_1) - lean
    whole = stack.centre
    right = np.minimum((stack.base_pivot - stack.shift) / whole, (stack.top_pivot - stack.shift_2) / stack.centre_2)
    left = np.minimum((stack.base_pivot + stack.shift) / whole, (stack.top_pivot + stack.shift_2) / stack.centre_2)
    for column, values in (
        (r.P_SCALE, scale),
        (r.P_OFFSET, stack.offset),
        (r.P_GRAVITY, stack.gravity),
        (r.P_VSCALE, stack.vertical_factor * scale),
        (r.P_M1, stack.mass_1),
        (r.P_I1, stack.inertia_1),
        (r.P_H1, stack.centre_1),
        (r.P_TALL, stack.height_1),
        (r.P_M2, stack.mass_2),
        (r.P_I2, stack.inertia_2),
        (r.P_H2, stack.centre_2),
        (r.P_B1, stack.base_pivot),
        (r.P_B2, stack.top_pivot),
        (r.P_D1, stack.shift_1),
        (r.P_D2, stack.shift_2),
        (r.P_GIVEN_1, stack.base_restitution),
        (r.P_GIVEN_2, stack.top_restitution),
        (r.P_FACTOR_1, stack.base_factor),
        (r.P_FACTOR_2, stack.top_factor),
        (r.P_VISCOUS, stack.viscous),
        (r.P_CALM_1, REST_VELOCITY * stack.frequency_parameter * stack.slenderness),
        (r.P_CALM_2, REST_VELOCITY * stack.frequency_parameter_2 * stack.slenderness_2),
        (r.P_STAND_1, np.clip(own_1, 1e-9, None)),
        (r.P_STAND_2, np.clip(stack.slenderness_2 - lean, 1e-9, None)),
        (r.P_RIGHT, right),
        (r.P_LEFT, left),
        (r.P_Q1, initial.get("q1", 0.0)),
        (r.P_Q2, initial.get("q2", 0.0)),
        (r.P_V1, initial.get("w1", 0.0)),
        (r.P_V2, initial.get("w2", 0.0)),
    ):
        table[:, column] = values
    return table


def run(
    stack: Stack,
    shaking: Shaking,
    scale: FloatArray,
    *,
    tail: float = 0.0,
    linear: bool = False,
    initial: Mapping[str, FloatArray] | None = None,
    first: NDArray[np.int64] | None = None,
    last: NDArray[np.int64] | None = None,
    samples: int = 0,
    log: int = 0,
    fall: bool = False,
    refinement: int = 1,
) -> Lanes:
    """Run n lanes of ``stack`` under ``scale`` (n,) times the shaking.

    ``initial``: theta_1, r (rad) and their rates (rad s-1) as q1, q2, w1, w2. ``first`` and ``last``
    (n,) are samples of the shaking between which each lane runs (default: all, and the tail);
    ``samples`` > 0 returns the states at the samples from ``first`` on; ``log`` > 0 returns up to that
    many events a lane. ``refinement`` divides every step.
    """
    n = stack.size
    out = np.zeros((n, N_ACCOUNT))
    trace = np.zeros((n, samples, 4))
    logged: list[tuple[Event, ...]] = [()] * n
    steps = 0
    per_sample = substeps(stack, shaking.time_step) * refinement
    state = {k: np.broadcast_to(np.asarray(v, float), (n,)) for k, v in (initial or {}).items()}
    for sub in np.unique(per_sample).tolist():
        lanes = np.flatnonzero(per_sample == sub)
        record, chunk, shaken = records(shaking, sub, tail)
        begin = np.zeros(lanes.size, np.int64) if first is None else first[lanes] * sub
        end = np.full(lanes.size, record.shape[1] - 2) if last is None else last[lanes] * sub
        given = given_table(stack.take(lanes), scale[lanes], {k: v[lanes] for k, v in state.items()})
        result = np.zeros((lanes.size, r.N_RESULT))
        part_trace = np.zeros((lanes.size, samples, 4))
        part_log = np.zeros((lanes.size, log, 3))
        count = np.zeros(lanes.size, np.int64)
        steps += advance(
            record, chunk, shaking.time_step / sub, shaken, begin, end, given, result,
            sub if samples else 0, part_trace, part_log, count, fall, True if linear else None,
        )  # fmt: skip
        out[lanes] = result[:, :N_ACCOUNT]
        trace[lanes] = part_trace
        for k, lane in enumerate(lanes):
            rows = part_log[k, : min(count[k], log)]
            logged[lane] = tuple(Event(float(t), EVENTS[int(kind)], int(body)) for t, kind, body in rows)
    return Lanes(out, trace if samples else None, tuple(logged) if log else None, steps)
