"""States of walls that no recording holds, along a measured motion: how far the layers are compressed."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial

import numpy as np

from models.base import FloatArray
from models.interface.declaration import STATES
from models.interface.layered import LayeredWall
from models.interface_linear.declaration import BRIEF
from models.interface_linear.lanes import rows as r
from models.interface_linear.lanes.carry import carry as advance
from models.interface_linear.lanes.run import LANES_AT_ONCE, divide, given_table, systems_of
from models.lanes.arrays import Tables
from models.lanes.record import of_lanes, recorded
from models.runs import Prescribed
from models.shaking import Shakings


def carry(
    wall: LayeredWall, shakings: Shakings, along: Prescribed, initial: Mapping[str, FloatArray]
) -> dict[str, FloatArray]:
    """The states that the motion does not hold, of n walls at k marks, as `models.model.Model.carry`."""
    rows, last, marks = along.rows, along.ends, along.marks
    given = given_table(wall, np.ones(wall.size), {**initial, **{name: x[rows, 0] for name, x in along.motion.items()}})
    divide(given, wall, shakings.first.time_step, 1, BRIEF)
    held, motion = along.held(STATES)
    record, begins = of_lanes(shakings, partial(recorded, per_sample=1, tail=0.0))
    states = np.empty((wall.size, marks.size, len(STATES)))
    for start in range(0, wall.size, LANES_AT_ONCE):
        some = slice(start, start + LANES_AT_ONCE)
        tables = Tables(np.zeros((0, 0)), states[some], np.zeros((0, 0, 3)), np.zeros(0, np.int64))
        advance(
            record, (along.first + begins)[some], last[some], given[some], systems_of(wall.take(some)),
            int(given[some, r.LEVELS].max()), motion, rows[some], held, marks, tables,
        )  # fmt: skip
    return {name: states[:, :, k] for k, name in enumerate(STATES) if name not in along.motion}
