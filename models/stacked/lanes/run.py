"""From stacks and a shaking to the tables of the lane kernel, and back to results."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial

import numpy as np
from numpy.typing import NDArray

from models.base import FloatArray
from models.lanes.record import of_lanes, pitched
from models.lanes.tables import empty, filled, groups, logged, put
from models.runs import Request, Run
from models.stacked.account import N_ACCOUNT, outputs
from models.stacked.declaration import REST_VELOCITY
from models.stacked.equation import products, vectors
from models.stacked.lanes import rows as r
from models.stacked.lanes.advance import advance
from models.stacked.observe import initial_state, settled_history
from models.stacked.stack import Stack

EVENTS = ("onset", "impact", "change_of_pattern", "rest", "overturned")
LARGEST_PHASE = 0.02
"""Largest growth rate times step; the error of the rule falls with its fourth power."""


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


def given_table(stack: Stack, scale: FloatArray, initial: Mapping[str, FloatArray]) -> FloatArray:
    """The constants of the lanes, a line a lane with the columns of `rows`."""
    lean = np.abs(np.arctan2(stack.offset, stack.gravity))
    own_1 = np.arctan2(stack.base_pivot - np.abs(stack.shift_1), stack.centre_1) - lean
    frame_1, frame_2 = stack.frame_inertia
    constants = (
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
        (r.P_RIGHT_1, (stack.base_pivot - stack.shift) / stack.centre),
        (r.P_LEFT_1, (stack.base_pivot + stack.shift) / stack.centre),
        (r.P_RIGHT_2, (stack.top_pivot - stack.shift_2) / stack.centre_2),
        (r.P_LEFT_2, (stack.top_pivot + stack.shift_2) / stack.centre_2),
        (r.P_FRAME_1, frame_1),
        (r.P_FRAME_2, frame_2),
        (r.P_PITCH, stack.pitch_per_acceleration * scale),
        (r.P_COULOMB, stack.coulomb),
        (r.P_Q1, initial.get("q1", 0.0)),
        (r.P_Q2, initial.get("q2", 0.0)),
        (r.P_V1, initial.get("w1", 0.0)),
        (r.P_V2, initial.get("w2", 0.0)),
    )
    return filled(stack.size, r.N_GIVEN, constants)


def run(stack: Stack, request: Request, refinement: int = 1) -> Run:
    """Run n lanes of ``stack`` as requested; ``refinement`` divides every step.

    Samples: theta_1, r (rad) and their rates (rad s-1).
    """
    found, steps = empty(request, r.N_RESULT, 4), 0
    time_step = request.shaking.time_step
    low_pass = np.where(stack.pitch_per_acceleration != 0.0, stack.pitch_low_pass, 0.0)
    general = (low_pass > 0.0) | (stack.coulomb > 0.0)
    for (per_sample, corner, more), lanes in groups(substeps(stack, time_step) * refinement, low_pass, general):
        whole = lanes.size == stack.size
        part, asked = (stack, request) if whole else (stack.take(lanes), request.take(lanes))
        make = partial(pitched, per_sample=per_sample, tail=request.tail, low_pass=corner)
        record, begins = of_lanes(asked.shakings, make)
        first, last = asked.steps(per_sample, record.end, begins)
        tables = found if whole else empty(asked, r.N_RESULT, 4)
        steps += advance(
            record, first, last, given_table(part, asked.scale, initial_state(asked.initial, part.size)), tables,
            per_sample if asked.history else 0, asked.history, True if request.linear else None,
            True if more else None,
        )  # fmt: skip
        if not whole:
            put(found, lanes, tables)
    account = found.result[:, :N_ACCOUNT]
    samples = settled_history(found.trace, account)
    if request.bare:
        return Run({}, samples, ((),) * stack.size, steps)
    return Run(outputs(stack, account), samples, logged(found, EVENTS), steps)
