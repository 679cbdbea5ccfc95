"""The rubber laws of walls as the lane kernel takes them, and the energy in their springs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from models.base import FloatArray
from models.interface.fibres import COUNT, Fibres
from models.interface.lanes.fibres import Rubber
from models.interface.layered import LayeredWall
from models.interface.strip import stored
from models.rubber import lanes as rubber

JOINTS = ("base", "top")
HISTORY = "strain_history"
"""Name of the hidden states of both layers, (n, 2, laws, 16), among what a run starts from."""


def given_laws(
    wall: LayeredWall, rest: FloatArray, step: FloatArray, initial: Mapping[str, FloatArray]
) -> Rubber | None:
    """Layers of n walls for steps of ``step`` (n,) seconds; None without laws.

    With the history that ``initial`` holds, else relaxed at ``rest`` (n, 8).
    """
    if not wall.laws:
        return None
    numbers = np.stack([rubber.number_table(wall.laws_at(joint), step) for joint in JOINTS], axis=1)
    hidden = np.zeros((wall.size, 2, rubber.N_HIDDEN, COUNT))
    angles = rest[:, 0], rest[:, 1] - (rest[:, 0] if wall.coordinates < 8 else rest[:, 6])
    for k, joint in enumerate(JOINTS):
        if HISTORY not in initial and (laws := wall.laws_at(joint)):
            hidden[:, k] = rubber.hidden_table(laws, Fibres(wall, joint).relaxed(rest[:, 2 + k], angles[k]))
    if HISTORY in initial:
        hidden = np.ascontiguousarray(initial[HISTORY])
    base, top = (rubber.acting(wall.laws_at(joint)) for joint in JOINTS)
    return Rubber(numbers, hidden, hidden.copy(), base, top)


def some(laws: Rubber, lanes: Any) -> Rubber:
    """The laws of some of the lanes."""
    return laws._replace(numbers=laws.numbers[lanes], hidden=laws.hidden[lanes], ended=laws.ended[lanes])


def stored_in_layers(wall: LayeredWall, q: FloatArray, hidden: FloatArray | None) -> FloatArray:
    """Energy (J) in the springs of the base and the top layer (n, 2) at q (n, 4) and the kernel's hidden states."""
    found = np.zeros((wall.size, 2))
    for k, joint in enumerate(JOINTS):
        if joint not in wall.rubber_joints:
            continue
        half = wall.base_half_width if joint == "base" else wall.top_half_width
        angle = q[:, 0] if joint == "base" else q[:, 1] - q[:, 0]
        z, layer = q[:, 2 + k], wall.layer(joint)
        found[:, k] = stored(half, layer.stiffness, z, np.sin(angle))
        if layer.laws and hidden is not None:
            found[:, k] += Fibres(wall, joint).energy(z, angle, rubber.hidden_states(layer.laws, hidden[:, k]))
    return found
