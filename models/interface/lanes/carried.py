"""States of walls that no recording holds, along a measured motion: compression of the layers, and their past."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from models.base import FloatArray
from models.interface import modes
from models.interface.declaration import STATES
from models.interface.lanes import rows as r
from models.interface.lanes.carry import carry as advance
from models.interface.lanes.laws import HISTORY, given_laws, some
from models.interface.lanes.run import given_table, substeps
from models.interface.layered import LayeredWall
from models.lanes.record import recorded
from models.shaking import Shaking


def carry(
    wall: LayeredWall,
    shaking: Shaking,
    motion: Mapping[str, FloatArray],
    marks: NDArray[np.int64],
    first: NDArray[np.int64],
    initial: Mapping[str, FloatArray],
) -> dict[str, FloatArray]:
    """The states that ``motion`` does not hold, and the history of the layers, of n walls at k ``marks``.

    As `models.model.Model.carry`.
    """
    rest = modes.static_state(wall)
    begun = {**initial, **{name: x[:, 0] for name, x in motion.items()}}
    given = given_table(wall, np.ones(wall.size), begun, rest)
    steps = substeps(wall, modes.at_rest(wall, rest).squares, shaking.time_step)
    given[:, r.Q_STEPS] = steps
    laws = given_laws(wall, rest, shaking.time_step / steps, initial)
    held = np.array([k for k, name in enumerate(STATES) if name in motion], np.int64)
    prescribed = np.stack([motion[STATES[k]] for k in held], axis=-1)
    record = recorded(shaking, 1, 0.0)
    states = np.zeros((wall.size, marks.size, len(STATES)))
    history = np.zeros((wall.size, marks.size, *(() if laws is None else laws.hidden.shape[1:])))
    for per in np.unique(steps):
        lanes = np.flatnonzero(steps == per)
        of_lanes, past = np.zeros((lanes.size, *states.shape[1:])), np.zeros((lanes.size, *history.shape[1:]))
        advance(
            record, first[lanes], given[lanes], prescribed if prescribed.shape[0] == 1 else prescribed[lanes], held,
            marks, of_lanes, past, None if wall.joints == "both" else True, None if laws is None else True,
            None if laws is None else some(laws, lanes),
        )  # fmt: skip
        states[lanes], history[lanes] = of_lanes, past
    found = {name: states[:, :, k] for k, name in enumerate(STATES) if name not in motion}
    return found if laws is None else {**found, HISTORY: history}
