"""Outputs that are peaks of observables: read off histories, so that no integrator has to sum them up.

peak = max |channel(t_k)| over the channels in `Quantity.peak_of` and the samples t_k of the motion, to the end of
the run or to overturning. Between samples the channel may be larger: a rotation's rate by at most the angular
acceleration times the time step.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from models.base import FloatArray, Quantity
from models.runs import Request

STATES_PER_CALL = 400_000
"""Samples of all lanes that are held at once (some tens of MB)."""
AT_SAMPLES = "at the samples of the motion; counted to overturning"

Observed = Callable[[slice, Request], Mapping[str, FloatArray]]


def peaks(
    observed: Observed, request: Request, wanted: Sequence[Quantity], overturning_time: FloatArray
) -> dict[str, FloatArray]:
    """The ``wanted`` outputs (n,) of a request of n lanes.

    ``observed(lanes, request)``: observables (n, [levels,] samples) of some lanes; ``overturning_time`` (n,) in s,
    nan for what stands.
    """
    time = request.times
    per_call = max(1, STATES_PER_CALL // time.size)
    found = {quantity.name: np.empty(request.scale.size) for quantity in wanted}
    until = np.where(np.isnan(overturning_time), np.inf, overturning_time)
    for start in range(0, request.scale.size, per_call):
        lanes = slice(start, start + per_call)
        channels = observed(lanes, replace(request.take(lanes), samples=time.size))
        counted = time <= until[lanes, None]
        for quantity in wanted:
            found[quantity.name][lanes] = np.max([_peak(channels[c], counted) for c in quantity.peak_of], axis=0)
    return found


def _peak(channel: FloatArray, counted: NDArray[np.bool_]) -> FloatArray:
    """Largest absolute value (n,) of a channel (n, [levels,] samples), nan left out, where ``counted`` (n, samples)."""
    by_level = channel if channel.ndim == 3 else channel[:, None]
    over_time = np.fmax.reduce(np.abs(by_level), axis=2, where=counted[:, None], initial=0.0)
    return np.asarray(over_time.max(axis=1))
