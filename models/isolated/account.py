"""What both integrators make of a run: energies, and the flag of its outcome."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from models.base import STATUS, FloatArray
from models.isolated import bearing
from models.isolated.chain import Chain


def energy(chain: Chain, levels: int, y: FloatArray, memory: bearing.Memory) -> FloatArray:
    """Kinetic energy, and what storeys and bearings have stored, in J, of states y (n, 2 levels)."""
    x, v = y[:, :levels], y[:, levels : 2 * levels]
    kinetic = 0.5 * np.sum(chain.masses[:, :levels] * v**2, axis=1)
    drifts = 0.5 * chain.storey_stiffness * np.sum(np.diff(x, axis=1) ** 2, axis=1)
    return np.asarray(kinetic + drifts + bearing.stored(chain, x[:, 0], memory))


def status(failed: NDArray[Any], moved: NDArray[Any]) -> FloatArray:
    """The flags of `models.base.STATUS`."""
    word = np.where(moved, STATUS.index("rocking"), STATUS.index("rest"))
    return np.where(failed, STATUS.index("not_converged"), word).astype(np.float64)
