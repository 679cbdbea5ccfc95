"""From walls and a shaking to the tables of the lane kernel, and back to results."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from models.base import STATUS, FloatArray
from models.interface import modes
from models.interface.declaration import STATES
from models.interface.lanes import rows as r
from models.interface.lanes.advance import advance
from models.interface.lanes.laws import given_laws, stored_in_layers
from models.interface.lanes.sense import diverged
from models.interface.layered import LayeredWall
from models.interface.observe import with_onset
from models.lanes.record import recorded
from models.lanes.tables import empty, filled, logged
from models.runs import Request, Run

EVENTS = ("uplift", "closing", "rest", "overturned")
LARGEST_PHASE = (0.1, 0.4)
"""Largest omega h of a step (rad) of the second mode of the rotations and of the slowest vertical one."""


def substeps(wall: LayeredWall, squares: FloatArray, time_step: float) -> NDArray[np.int64]:
    """Steps per sample of the record from omega^2 at rest, lane by lane: never a matter of which run together."""
    omega = np.sqrt(np.maximum(squares, 0.0))
    needed = omega[:, 1] * time_step / LARGEST_PHASE[0]
    if wall.joints == "both":
        needed = np.maximum(needed, omega[:, 2] * time_step / LARGEST_PHASE[1])
    return np.maximum(1, np.ceil(needed - 1e-9)).astype(np.int64)


def given_table(
    wall: LayeredWall, scale: FloatArray, initial: Mapping[str, FloatArray], rest: FloatArray
) -> FloatArray:
    """The constants and the state at the start of the lanes, a line a lane; ``rest`` (n, 4) is the static one."""
    toe = 1.0 if wall.toe_held else 0.0
    clip = 1.0 if wall.clip else 0.0
    free_b, free_t = float(wall.joints != "top"), float(wall.joints != "base")
    late_b = np.divide(wall.base_damping, wall.base_stiffness, out=np.zeros(wall.size), where=wall.base_stiffness > 0.0)
    late_t = np.divide(wall.top_damping, wall.top_stiffness, out=np.zeros(wall.size), where=wall.top_stiffness > 0.0)
    constants = {
        r.SCALE: scale, r.OFFSET: wall.offset, r.GRAVITY: wall.gravity, r.VSCALE: wall.vertical_factor * scale,
        r.M1: wall.mass_1, r.H1: wall.centre_1, r.I1: wall.inertia_1, r.M2: wall.mass_2, r.H2: wall.centre_2,
        r.I2: wall.inertia_2, r.HEIGHT: wall.height_1 + wall.top_thickness_in_height, r.B1: wall.base_half_width,
        r.BT: wall.top_half_width, r.TOE_1: toe * wall.base_half_width, r.TOE_T: toe * wall.top_half_width,
        r.KB: wall.base_stiffness, r.KT: wall.top_stiffness, r.CB: wall.base_damping, r.CT: wall.top_damping,
        r.LATE_B: clip * late_b, r.LATE_T: clip * late_t, r.CLIP: clip, r.FREE_B: free_b, r.FREE_T: free_t,
    }  # fmt: skip
    table = filled(wall.size, r.N_GIVEN, {row - r.SCALE: values for row, values in constants.items()})
    for k, name in enumerate(STATES):
        table[:, r.Q_STATE + k] = initial.get(name, rest[:, k] if k < 4 else 0.0)
    return table


def run(wall: LayeredWall, request: Request, refinement: int = 1) -> Run:
    """Run n lanes of ``wall`` as requested; ``refinement`` divides every step. Samples: q, q'."""
    shaking = request.shaking
    record = recorded(shaking, 1, request.tail)
    rest = modes.static_state(wall)
    squares = modes.at_rest(wall, rest).squares
    given = given_table(wall, request.scale, request.initial, rest)
    given[:, r.Q_PERIOD] = 2.0 * np.pi / np.sqrt(np.abs(squares[:, 0]))
    given[:, r.Q_STEPS] = substeps(wall, squares, shaking.time_step) * refinement
    laws = given_laws(wall, rest, shaking.time_step / given[:, r.Q_STEPS], request.initial)
    tables = empty(request, r.N_RESULT, 8)
    steps = advance(
        record, *request.steps(1, record.end), given, tables, request.history,
        None if wall.joints == "both" else True, None if laws is None else True, laws,
    )  # fmt: skip
    before = stored_in_layers(wall, given[:, r.Q_STATE : r.Q_STATE + 4], None if laws is None else laws.hidden)
    result = tables.result
    with np.errstate(invalid="ignore", over="ignore"):
        after = stored_in_layers(wall, result[:, r.R_END_1 : r.R_END_Z2 + 1], None if laws is None else laws.ended)
        result[:, r.R_LOST_B : r.R_LOST_T + 1] += before - after
    lost = diverged(wall, request, result)
    result[:, r.R_FAILED] = np.maximum(result[:, r.R_FAILED], lost)
    return Run(outputs(wall, result), tables.trace, with_onset(logged(tables, EVENTS)), steps)


