"""From walls and a shaking to the tables of the lane kernel, and back to results."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from models.base import STATUS, FloatArray
from models.interface import modes, resting
from models.interface.declaration import STATES
from models.interface.lanes import rows as r
from models.interface.lanes.advance import advance
from models.interface.lanes.effects.given import energy, given_effects
from models.interface.lanes.effects.rows import G_STATE, N_ENDED, More
from models.interface.lanes.fibres import Rubber
from models.interface.lanes.laws import given_laws, stored_in_layers
from models.interface.lanes.sense import SAME_TIME, agree, diverged, pressed
from models.interface.layered import LayeredWall
from models.interface.observe import with_onset
from models.lanes.arrays import Record, Tables
from models.lanes.record import of_lanes, recorded
from models.lanes.tables import empty, filled, groups, logged, put
from models.pitch import pitch
from models.runs import Request, Run
from models.shaking import Shaking

EVENTS = ("uplift", "closing", "rest", "overturned")
LARGEST_PHASE = (0.1, 0.4)
"""Largest omega h of a step (rad) of the second mode of the rotations and of the slowest vertical one."""
FINER, FINEST = 4, 16
"""Steps of lanes that are taken again: how much finer than before, and how much finer than the first at most."""

PLAIN, WITH_MORE, WITH_BOTH = 8.5e-8, 3.2e-7, 7e-7
"""s of a lane-step, of one with laws or effects, and of one with both: with what a fit then does with its samples."""


def step_time(wall: LayeredWall) -> float:
    """What a lane-step takes a typical core (s)."""
    more = bool(wall.laws), wall.effects is not None
    return WITH_BOTH if all(more) else WITH_MORE if any(more) else PLAIN


def substeps(wall: LayeredWall, squares: FloatArray, time_step: float, step: float | None = None) -> NDArray[np.int64]:
    """Steps per sample of the record from omega^2 at rest, lane by lane: never a matter of which run together.

    Of ``step`` (s) where it is given.
    """
    if step is not None:
        return np.full(wall.size, max(1, round(time_step / step)))
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
    """Run n lanes of ``wall`` as requested; ``refinement`` divides every step. Samples: q, q'.

    Of walls with effects q, q' of the plain coordinates, then those of the others. Lanes whose rubber was pressed
    beyond its limit are taken again in finer steps, until it is not or the last two runs agree; those of which not
    even the finest steps tell are not converged.
    """
    found, steps = _tables(wall, request, refinement)
    again, finer = np.flatnonzero(pressed(wall, found.result)), 1
    while again.size and finer < FINEST:
        finer *= FINER
        some, coarse = wall.take(again), found.result[again]
        taken, more = _tables(some, request.take(again), finer * refinement)
        put(found, again, taken)
        steps += more
        # when a wall falls is as sensitive as any peak: the finest steps need not tell
        within = SAME_TIME if finer < FINEST else np.inf
        again = again[pressed(some, taken.result) & ~agree(some, coarse, taken.result, within)]
    if request.bare:
        return Run({}, found.trace, ((),) * wall.size, steps)
    result = found.result
    result[diverged(wall, request, result), r.R_FAILED] = 1.0
    result[again, r.R_FAILED] = 1.0
    return Run(outputs(wall, result), found.trace, with_onset(logged(found, EVENTS)), steps)


def _tables(wall: LayeredWall, request: Request, refinement: int) -> tuple[Tables, int]:
    """Tables of all lanes, those of one low pass of the base's pitch together, and the lane-steps."""
    columns = 8 if wall.effects is None else 16
    found, steps = empty(request, r.N_RESULT, columns), 0
    for (corner,), lanes in groups(low_passes(wall)):
        if lanes.size == wall.size:
            return found, _advanced(wall, request, refinement, corner, found)
        part, asked = wall.take(lanes), request.take(lanes)
        tables = empty(asked, r.N_RESULT, columns)
        steps += _advanced(part, asked, refinement, corner, tables)
        put(found, lanes, tables)
    return found, steps


def low_passes(wall: LayeredWall) -> FloatArray:
    """Hz, (n,), of bases that pitch; 0 of others."""
    e = wall.effects
    return np.zeros(wall.size) if e is None else np.where(e.pitch != 0.0, e.pitch_low_pass, 0.0)


def pitching(wall: LayeredWall, shaking: Shaking, low_pass: float) -> Sequence[FloatArray | None]:
    """Channels of the record beyond a and a_z: psi and psi'' below ``low_pass`` (Hz; 0: none) for a pitch of 1."""
    if wall.effects is None or "table_pitch" not in wall.effects.parts:
        return ()
    return pitch(shaking, low_pass) if low_pass > 0.0 else (None, None)


def record_of(wall: LayeredWall, low_pass: float, tail: float, shaking: Shaking) -> Record:
    """The shaking at its samples, then ``tail`` s of rest, with what a base that pitches needs."""
    return recorded(shaking, 1, tail, pitching(wall, shaking, low_pass))


def _advanced(wall: LayeredWall, request: Request, refinement: int, low_pass: float, tables: Tables) -> int:
    """Fill ``tables`` for lanes whose base pitches below ``low_pass`` (Hz; 0: not at all); returns the lane-steps."""
    time_step, effects = request.shaking.time_step, wall.effects
    record, begins = of_lanes(request.shakings, partial(record_of, wall, low_pass, request.tail))
    at_rest = resting.at_rest(wall)
    rest = at_rest[:, :4]
    squares = modes.at_rest(wall).squares
    given = given_table(wall, request.scale, request.initial, rest)
    given[:, r.Q_PERIOD] = 2.0 * np.pi / np.sqrt(np.abs(squares[:, 0]))
    given[:, r.Q_STEPS] = substeps(wall, squares, time_step, request.step) * refinement
    laws = given_laws(wall, at_rest, time_step / given[:, r.Q_STEPS], request.initial)
    more = None if effects is None else given_effects(wall, effects, request.initial, at_rest)
    steps = advance(
        record, *request.steps(1, record.end, begins), given, tables, request.history,
        None if wall.joints == "both" or more is not None else True, None if laws is None else True, laws, more,
    )  # fmt: skip
    if not request.bare:
        _account(wall, given, laws, more, tables.result)
    return int(steps)


def _account(wall: LayeredWall, given: FloatArray, laws: Rubber | None, more: More | None, result: FloatArray) -> None:
    """What the joints stored and gave back in a run is no part of what they lost: taken off in ``result``."""
    first = given[:, r.Q_STATE : r.Q_STATE + 4]
    hidden = (None, None) if laws is None else (laws.hidden, laws.ended)
    with np.errstate(invalid="ignore", over="ignore"):
        last = result[:, r.R_END_1 : r.R_END_Z2 + 1]
        if more is None:
            change = stored_in_layers(wall, first, hidden[0]) - stored_in_layers(wall, last, hidden[1])
        else:
            began = more.given[:, G_STATE : G_STATE + N_ENDED]
            change = energy(wall, first, began, hidden[0]) - energy(wall, last, more.ended, hidden[1])
        result[:, r.R_LOST_B : r.R_LOST_T + 1] += change


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
