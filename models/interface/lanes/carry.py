"""What no sensor measures, carried along a measured motion: W walls whose rotations are prescribed at every sample.

Each wall runs by the step rule of `step`; at every sample its prescribed states are set to the measured ones, so that
between two samples they go on by the equations of motion and never leave the measurement. What the layers remember and
how far they are compressed then is that of the measured motion.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from models.interface.effects import CELLS
from models.interface.fibres import COUNT
from models.interface.lanes.along import APART, LAST
from models.interface.lanes.effects import rows as e
from models.interface.lanes.effects.begin import follow, load_pitch, pitch_on, vacate
from models.interface.lanes.effects.step import predict, step, strips_of_fibres
from models.interface.lanes.fibres import fibres_all, sided_fibres
from models.interface.lanes.rows import GROWTH_A, GROWTH_V, N_RESULT, Q_STEPS, RA, RV, T1, V1, W
from models.interface.lanes.settle import empty, load, start, table_for
from models.interface.lanes.step import step_all
from models.lanes.arrays import Counts, Record, Table
from models.lanes.compiler import compiled
from models.rubber.lanes import N_HIDDEN


@compiled
def carry(
    record: Record, first: Counts, last: Counts, given: Table, motion: Table, along: Counts, held: Counts,
    marks: Counts, states: Table, history: Table, others: Table, mixed: Any, laws: Any, rubber: Any, more: Any,
) -> None:  # fmt: skip
    """Run n lanes from sample ``first`` (n,), each as many steps a sample as the first of them takes.

    ``motion`` (r, m, h): the states ``held`` (h,), by their place among the model's, at the samples from ``first`` on,
    of each lane in the row ``along`` (n,). ``marks`` (k,), counted from ``first``, in order and up to ``last`` (n,) of
    each lane: where ``states`` (n, k, 8) and ``history`` (n, k, joints,
    laws, fibres) are written, and ``others`` (n, k, 44) of walls with effects (`More.ended`). ``mixed``, ``laws``,
    ``rubber``, ``more``: as of `models.interface.lanes.advance.advance`.
    """
    n, per = given.shape[0], int(given[0, Q_STEPS])
    result = np.zeros((n, N_RESULT))
    w = table_for(laws, more)
    flat = w.reshape(w.size)
    for begin in range(0, n, W):
        count = min(W, n - begin)
        for slot in range(W):
            empty(w, slot)
            if more is not None:
                vacate(flat, slot)
            if slot < count:
                lane = begin + slot
                start(
                    given,
                    result,
                    w,
                    lane,
                    slot,
                    record.samples,
                    first[lane],
                    record.step,
                    False,
                    mixed,
                    laws,
                    rubber,
                    more,
                )
        mark, end = 0, 0
        for slot in range(count):
            end = max(end, last[begin + slot])
        for i in range(end + 1):
            for slot in range(count):
                row = motion[along[begin + slot], min(i, motion.shape[1] - 1)]
                turn, rate = w[T1, slot], w[V1, slot]
                for k in range(held.size):
                    w[T1 + held[k], slot] = row[k]
                if more is not None:
                    follow(flat, slot, w[T1, slot] - turn, w[V1, slot] - rate)
            while mark < marks.size and marks[mark] == i:
                for slot in range(count):
                    for k in range(states.shape[2]):
                        states[begin + slot, mark, k] = w[T1 + k, slot]
                    if more is not None:
                        for k in range(8):
                            others[begin + slot, mark, k] = flat[e.X1 + k * W + slot]
                        for k in range(4):
                            others[begin + slot, mark, 8 + k] = flat[e.CLOSINGS + k * W + slot]
                        for k in range(2 * CELLS):
                            others[begin + slot, mark, 12 + k] = flat[e.LANDED + k * W + slot]
                    if laws is not None:
                        for joint in range(2):
                            for law in range(N_HIDDEN):
                                for f in range(COUNT):
                                    at = LAST[joint] + ((law + 1) * APART + f) * W + slot
                                    history[begin + slot, mark, joint, law, f] = flat[at]
                mark += 1
            for slot in range(count):
                at_sample = min(first[begin + slot] + i, record.shaken)
                load(w, slot, record.samples, at_sample, record.shaken, float(per))
                if more is not None:
                    load_pitch(flat, more, slot, record.samples, at_sample, record.shaken, float(per))
            for _ in range(per):
                for slot in range(W):
                    w[RA, slot] += w[GROWTH_A, slot]
                    w[RV, slot] += w[GROWTH_V, slot]
                if more is None:
                    if laws is not None:
                        fibres_all(flat, rubber.base, rubber.top)
                    step_all(flat, mixed, laws)
                else:
                    pitch_on(flat, more)
                    predict(flat, more)
                    if laws is not None:
                        strips_of_fibres(flat)
                        sided_fibres(flat, rubber.base, rubber.top)
                    step(flat, more, laws)
