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
    tm, vm = (state[:, :, 10], state[:, :, 14]) if state.shape[2] == 16 else (t1, v1)

    def lane(values: FloatArray) -> FloatArray:
        return values[:, None]

    def centre(of_block: bool) -> FloatArray:
        from models.interface.lanes.centres import centres  # compiled when it is first asked for

        toe = 1.0 if wall.toe_held else 0.0
        offset = 0.0 if wall.effects is None else wall.effects.top_offset
        each = (
            0.5 * wall.height_1, wall.top_thickness_in_height, wall.centre_2, offset, toe * wall.base_half_width,
            toe * wall.top_half_width,
        )  # fmt: skip
        found = np.empty(state.shape[:2])
        lanes = np.stack([np.broadcast_to(values, (wall.size,)) for values in each], axis=1)
        centres(np.ascontiguousarray(state), lanes, of_block, found)
        return found

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
            "displacement_1_x": lambda: centre(of_block=False),
            "displacement_2_x": lambda: centre(of_block=True),
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
        with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
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
