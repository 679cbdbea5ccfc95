"""What a run of two stacked blocks gathers, and the declared outputs made of it.

One row of numbers a lane, shared by the compiled lanes and the plain reference.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from models.base import STATUS
from models.stacked.configuration import CONFIGURATIONS, NAMES
from models.stacked.stack import Stack

(
    PEAK_1, PEAK_2, ONSET_BASE, ONSET_TOP, OVERTURNED_1, OVERTURNED_2, IMPACTS_BASE, IMPACTS_TOP,
    END_1, END_2, LOST_BASE, LOST_TOP, FRICTION_BASE, FRICTION_TOP, FAILED, VISITED,
) = range(16)  # fmt: skip
TIME_IN = 16
N_ACCOUNT = TIME_IN + len(CONFIGURATIONS)
BOUNDLESS = 1e300
"""Stands for an infinite friction demand."""

Table = NDArray[np.float64]


def blank(size: int) -> Table:
    """Accounts of ``size`` lanes before they start."""
    table = np.zeros((size, N_ACCOUNT))
    table[:, [ONSET_BASE, ONSET_TOP, OVERTURNED_1, OVERTURNED_2]] = np.nan
    return table


def outputs(stack: Stack, table: Table) -> dict[str, NDArray[Any]]:
    """The declared outputs, arrays ``(n,)``; an overturned body has pi/2 for its peak and its end."""
    half = np.pi / 2.0
    over = ~np.isnan(table[:, [OVERTURNED_1, OVERTURNED_2]])
    peak = np.where(over, half, table[:, [PEAK_1, PEAK_2]])
    end = np.where(over, np.copysign(half, table[:, [END_1, END_2]]), table[:, [END_1, END_2]])
    durations = table[:, TIME_IN:]
    lost = table[:, [LOST_BASE, LOST_TOP]]
    friction = table[:, [FRICTION_BASE, FRICTION_TOP]]
    found: dict[str, NDArray[Any]] = {
        **_both("peak_rotation", "12", peak, np.max(peak, axis=1)),
        **_ratio(peak / np.stack([stack.slenderness, stack.slenderness_2], axis=1)),
        **_uplift(durations),
        **_both("onset_time", "bt", table[:, [ONSET_BASE, ONSET_TOP]]),
        **_both("overturned", "12", over, np.any(over, axis=1)),
        **_both("overturning_time", "12", table[:, [OVERTURNED_1, OVERTURNED_2]]),
        **_both("residual_rotation", "12", end, _larger(end)),
        **_both("dissipated_energy", "bt", lost, np.sum(lost, axis=1)),
    }
    impacts = table[:, [IMPACTS_BASE, IMPACTS_TOP]].astype(np.int32)
    found |= _both("impacts", "bt", impacts, np.max(impacts, axis=1))
    friction = np.where(friction >= BOUNDLESS, np.inf, friction)
    found |= _both("friction_demand", "bt", friction, np.max(friction, axis=1))
    found["configurations"] = table[:, VISITED].astype(np.int16)
    found |= {f"time_in_{name}": durations[:, k] for k, name in enumerate(NAMES)}
    rocked = (peak > 0.0).any(axis=1) | ~np.isnan(found["onset_time"])
    status = np.where(rocked, STATUS.index("rocking"), STATUS.index("rest"))
    status = np.where(found["overturned"], STATUS.index("overturned"), status)
    failed = (table[:, FAILED] != 0.0) | ~np.isfinite(end).all(axis=1)
    found["status"] = np.where(failed, STATUS.index("not_converged"), status).astype(np.int8)
    return found


def _both(name: str, ends: str, pair: NDArray[Any], plain: NDArray[Any] | None = None) -> dict[str, NDArray[Any]]:
    """``name`` and its two members; plain is the earlier of two times (nan: never) unless given."""
    first, second = ("_1", "_2") if ends == "12" else ("_base", "_top")
    if plain is None:
        plain = np.fmin(pair[:, 0], pair[:, 1])
    return {name: plain, f"{name}{first}": pair[:, 0], f"{name}{second}": pair[:, 1]}


def _larger(pair: NDArray[Any]) -> NDArray[Any]:
    return np.where(np.abs(pair[:, 0]) >= np.abs(pair[:, 1]), pair[:, 0], pair[:, 1])


def _ratio(ratio: NDArray[Any]) -> dict[str, NDArray[Any]]:
    return _both("peak_rotation_ratio", "12", ratio, np.max(ratio, axis=1))


def _uplift(durations: NDArray[Any]) -> dict[str, NDArray[Any]]:
    base = [k for k, (s1, _) in enumerate(CONFIGURATIONS) if s1]
    top = [k for k, (_, s2) in enumerate(CONFIGURATIONS) if s2]
    pair = np.stack([durations[:, base].sum(axis=1), durations[:, top].sum(axis=1)], axis=1)
    return _both("uplift_duration", "bt", pair, np.max(pair, axis=1))
