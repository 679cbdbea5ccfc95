"""From chains and a shaking to the tables of the lane kernel, and back to results."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from models.base import Event, FloatArray
from models.isolated import bearing
from models.isolated.account import energy, status
from models.isolated.chain import Chain
from models.isolated.declaration import MOST_LEVELS, STATES
from models.isolated.lanes import rows as r
from models.isolated.lanes.advance import advance
from models.isolated.lanes.tables import Given, Records
from models.isolated.modes import exact_step, modes
from models.lanes.sense import CREATED, impulse
from models.lanes.tables import groups
from models.rubber import lanes as rubber
from models.runs import Request, Run
from models.shaking import Shaking

LARGEST_PHASE = (0.1, 0.4)
"""Largest omega h of a step (rad): of the first mode, for the laws; of the second, to find the peaks."""
MOST_STEPS = 8
"""Steps a sample at most: modes far above what the record can hold follow it without a motion of their own."""


def substeps(omega: FloatArray, time_step: float) -> NDArray[np.int64]:
    """Steps per sample of the record from the frequencies (n, levels), lane by lane."""
    second = omega[:, min(1, omega.shape[1] - 1)]
    needed = np.minimum(second * time_step / LARGEST_PHASE[1], MOST_STEPS)
    needed = np.maximum(needed, omega[:, 0] * time_step / LARGEST_PHASE[0])
    return np.asarray(np.maximum(1, np.ceil(needed - 1e-9)), np.int64)


def law_numbers(chain: Chain) -> FloatArray:
    """The numbers (n, rows) of Payne's law and of wear; zero where they are absent."""
    table = np.zeros((chain.size, r.N_LAW))
    table[:, r.K] = chain.stiffness
    if p := chain.numbers("payne"):
        table[:, r.P_PAYNE], table[:, r.P_PER_AMPLITUDE] = p["softening"], 1.0 / (p["strain"] * p["thickness"])
    if p := chain.numbers("degradation"):
        table[:, r.P_LOSS], table[:, r.P_PER_CROSSING] = p["final_loss"], 1.0 / p["cycles"]
    return table


def memory_table(chain: Chain, u: FloatArray, rate: FloatArray, memory: bearing.Memory) -> FloatArray:
    """The bearings' rows (n, rows) at u, u'; the rubber's hidden states have a table of their own."""
    worn = bearing.wear(chain, memory.crossings)
    return np.stack([u, rate, memory.amplitude, memory.crossings, worn], axis=1)


def run(chain: Chain, request: Request, refinement: int = 1) -> Run:
    """Run n lanes of ``chain`` as requested; ``refinement`` divides every step.

    Lanes of one length and step run together; none depends on the others. A sample holds x, then x', of the most
    levels (0 where there is none), and the bearings' force.
    """
    if len(request.shakings.each) > 1:
        raise ValueError("chains on bearings run under one motion")
    n, shaking = chain.size, request.shaking
    displaced, moving = (request.initial.get(name, np.zeros(n)) for name in STATES)
    quiet = int(np.ceil(request.tail / shaking.time_step - 1e-9))
    first, last = request.steps(1, shaking.horizontal.size - 1 + quiet, np.zeros(n, np.int64))
    found: dict[str, FloatArray] = {}
    trace, steps = np.zeros((n, request.samples, 2 * MOST_LEVELS + 1)), 0
    for (levels,), of_length in groups(chain.levels):
        omega = modes(chain.take(of_length), levels)[0]
        for (per,), members in groups(substeps(omega, shaking.time_step) * refinement):
            lanes = of_length[members]
            period = np.asarray(2.0 * np.pi / omega[members, 0] / shaking.time_step, np.int64)
            group = _Group(chain.take(lanes), levels, shaking, per, displaced[lanes], moving[lanes], request.samples)
            ended = group.run(request.take(lanes), first[lanes], last[lanes], period)
            steps += group.steps
            for name, values in ended.items():
                found.setdefault(name, np.zeros(n))[lanes] = values
            size = group.size
            trace[lanes, :, :levels] = group.trace[:, :, :levels]
            trace[lanes, :, MOST_LEVELS : MOST_LEVELS + levels] = group.trace[:, :, size : size + levels]
            trace[lanes, :, -1] = group.trace[:, :, -1]
    rested = found.pop("rest_time").tolist()
    return Run(found, trace, tuple((Event(time, "rest"),) if time == time else () for time in rested), steps)


