"""Observable channels, and where the levels are, from the states of many chains at once."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial

import numpy as np

from models.base import FloatArray
from models.isolated.chain import Chain
from models.isolated.declaration import MOST_LEVELS
from models.observed import Observed


def observe(chain: Chain, state: FloatArray) -> dict[str, FloatArray]:
    """Observables of states ``(n, m, 2 most levels + 1)`` (x, x', bearing force) of n chains.

    Those by level are ``(n, levels, m)`` with the levels of the longest chain, nan where a shorter one has none, the
    others ``(n, m)``; see `declaration.OBSERVABLES`.
    """
    levels = int(chain.levels.max())
    there = (np.arange(levels) < chain.levels[:, None])[:, :, None]
    x, v, bearing = _split(state, levels)
    return {
        "level_acceleration_x": np.where(there, _accelerations(chain, x, v, bearing), np.nan),
        "level_displacement_x": np.where(there, x, np.nan),
        "bearing_displacement": x[:, 0],
        "bearing_velocity": v[:, 0],
        "bearing_force": bearing,
    }


def poses(chain: Chain, state: FloatArray) -> Observed:
    """Where the levels are ``(n, m)``, their rates and masses, for `Model.poses`: body 1 is the slab.

    0 where a chain has no such level; those above the longest chain are left out.
    """
    levels = int(chain.levels.max())
    x, v, bearing = _split(state, levels)
    accelerations = cache(lambda: _accelerations(chain, x, v, bearing))

    def of_level(k: int) -> FloatArray:
        return accelerations()[:, k]

    found: dict[str, Callable[[], FloatArray]] = {}
    for k in range(levels):
        body, mass = k + 1, chain.masses[:, k, None]
        found[f"underside_{body}_x"] = partial(x.__getitem__, (slice(None), k))
        found[f"velocity_{body}_x"] = partial(v.__getitem__, (slice(None), k))
        found[f"acceleration_{body}_x"] = partial(of_level, k)
        found[f"mass_{body}"] = partial(np.broadcast_to, mass, bearing.shape)
    return Observed(found)


def _split(state: FloatArray, levels: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """x, x' ``(n, levels, m)`` and the bearings' force ``(n, m)``."""
    x = np.moveaxis(state[:, :, :levels], 1, 2)
    v = np.moveaxis(state[:, :, MOST_LEVELS : MOST_LEVELS + levels], 1, 2)
    return x, v, state[:, :, -1]


def _accelerations(chain: Chain, x: FloatArray, v: FloatArray, bearing: FloatArray) -> FloatArray:
    """Absolute accelerations ``(n, levels, m)``, 0 where a chain has no such level."""
    levels = x.shape[1]
    there = (np.arange(levels) < chain.levels[:, None])[:, :, None]
    storeys = chain.storey_stiffness[:, None, None] * np.diff(x, axis=1)
    storeys = storeys + chain.storey_damping[:, None, None] * np.diff(v, axis=1)
    storeys = np.where(there[:, 1:], storeys, 0.0)
    below = np.concatenate([bearing[:, None], storeys], axis=1)
    above = np.concatenate([storeys, np.zeros_like(bearing)[:, None]], axis=1)
    return np.asarray((above - below) / np.where(there, chain.masses[:, :levels, None], np.inf))
