"""States of walls that no recording holds, along a measured motion: compression of the layers, and their past."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial

import numpy as np
from numpy.typing import NDArray

from models.base import FloatArray
from models.interface import modes, resting
from models.interface.declaration import STATES
from models.interface.effects import BENDS, LANDED, MEMORIES
from models.interface.effects import STATES as OTHER_STATES
from models.interface.lanes import rows as r
from models.interface.lanes.carry import carry as advance
from models.interface.lanes.effects.given import given_effects
from models.interface.lanes.effects.rows import N_ENDED
from models.interface.lanes.laws import HISTORY, given_laws, some
from models.interface.lanes.run import given_table, low_passes, record_of, step_time, substeps
from models.interface.layered import LayeredWall
from models.lanes.record import of_lanes
from models.lanes.tables import groups
from models.runs import DONE, Prescribed
from models.shaking import Shakings


def carry(
    wall: LayeredWall, shakings: Shakings, along: Prescribed, initial: Mapping[str, FloatArray],
    step: float | None = None,
) -> dict[str, FloatArray]:  # fmt: skip
    """The states that the motion does not hold, and the history of the layers, of n walls at k marks.

    As `models.model.Model.carry`, in steps of ``step`` (s; None: by the rule of the walls).
    """
    at_rest, effects, time_step = resting.at_rest(wall), wall.effects, shakings.first.time_step
    motion, marks, rows, last = along.motion, along.marks, along.rows, along.ends
    rest = at_rest[:, :4]
    begun = {**initial, **{name: x[rows, 0] for name, x in motion.items()}}
    given = given_table(wall, np.ones(wall.size), begun, rest)
    steps = substeps(wall, modes.at_rest(wall).squares, time_step, step)
    given[:, r.Q_STEPS] = steps
    DONE.call(0, float(np.sum(last * steps)) * step_time(wall))
    laws = given_laws(wall, at_rest, time_step / steps, initial)
    held, prescribed = along.held(STATES)
    states = np.zeros((wall.size, marks.size, len(STATES)))
    others = np.zeros((wall.size, marks.size, N_ENDED))
    history = np.zeros((wall.size, marks.size, *(() if laws is None else laws.hidden.shape[1:])))
    for (_, corner), lanes in groups(steps, low_passes(wall)):
        part = wall if lanes.size == wall.size else wall.take(lanes)
        moved, past, more_moved = (np.zeros((lanes.size, *whole.shape[1:])) for whole in (states, history, others))
        more = None if effects is None else given_effects(part, part.effects, _of(begun, lanes), at_rest[lanes])
        record, begins = of_lanes(shakings.take(lanes), partial(record_of, wall, corner, 0.0))
        advance(
            record, along.first[lanes] + begins, last[lanes], given[lanes],
            prescribed, rows[lanes], held, marks,
            moved, past, more_moved,
            None if wall.joints == "both" or more is not None else True, None if laws is None else True,
            None if laws is None else some(laws, lanes), more,
        )  # fmt: skip
        states[lanes], history[lanes], others[lanes] = moved, past, more_moved
    found = {name: states[:, :, k] for k, name in enumerate(STATES) if name not in motion}
    if effects is not None:
        landed = LANDED if "interface_shear" in effects.parts else ()
        found |= {name: others[:, :, k] for k, name in enumerate((*OTHER_STATES, *MEMORIES, *landed))}
        found |= {name: found[name] - states[:, :, STATES.index(lower)] for name, lower in BENDS.items()}
    return found if laws is None else {**found, HISTORY: history}


def _of(initial: Mapping[str, FloatArray], lanes: NDArray[np.intp]) -> dict[str, FloatArray]:
    """The initial states of some lanes."""
    return {name: x[lanes] if x.shape[0] > 1 else x for name, x in initial.items()}
