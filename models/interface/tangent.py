"""Stiffness of the layers as recordings tell it: the slope of each layer's law on unloading from its static state.

Small motions see that slope, whatever law made it, and large ones see the law about it; the stiffness k of the
unstressed layer is a combination of both. So a fit works with the slope and k follows,

    k <- k (target/slope(k))^(1/p),        p = d ln slope/d ln k from the last two rounds, 1 at first,

the slope taken at the compression that carries the load by the law with k. Where none does, k is doubled until one
does, and a step that leads to where none does is halved. A Maxwell arm is left out of the slope: at rest it carries
nothing.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from models.base import FloatArray, Values
from models.interface import modes
from models.interface.layered import LayeredWall
from models.rubber.layer import Layer

JOINTS = {
    "base_stiffness": ("base",),
    "top_stiffness": ("top",),
    "base_layer_modulus": ("base",),
    "top_layer_modulus": ("top",),
    "layer_modulus": ("base", "top"),
}
"""The parameters that can stand for a slope, and the joints whose layers they make; of two the mean counts."""
LEFT_OUT = ("maxwell",)
ROUNDS, LEAST, FARTHEST = 6, 0.1, 1.5
"""Rounds of the iteration, the least p that is believed, and the largest step of ln k."""
DOUBLINGS = 3
"""Of a stiffness with which a layer cannot carry its load: one that yields or softens has a slope far below it."""


def unstressed(wall: LayeredWall, values: Values, names: Sequence[str]) -> dict[str, FloatArray]:
    """The ``names``, given as slopes of n lanes, as the parameters (n,) of the unstressed layers that have them.

    ``wall``: the walls of ``values`` with the slopes for stiffnesses.

    Where no stiffness has the slope the one with the nearest of those tried is taken; where a layer cannot carry its
    load with eight times that stiffness, they stay as given.
    """
    joints = [j for j in wall.rubber_joints if _kept(wall, j).laws and any(j in JOINTS[name] for name in names)]
    asked = {joint: _stiffness(wall, joint) for joint in joints}
    power = {joint: np.ones(wall.size) for joint in joints}
    best = {joint: (asked[joint], np.full(wall.size, np.inf)) for joint in joints}
    wall = _standing(wall, joints)
    before = {joint: (_stiffness(wall, joint), np.full(wall.size, np.nan)) for joint in joints}
    for _ in range(ROUNDS if joints else 0):
        rest, found = modes.static_state(wall), {}
        for joint in joints:
            k, slope = _stiffness(wall, joint), _slope(wall, joint, rest)
            with np.errstate(divide="ignore", invalid="ignore"):
                gap = np.log(asked[joint] / slope)
                local = np.log(slope / before[joint][1]) / np.log(k / before[joint][0])
            power[joint] = np.where(np.isfinite(local) & (local > LEAST), local, power[joint])
            nearer, stands = np.abs(gap) < best[joint][1], np.isfinite(slope)
            best[joint] = np.where(nearer, k, best[joint][0]), np.where(nearer, np.abs(gap), best[joint][1])
            ahead = k * np.exp(np.clip(gap / power[joint], -FARTHEST, FARTHEST))
            found[f"{joint}_stiffness"] = np.where(stands, ahead, np.sqrt(k * before[joint][0]))
            before[joint] = np.where(stands, k, before[joint][0]), np.where(stands, slope, before[joint][1])
        wall = wall.replace(**found)
    shares = {joint: best[joint][0] / asked[joint] for joint in joints}
    return {
        name: values[name] * np.mean([shares[joint] for joint in joints if joint in JOINTS[name]], axis=0)
        for name in names
        if set(joints) & set(JOINTS[name])
    }


def _standing(wall: LayeredWall, joints: Sequence[str]) -> LayeredWall:
    """With stiffnesses at which the layers of the ``joints`` carry their load, where some doublings lead there."""
    for _ in range(DOUBLINGS if joints else 0):
        rest = modes.static_state(wall)
        lacking = {joint: np.isnan(rest[:, 2 if joint == "base" else 3]) for joint in joints}
        if not any(np.any(lanes) for lanes in lacking.values()):
            break
        stiffer = {j: np.where(lanes, 2.0, 1.0) * _stiffness(wall, j) for j, lanes in lacking.items()}
        wall = wall.replace(**{f"{joint}_stiffness": k for joint, k in stiffer.items()})
    return wall


def _stiffness(wall: LayeredWall, joint: str) -> FloatArray:
    return wall.base_stiffness if joint == "base" else wall.top_stiffness


def _kept(wall: LayeredWall, joint: str) -> Layer:
    layer = wall.layer(joint)
    return Layer(layer.stiffness, [(law, p) for law, p in layer.laws if law.name not in LEFT_OUT])


def _slope(wall: LayeredWall, joint: str, rest: FloatArray) -> FloatArray:
    """Of the layer at ``rest`` (n, 4), without what is left out."""
    kept, compression = _kept(wall, joint), -rest[:, 2 if joint == "base" else 3]
    return np.asarray(kept.slope(compression, kept.relaxed(compression)) + 0.0 * compression)
