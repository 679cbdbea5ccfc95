"""Observable channels from the states of many chains at once."""

from __future__ import annotations

import numpy as np

from models.base import FloatArray
from models.isolated.chain import Chain
from models.isolated.declaration import MOST_LEVELS


def observe(chain: Chain, state: FloatArray) -> dict[str, FloatArray]:
    """Observables of states ``(n, m, 2 most levels + 1)`` (x, x', bearing force) of n chains.

    Those by level are ``(n, levels, m)`` with the levels of the longest chain, nan where a shorter one has none, the
    others ``(n, m)``; see `declaration.OBSERVABLES`.
    """
    levels = int(chain.levels.max())
    there = (np.arange(levels) < chain.levels[:, None])[:, :, None]
    x = np.moveaxis(state[:, :, :levels], 1, 2)
    v = np.moveaxis(state[:, :, MOST_LEVELS : MOST_LEVELS + levels], 1, 2)
    bearing = state[:, :, -1]
    storeys = chain.storey_stiffness[:, None, None] * np.diff(x, axis=1)
    storeys = storeys + chain.storey_damping[:, None, None] * np.diff(v, axis=1)
    storeys = np.where(there[:, 1:], storeys, 0.0)
    below = np.concatenate([bearing[:, None], storeys], axis=1)
    above = np.concatenate([storeys, np.zeros_like(bearing)[:, None]], axis=1)
    return {
        "level_acceleration_x": (above - below) / np.where(there, chain.masses[:, :levels, None], np.nan),
        "level_displacement_x": np.where(there, x, np.nan),
        "bearing_displacement": x[:, 0],
        "bearing_velocity": v[:, 0],
        "bearing_force": bearing,
    }
