"""Walls that have no state of rest under their own weight."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from models.interface import modes, resting
from models.interface.layered import LayeredWall

Unable = tuple[NDArray[np.bool_], str]
"""Lanes (n,), and a sentence about the worst of them."""


def cannot_stand(wall: LayeredWall) -> list[Unable]:
    """The walls that a layer cannot carry, that creep without end, that tip over, or that crush a layer at rest."""
    found, lanes = wall.of_distinct(_cannot_stand)
    return [(unable[lanes], said) for unable, said in found]


def _cannot_stand(wall: LayeredWall) -> list[Unable]:
    straight, rest = resting.upright(wall), modes.static_state(wall)
    over = np.any(np.isnan(rest), axis=1) & ~np.any(np.isnan(straight), axis=1)
    leaning = over & modes.stable(wall, straight)
    said = "what makes the wall lean tips it over before its layers hold it: less of it, or stiffer layers"
    return [
        *_laws(wall, -straight[:, 2:]),
        _tipping(wall, ~modes.stable(wall, np.where(over[:, None], straight, rest))),
        (leaning, said),
        *_crushed(wall, -rest),
    ]


def _laws(wall: LayeredWall, compression: NDArray[np.float64]) -> list[Unable]:
    """Where a law cannot hold its layer; ``compression`` (n, 2) in m, nan where the load is too much."""
    found = []
    for joint, u in zip(("base", "top"), compression.T, strict=True):
        if joint in wall.rubber_joints:
            said = f"the law of the {joint} layer cannot carry its load at rest: make it stiffer or yield later"
            found.append((np.isnan(u), said))
            for law, p in wall.laws_at(joint):
                creeping, said = law.restless(p, u)
                found.append((creeping, f"in the {joint} layer {said}"))
    return found


def _tipping(wall: LayeredWall, tips: NDArray[np.bool_]) -> Unable:
    """Where gravity takes more than the layers give."""
    worst = int(np.argmax(tips))
    return tips, (
        f"the layers are too soft to hold the wall upright (k_b = {wall.base_stiffness[worst]:.3g}, "
        f"k_t = {wall.top_stiffness[worst]:.3g} N m-2): make them stiffer or the wall longer"
    )


def _crushed(wall: LayeredWall, compression: NDArray[np.float64]) -> list[Unable]:
    """Where a layer is compressed beyond its thickness; ``compression`` (n, 4), the layers' last."""
    found = []
    for joint, u, thickness in (
        ("base", compression[:, 2], wall.base_thickness),
        ("top", compression[:, 3], wall.top_thickness),
    ):
        if joint in wall.rubber_joints:
            worst = int(np.argmax(np.where(u > thickness, u - thickness, -np.inf)))
            said = (
                f"under its load the {joint} layer is compressed by {u[worst] * 1e3:.3g} mm, more than "
                f"its thickness of {thickness[worst] * 1e3:.3g} mm: make it stiffer or thicker"
            )
            found.append((u > thickness, said))
    return found
