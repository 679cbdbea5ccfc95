"""What no sensor measures, carried along a measured motion: walls whose rotations are prescribed at every sample.

Between two samples a wall moves by its equations, from the measured rotations and rates, its joints in full or half
contact as the state has them there: as a window of a comparison starts.
"""

from __future__ import annotations

import math

from models.interface_linear.equation import STATES
from models.interface_linear.lanes import rows as r
from models.interface_linear.lanes.advance import GOES_ON, begin, cross, drive, enter, first_state, fresh
from models.interface_linear.lanes.propagate import read
from models.lanes.arrays import Counts, Record, Table, Tables
from models.lanes.compiler import compiled


@compiled
def carry(
    record: Record, first: Counts, last: Counts, given: Table, systems: Table, most_levels: int, motion: Table,
    along: Counts, held: Counts, marks: Counts, tables: Tables,
) -> None:  # fmt: skip
    """Run n lanes from sample ``first`` (n,) to ``last`` (n,), counted from there.

    ``motion`` (r, m, h): the states ``held`` (h,), by their place among the model's, at the samples from ``first`` on,
    of each lane in the row ``along`` (n,). ``marks`` (k,), counted from ``first`` and in order: where the trace
    (n, k, 8) takes q and q'; nan from where a wall is lost. ``systems``: as of `advance.advance`.
    """
    samples, time_step, shaken = record.samples, record.step, record.shaken
    work, trace = fresh(most_levels), tables.trace
    place, x = work.place, work.x
    for lane in range(given.shape[0]):
        system = systems[lane]
        per, levels = int(given[lane, r.STEPS]), int(given[lane, r.LEVELS])
        length = time_step / per
        begin(given, lane, work)
        place[1], place[3] = levels, 0
        trace[lane] = math.nan
        mark = 0
        for i in range(last[lane] + 1):
            for k in range(held.size):
                x[held[k]] = motion[along[lane], min(i, motion.shape[1] - 1), k]
            while mark < marks.size and marks[mark] == i:
                for k in range(8):
                    trace[lane, mark, k] = x[k]
                mark += 1
            place[0] = STATES * first_state(given, lane, 0, x) + first_state(given, lane, 1, x)
            place[2] = 0
            enter(system, work, place[0], levels, length / (1 << levels))
            drive(given, lane, samples, time_step, shaken, first[lane] + i, x)
            read(system, place[0], x, work.before)
            how, _ = cross(given, lane, system, work, tables, 0.0, per, length, levels)
            if how != GOES_ON:
                break