def outputs(wall: LayeredWall, table: NDArray[np.float64]) -> dict[str, NDArray[Any]]:
    """The declared outputs, arrays ``(n,)``, from the table of results."""
    half = np.pi / 2.0
    rubber = np.array([wall.joints != "top", wall.joints != "base"])
    over_at = table[:, [r.R_OVER_1, r.R_OVER_2]]
    over: NDArray[np.bool_] = ~np.isnan(over_at)
    peak = np.where(over, half, table[:, [r.R_PEAK_1, r.R_PEAK_2]])
    end = table[:, [r.R_END_1, r.R_END_2]]
    end = np.where(over, np.copysign(half, end), end)
    ratio = peak / np.stack([wall.slenderness, wall.slenderness_2], axis=1)
    up = np.where(rubber, table[:, [r.R_UP_B, r.R_UP_T]], 0.0)
    onset = table[:, [r.R_ONSET_B, r.R_ONSET_T]]
    onset = np.where(rubber & (onset < 1e200), onset, np.nan)
    share = np.where(rubber, table[:, [r.R_SHARE_B, r.R_SHARE_T]], 1.0)
    closed = np.where(rubber, table[:, [r.R_CLOSED_B, r.R_CLOSED_T]], 0.0).astype(np.int32)
    lost = np.where(rubber, table[:, [r.R_LOST_B, r.R_LOST_T]], 0.0)
    friction = table[:, [r.R_FRICTION_B, r.R_FRICTION_T]]
    friction = np.where(rubber, np.where(friction > 1e200, np.inf, friction), np.nan)
    thickness = np.stack([wall.base_thickness, wall.top_thickness], axis=1)
    strain = np.divide(table[:, [r.R_EDGE_B, r.R_EDGE_T]], thickness, out=np.full(share.shape, np.nan), where=rubber)
    failed = table[:, r.R_FAILED] != 0.0
    status = np.where(np.isnan(onset).all(axis=1), STATUS.index("rest"), STATUS.index("rocking"))
    status = np.where(over.any(axis=1), STATUS.index("overturned"), status)
    larger = np.where(np.abs(end[:, 0]) >= np.abs(end[:, 1]), end[:, 0], end[:, 1])
    return {
        **_both("peak_rotation", "12", peak, peak.max(axis=1)),
        **_both("peak_rotation_ratio", "12", ratio, ratio.max(axis=1)),
        **_both("uplift_duration", "bt", up, up.max(axis=1)),
        **_both("onset_time", "bt", onset, np.fmin(onset[:, 0], onset[:, 1])),
        **_both("minimum_contact", "bt", share, share.min(axis=1)),
        **_both("overturned", "12", over, np.asarray(over.any(axis=1))),
        **_both("overturning_time", "12", over_at, np.fmin(over_at[:, 0], over_at[:, 1])),
        **_both("impacts", "bt", closed, closed.max(axis=1)),
        **_both("residual_rotation", "12", end, larger),
        **_both("dissipated_energy", "bt", lost, lost.sum(axis=1)),
        **_both("peak_strain", "bt", strain, np.fmax(strain[:, 0], strain[:, 1])),
        **_both("friction_demand", "bt", friction, np.fmax(friction[:, 0], friction[:, 1])),
        "status": np.where(failed, STATUS.index("not_converged"), status).astype(np.int8),
    }


def _both(name: str, ends: str, pair: NDArray[Any], plain: NDArray[Any]) -> dict[str, NDArray[Any]]:
    first, second = ("_1", "_2") if ends == "12" else ("_base", "_top")
    return {name: plain, f"{name}{first}": pair[:, 0], f"{name}{second}": pair[:, 1]}
