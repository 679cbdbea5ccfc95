"""From blocks and a shaking to the tables of the lane kernel, and back to results."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from models.base import FloatArray
from models.housner.block import REACHES, Block
from models.housner.declaration import REST_VELOCITY
from models.housner.lanes import rows as r
from models.housner.lanes.advance import advance
from models.housner.lanes.table import KNOTS
from models.lanes.arrays import Record
from models.lanes.record import of_lanes, pitched
from models.lanes.tables import empty, filled, groups, logged, put
from models.oscillator import felt
from models.runs import Request, Run
from models.shaking import Shaking

EVENTS = ("onset", "impact", "rest", "overturned")
LARGEST_PHASE = 0.0075
"""Largest p h of a step (rad); the error of the rule falls with its fourth power."""
JOINT_PHASE = 0.2
MODAL_PHASE = 0.15
"""Largest phase (rad) of a bending wall's mode in a step, at its frequency while the wall rocks."""

BENDING = 5
"""Steps as which a budget of work counts one of a bending wall: .4 us, and fits with it that take more iterations."""


def substeps(block: Block, time_step: float) -> NDArray[np.int64]:
    """Steps per sample of the record, lane by lane: never a matter of which lanes run together."""
    p = block.frequency_parameter
    phase = p * time_step / LARGEST_PHASE
    if np.any(flexible := block.joint_angle > 0.0):
        slope = block.slenderness / np.where(flexible, np.maximum(block.joint_angle, 1e-12), np.inf)
        phase = np.maximum(phase, p * np.sqrt(slope) * time_step / JOINT_PHASE)
    if np.any(bends := np.isfinite(block.first_frequency)):
        rigid = 1.0 - block.modal_moment**2 / (block.modal_mass * block.pivot_inertia)
        mode = np.where(bends, 2.0 * np.pi * block.first_frequency, 0.0) / np.sqrt(rigid)
        phase = np.maximum(phase, mode * time_step / MODAL_PHASE)
    return np.maximum(1, np.ceil(phase - 1e-9)).astype(np.int64)


def given_table(block: Block, scale: FloatArray, initial: Mapping[str, FloatArray]) -> FloatArray:
    """The constants of the lanes, a line a lane with the columns of `rows`."""
    p, alpha = block.frequency_parameter, block.slenderness
    with np.errstate(divide="ignore"):
        joint = np.where(block.joint_angle > 0.0, 1.0 / block.joint_angle, -1.0)
    constants = (
        (r.Q_SCALE, scale),
        (r.Q_OFFSET, block.offset),
        (r.Q_GRAVITY, block.gravity),
        (r.Q_VSCALE, block.vertical_factor * scale),
        (r.Q_MASS, block.mass),
        (r.Q_HEIGHT, block.height),
        (r.Q_RIGHT, block.right),
        (r.Q_LEFT, block.left),
        (r.Q_INERTIA, block.inertia),
        (r.Q_RESTITUTION, block.restitution),
        (r.Q_FACTOR, block.restitution_factor),
        (r.Q_ASPECT, block.aspect_coefficient * block.aspect**2),
        (r.Q_EXPONENT, block.amplitude_exponent),
        (r.Q_SLOPE, block.velocity_slope),
        (r.Q_LOSS, block.loss_per_impact),
        (r.Q_FLOOR, block.restitution_floor),
        (r.Q_REST, REST_VELOCITY * p * alpha),
        (r.Q_ALPHA, alpha),
        (r.Q_P, p),
        (r.Q_RHO, block.corner_radius),
        (r.Q_CRUSH, block.crushing_rate),
        (r.Q_JOINT, joint),
        (r.Q_K, block.stiffness),
        (r.Q_GAP, block.gap),
        (r.Q_VISCOUS, block.viscous),
        (r.Q_COULOMB, block.coulomb),
        (r.Q_QUADRATIC, block.quadratic),
        (r.Q_PITCH, block.pitch_per_acceleration),
        (r.Q_BOUNCE, block.contact_restitution),
        (r.Q_FRICTION, block.friction),
        (r.Q_FREQUENCY, 2.0 * np.pi * block.first_frequency),
        (r.Q_MODAL_MASS, block.modal_mass / block.mass),
        (r.Q_MODAL_FORCE, block.modal_force / block.mass),
        (r.Q_MODAL_MOMENT, block.modal_moment / block.mass),
        (r.Q_THETA, initial.get("rotation_1", 0.0)),
        (r.Q_OMEGA, initial.get("rotation_rate_1", 0.0)),
        (r.Q_PEAK, initial.get("peak_rotation_1", 0.0)),
        (r.Q_SWING, initial.get("swing_peak_1", 0.0)),
        (r.Q_IMPACTS, initial.get("impacts", 0.0)),
    )
    found = filled(block.size, r.N_GIVEN, constants)
    if not np.any(block.tabulated):
        return found
    spacings = (KNOTS - 1) / block.table[:, :REACHES]
    return np.concatenate([found, spacings, block.table[:, REACHES:]], axis=1)


