"""From walls and a shaking to the tables of the lane kernel, and back to results."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from models.base import STATUS, FloatArray
from models.interface import modes
from models.interface.declaration import STATES
from models.interface.lanes import rows as kept
from models.interface.lanes.run import EVENTS
from models.interface.lanes.run import outputs as of_layers
from models.interface.lanes.sense import diverged
from models.interface.layered import LayeredWall
from models.interface.observe import with_onset
from models.interface_linear import equation
from models.interface_linear.declaration import BRIEF
from models.interface_linear.lanes import rows as r
from models.interface_linear.lanes.advance import advance
from models.interface_linear.lanes.propagate import NORM
from models.lanes.record import of_lanes, recorded
from models.lanes.tables import empty, filled, logged, part
from models.runs import Request, Run

LARGEST_PHASE = 1.5
"""Largest turn (rad) within a step of any mode that oscillates: a step is exact, but watched by a cubic."""
MOST_LEVELS = 12
LANES_AT_ONCE = 256
"""Their equations take 18 kB a lane."""


def given_table(wall: LayeredWall, scale: FloatArray, initial: Mapping[str, FloatArray]) -> FloatArray:
    """The constants and the state at the start of the lanes, a line a lane; `divide` fills in the steps."""
    mass = equation.matrices(wall, (0, 0))[0]
    compression, sigma = equation.sizes(wall)
    constants = {
        r.SCALE: scale, r.OFFSET: wall.offset, r.GRAVITY: wall.gravity, r.VSCALE: wall.vertical_factor * scale,
        r.M1: wall.mass_1, r.M2: wall.mass_2, r.H1: wall.centre_1, r.H2: wall.centre_2, r.LEVER: equation.lever(wall),
        r.I11: mass[:, 0, 0], r.I12: mass[:, 0, 1], r.I22: mass[:, 1, 1],
        r.B_B: wall.base_half_width, r.B_T: wall.top_half_width, r.K_B: wall.base_stiffness, r.K_T: wall.top_stiffness,
        r.C_B: wall.base_damping, r.C_T: wall.top_damping,
        r.COMPRESSION_B: compression[:, 0], r.COMPRESSION_T: compression[:, 1],
        r.SIGMA_B: sigma[:, 0], r.SIGMA_T: sigma[:, 1],
        r.RUBBER_B: float(wall.joints != "top"), r.RUBBER_T: float(wall.joints != "base"),
    }  # fmt: skip
    table = filled(wall.size, r.N_GIVEN, constants)
    rest = equation.rest(wall)
    for k, name in enumerate(STATES):
        table[:, r.START + k] = initial.get(name, rest[:, k] if k < 4 else 0.0)
    return table


def divide(table: FloatArray, wall: LayeredWall, time_step: float, refinement: int, brief: float) -> None:
    """Steps per sample, halvings of a step down to the smallest, and the shortest excursion, lane by lane.

    Rates of full contact bound those of every configuration: half a strip is less stiff and damps less.
    """
    found = equation.at_rest(wall)
    squares = np.maximum(found.squares, 0.0)
    omega = np.sqrt(squares)
    turning = omega * np.sqrt(np.maximum(1.0 - found.damping**2, 0.0))
    rate = fastest_rate(wall)
    steps = np.maximum(np.ceil(np.nanmax(turning, axis=1) * time_step / LARGEST_PHASE - 1e-9), 1.0)
    steps = np.maximum(steps, np.ceil(rate * time_step / (NORM * 2.0**MOST_LEVELS))) * refinement
    table[:, r.STEPS] = steps
    table[:, r.LEVELS] = np.clip(np.ceil(np.log2(rate * time_step / steps / NORM)), 0, MOST_LEVELS)
    table[:, r.BRIEF] = brief / rate
    table[:, r.PERIOD] = 2.0 * np.pi / np.sqrt(np.abs(found.squares[:, 0]))


def fastest_rate(wall: LayeredWall) -> FloatArray:
    """A bound (s-1) of the rates of all configurations: the largest of M^-1 C plus the largest frequency."""
    mass, damping, _ = equation.matrices(wall, (0, 0))
    layers = modes.layer_matrix(wall, wall.base_stiffness, wall.top_stiffness)
    fastest = modes.modes(wall, mass, layers).squares[:, -1]
    return np.asarray(np.sqrt(fastest) + modes.modes(wall, mass, damping).squares[:, -1])


def systems_of(wall: LayeredWall) -> FloatArray:
    """`equation.systems` as the kernels read them, (n, 25, 10, N_ROWS)."""
    return np.ascontiguousarray(np.swapaxes(equation.systems(wall), 2, 3))


def run(wall: LayeredWall, request: Request, refinement: int = 1, brief: float = BRIEF) -> Run:
    """Run n lanes of ``wall`` as requested; ``refinement`` divides every step. Samples: q, q'.

    ``brief``: shortest excursion from the switch of a joint, times the fastest rate; shorter ones are held.
    """
    record, begins = of_lanes(request.shakings, partial(recorded, per_sample=1, tail=request.tail))
    given = given_table(wall, request.scale, request.initial)
    divide(given, wall, request.shaking.time_step, refinement, brief)
    tables = empty(request, kept.N_RESULT, 8)
    first, last = request.steps(1, record.end, begins)
    steps = 0
    for start in range(0, wall.size, LANES_AT_ONCE):
        some = slice(start, start + LANES_AT_ONCE)
        steps += advance(
            record, first[some], last[some], given[some], systems_of(wall.take(some)),
            int(given[some, r.LEVELS].max()), part(tables, some), request.history,
        )  # fmt: skip
    lost = diverged(wall, request, tables.result)
    tables.result[:, kept.R_FAILED] = np.maximum(tables.result[:, kept.R_FAILED], lost)
    return Run(outputs(wall, tables.result), tables.trace, with_onset(logged(tables, EVENTS)), steps)


def outputs(wall: LayeredWall, table: NDArray[np.float64]) -> dict[str, NDArray[Any]]:
    """The declared outputs, arrays ``(n,)``, from the table of results."""
    found = of_layers(wall, table)
    apart = (found["minimum_contact"] == 0.0) & (found["status"] != STATUS.index("not_converged"))
    return {**found, "status": np.where(apart, STATUS.index("outside_model"), found["status"]).astype(np.int8)}
