"""Cells to outputs: lanes are grouped by what a model takes once per call.

A model advances many lanes under one shaking; so cells are grouped by motion, time scale and option
words, and each group is one call. Every lane's result is its own: it does not depend on the other
lanes of the call, and neither therefore on blocks or schedulers.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

import models
from grids.alike import SCALING, Coordinates, like_cells
from grids.motions import Motion
from grids.targets import MOTION
from study.keys import Setting


def evaluate(setting: Setting, motions: Mapping[str, Motion], cells: Coordinates) -> dict[str, NDArray[Any]]:
    """Outputs ``(n,)`` of the cells, by name.

    ``motions`` by the values of the coordinate ``motion``; without such a coordinate it holds the
    one motion of all cells. The horizontal component is scaled to ``pga`` (m s-2) if that is given, both
    components by the same factor, times ``motion_scale``; ``time_scale`` stretches time.
    """
    model = models.get(setting.model)
    size = len(next(iter(cells.values()))) if cells else 1
    results: dict[str, NDArray[Any]] = {}
    for key, index in like_cells(model, cells, size):
        values, scaling = _split({**setting.fixed, **{k: v[index] for k, v in cells.items() if k not in key}})
        words = {k: str(v) for k, v in key.items() if k in model.options}
        motion = motions[key[MOTION]] if MOTION in key else next(iter(motions.values()))
        stretch = float(key.get("time_scale", setting.fixed.get("time_scale", 1.0)))
        if stretch != 1.0:
            motion = motion.time_scaled(stretch)
        computed = model.evaluate(
            values,
            motion.shaking(vertical_acts="vertical_acceleration.kappa" not in values),
            _scale(motion, scaling, index.size),
            outputs=setting.outputs,
            tail=setting.tail,
            options={**setting.options, **words},
            integrator=setting.integrator,
        )
        for name in setting.outputs:
            column = computed[name]
            results.setdefault(name, np.empty(size, column.dtype))[index] = column
    return results


def _split(given: Mapping[str, Any]) -> tuple[dict[str, Any], dict[str, Any]]:
    values = {name: value for name, value in given.items() if name not in SCALING}
    return values, {name: value for name, value in given.items() if name in SCALING}


def _scale(motion: Motion, scaling: Mapping[str, Any], size: int) -> NDArray[np.float64]:
    scale = np.broadcast_to(np.asarray(scaling.get("motion_scale", 1.0), dtype=np.float64), size).copy()
    if "pga" in scaling:
        scale *= np.asarray(scaling["pga"], dtype=np.float64) / motion.pga
    return scale