def run(block: Block, request: Request, refinement: int = 1) -> Run:
    """Run n lanes of ``block`` as requested; ``refinement`` divides every step.

    Samples: theta (rad), theta' (rad s-1) and what the mass centre's displacement has beyond that of rocking on
    fixed corners (m). ``initial`` may hold ``peak_rotation_1`` (rad), ``swing_peak_1`` (rad, since the last impact)
    and ``impacts`` before the run, too.
    """
    found, steps = empty(request, r.N_RESULT, 3), 0
    low_pass = np.where(block.pitch_per_acceleration != 0.0, block.pitch_low_pass, 0.0)
    gains = block.oscillator_motion, block.oscillator_force
    drives = (gains[0] != 0.0) | (gains[1] != 0.0)
    driven = [np.where(drives, x, 0.0) for x in (*gains, block.oscillator_frequency, block.oscillator_damping)]
    steps_of = substeps(block, request.shaking.time_step) * refinement
    for (per_sample, corner, *oscillator), lanes in groups(steps_of, low_pass, *driven):
        whole = lanes.size == block.size
        part, asked = (block, request) if whole else (block.take(lanes), request.take(lanes))
        record, begins = of_lanes(asked.shakings, partial(_record, oscillator, per_sample, request.tail, corner))
        first, last = asked.steps(per_sample, record.end, begins)
        tables = found if whole else empty(asked, r.N_RESULT, 3)
        general = None if part.plain else 1 if np.any(part.tabulated) else True
        work = BENDING if np.any(np.isfinite(part.first_frequency)) else 1
        steps += work * advance(
            record, first, last, given_table(part, asked.scale, asked.initial), tables,
            per_sample if asked.history else 0, asked.history, general,
            True if request.linear else None,
        )  # fmt: skip
        if not whole:
            put(found, lanes, tables)
    return Run(outputs(block, found.result), found.trace, logged(found, EVENTS), steps)


def _record(oscillator: Sequence[float], per_sample: int, tail: float, corner: float, shaking: Shaking) -> Record:
    """The shaking as it is felt through an oscillator, and the pitch of the base below ``corner`` Hz."""
    return pitched(felt(shaking, *oscillator), per_sample, tail, corner)


def outputs(block: Block, result: NDArray[np.float64]) -> dict[str, NDArray[Any]]:
    """The declared outputs from the table of results, and ``swing_peak``: for a run that goes on from there."""
    status = result[:, r.R_STATUS].astype(np.int8)
    return {
        "peak_rotation": result[:, r.R_PEAK],
        "peak_rotation_ratio": result[:, r.R_PEAK] / block.slenderness,
        "uplift_duration": result[:, r.R_UPLIFT],
        "onset_time": result[:, r.R_ONSET],
        "overturned": status == r.OVERTURNED,
        "overturning_time": result[:, r.R_OVERTURNED_AT],
        "impacts": result[:, r.R_IMPACTS].astype(np.int32),
        "residual_rotation": result[:, r.R_ROTATION],
        "dissipated_energy": result[:, r.R_DISSIPATED],
        "friction_demand": np.where(result[:, r.R_DEMAND] > 1e299, np.inf, result[:, r.R_DEMAND]),
        "status": status,
        "swing_peak": result[:, r.R_SWING],
    }
