"""Observable channels from the state of many walls at once."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from models.base import Event, FloatArray
from models.interface.layered import LayeredWall
from models.observed import Observed


def observe(wall: LayeredWall, state: FloatArray) -> Observed:
    """Observables ``(n, m)`` of states q, q' ``(n, m, 8)`` of n walls; see `declaration.OBSERVABLES`.

    With effects ``(n, m, 16)``: the other coordinates and their rates after the plain ones.
    """
    t1, t2, z1, z2, v1, v2, y1, y2 = np.moveaxis(state[:, :, :8], 2, 0)
    x1 = x2 = zm = beside = np.zeros_like(t1)
    tm, vm = t1, v1
    if wall.effects is not None and state.shape[2] == 16:
        x1, x2, tm, zm, _, _, vm, _ = np.moveaxis(state[:, :, 8:], 2, 0)
        beside = wall.effects.top_offset[:, None]

    def lane(values: FloatArray) -> FloatArray:
        return values[:, None]

    half = lane(0.5 * wall.height_1)

    def rolled(slip: FloatArray, half_width: FloatArray, turn: FloatArray) -> FloatArray:
        """Slip of a joint, and what it moves on by its edge."""
        if not wall.toe_held:
            return slip
        return np.asarray(slip + np.sign(turn) * lane(half_width) * (1.0 - np.cos(turn)))

    def foot() -> FloatArray:
        return rolled(x1, wall.base_half_width, t1)

    def leaning() -> tuple[FloatArray, FloatArray]:
        """sin of the lower and of the upper half."""
        lower = np.sin(t1)
        return lower, lower if tm is t1 else np.sin(tm)

    def wall_centre() -> FloatArray:
        # of both halves
        lower, upper = leaning()
        return np.asarray(foot() + 0.75 * half * lower + (0.25 * half + 0.5 * zm) * upper)

    def block_centre() -> FloatArray:
        along = rolled(x2, wall.top_half_width, t2 - tm)
        above = half + lane(wall.top_thickness_in_height) + zm + z2
        lower, upper = leaning()
        centre = foot() + half * lower
        if np.any(along):
            centre += along * np.cos(tm)
        centre += above * upper
        centre += lane(wall.centre_2) * np.sin(t2)
        return np.asarray(centre + beside * np.cos(t2) if np.any(beside) else centre)

    def contact_1() -> FloatArray:
        if wall.joints == "top":
            return np.ones_like(t1)
        late = np.where(wall.clip, wall.base_damping / wall.base_stiffness, 0.0)
        return share(lane(wall.base_half_width), lane(late), z1, np.sin(t1), y1, np.cos(t1) * v1)

    def contact_2() -> FloatArray:
        if wall.joints == "base":
            return np.ones_like(t1)
        turn = t2 - tm
        late = np.where(wall.clip, wall.top_damping / wall.top_stiffness, 0.0)
        return share(lane(wall.top_half_width), lane(late), z2, np.sin(turn), y2, np.cos(turn) * (v2 - vm))

    return Observed(
        {
            "rotation_1": lambda: t1,
            "rotation_2": lambda: t2,
            "rotation_rate_1": lambda: v1,
            "rotation_rate_2": lambda: v2,
            "displacement_1_x": wall_centre,
            "displacement_2_x": block_centre,
            "compression_base": lambda: -z1,
            "compression_top": lambda: -z2,
            "contact_1": contact_1,
            "contact_2": contact_2,
        }
    )


def share(
    b: FloatArray, late: FloatArray, z: FloatArray, s: FloatArray, z_rate: FloatArray, s_rate: FloatArray
) -> FloatArray:
    """Share of [-b, b] on which w < 0 and w + late w' < 0, w = z - x S; ``late`` = c/k under law B, else 0.

    Each condition holds on one side of the root of its line; the share is the overlap of both.
    """
    low, high = -b + np.zeros_like(z), b + np.zeros_like(z)
    for level, slope in ((z, s), (z + late * z_rate, s + late * s_rate)):
        with np.errstate(divide="ignore", invalid="ignore"):
            root = level / slope
        flat = np.where(level < 0.0, -np.inf, np.inf)
        low = np.where(slope > 0.0, np.maximum(low, root), np.where(slope == 0.0, np.maximum(low, flat), low))
        high = np.where(slope < 0.0, np.minimum(high, root), high)
    return np.asarray(np.maximum(high - low, 0.0) / (2.0 * b))


def with_onset(logs: Sequence[tuple[Event, ...]]) -> tuple[tuple[Event, ...], ...]:
    """The logs of several lanes in which the first uplift is the onset too."""
    found = []
    for events in logs:
        first = next((k for k, event in enumerate(events) if event.kind == "uplift"), None)
        onset = () if first is None else (Event(events[first].time, "onset", events[first].body),)
        found.append((*events[:first], *onset, *events[first:]) if onset else events)
    return tuple(found)