class _Group:
    """Lanes of one length and step: their tables and one call of the kernel."""

    def __init__(
        self, chain: Chain, levels: int, shaking: Shaking, per: int, u: FloatArray, rate: FloatArray, samples: int
    ) -> None:
        self.chain, self.levels, self.shaking, self.per = chain, levels, shaking, per
        self.size = next(size for size in r.SIZES if size >= levels)
        self.h = np.full(chain.size, shaking.time_step / per)
        self.steps = 0
        self.trace = np.zeros((chain.size, samples, 2 * self.size + 1))
        self.y = np.repeat(np.stack([u, rate], axis=1), levels, axis=1)
        self.memory = bearing.relaxed(chain, u)
        self.force = bearing.spring_force(chain, u, self.memory) - chain.stiffness * u

    def padded(self, table: FloatArray, *axes: int) -> FloatArray:
        """``table`` with x and x' of ``levels`` spread over the padded size along ``axes``."""
        rows = np.concatenate([np.arange(self.levels), self.size + np.arange(self.levels)])
        for axis in axes:
            shape = list(table.shape)
            shape[axis] = 2 * self.size
            wide = np.zeros(shape)
            np.moveaxis(wide, axis, 0)[rows] = np.moveaxis(table, axis, 0)
            table = wide
        return table

    def _links(self) -> tuple[FloatArray, FloatArray]:
        """Spring, dashpot and mark of every level's lower link (n, 3, size); masses and inverses (n, 2, size)."""
        chain, levels = self.chain, self.levels
        links, masses = np.zeros((chain.size, 3, self.size)), np.zeros((chain.size, 2, self.size))
        links[:, 0, 1:levels], links[:, 1, 1:levels] = chain.storey_stiffness[:, None], chain.storey_damping[:, None]
        links[:, 0, 0], links[:, 1, 0], links[:, 2, 1:levels] = chain.stiffness, chain.damping, 1.0
        masses[:, 0, :levels] = chain.masses[:, :levels]
        masses[:, 1, :levels] = 1.0 / chain.masses[:, :levels]
        return links, masses

    def run(
        self, request: Request, first: NDArray[np.int64], last: NDArray[np.int64], period: NDArray[np.int64]
    ) -> dict[str, FloatArray]:  # fmt: skip
        """Results by name (n,)."""
        chain, levels = self.chain, self.levels
        u, rate = self.y[:, 0], self.y[:, levels]
        links, masses = self._links()
        scalars = np.zeros((chain.size, r.N_SCALAR))
        scalars[:, r.SCALE], scalars[:, r.STEP], scalars[:, r.FORCE] = request.scale, self.h, self.force
        # all levels start alike: only the slab is accelerated
        start = chain.stiffness * u + chain.damping * rate + self.force
        scalars[:, r.PEAK_U], scalars[:, r.PEAK_ACCELERATION] = np.abs(u), np.abs(start / chain.masses[:, 0])
        scalars[:, r.KINETIC] = chain.mass * rate**2
        transition, gains = exact_step(chain, levels, self.h)
        rows = 2 * self.size
        n, laws = chain.size, chain.rubber_laws
        given = Given(
            scalars, memory_table(chain, u, rate, self.memory), law_numbers(chain),
            rubber.hidden_table(laws, self.memory.hidden) if laws else np.zeros((n, rubber.N_HIDDEN)),
            rubber.number_table(laws, self.h), self.padded(self.y, 1), self.padded(transition, 1, 2),
            self.padded(gains, 1), links, masses,
        )  # fmt: skip
        records = Records(
            np.zeros((n, r.N_RESULT)), np.zeros((n, rows)), np.zeros((n, r.N_MEMORY)), np.zeros((n, rubber.N_HIDDEN)),
            self.trace,
        )  # fmt: skip
        self.steps = advance(
            self.shaking.horizontal, self.shaking.time_step, self.shaking.horizontal.size - 1, self.per, first, last,
            period, given, records, not request.history, (None,) * self.size,
            rubber.acting(laws) if chain.laws else None,
        )  # fmt: skip
        at_end, result = records.states, records.result
        at_end = np.concatenate([at_end[:, :levels], at_end[:, self.size : self.size + levels]], axis=1)
        hidden = rubber.hidden_states(laws, records.hidden)
        memory = bearing.Memory(hidden, records.memory[:, r.AMPLITUDE], records.memory[:, r.CROSSINGS])
        before, work = energy(chain, levels, self.y, self.memory), result[:, r.R_WORK]
        with np.errstate(invalid="ignore", over="ignore"):
            after = energy(chain, levels, at_end, memory)
            lost = before + work - after
            # the energy of a passive body grows at most as the shaking's impulse lets its velocity
            reach = (np.sqrt(before) + np.sqrt(0.5 * chain.mass) * impulse(request)) ** 2
            failed = ~((after <= (1.0 + CREATED) * reach) & (lost >= -CREATED * reach) & (result[:, r.R_FAILED] == 0.0))
        return {
            "peak_bearing_displacement": result[:, r.R_PEAK_U],
            "peak_level_acceleration": result[:, r.R_PEAK_ACCELERATION],
            "peak_drift": result[:, r.R_PEAK_DRIFT],
            "residual_displacement": at_end[:, 0],
            "dissipated_energy": lost,
            "status": status(failed, result[:, r.R_PEAK_U] > 0.0),
            "rest_time": result[:, r.R_REST],
        }
