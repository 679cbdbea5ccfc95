"""Words for the phases of the motion in which something acts or shows."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from diagnosis.data.measured import Measured
from models.base import FloatArray
from models.identification import Identification, Motion

EVERYWHERE, LATE, ABOVE_10_HZ = "everywhere", "late", "above_10_hz"
WORDS = {EVERYWHERE: "throughout", LATE: "more so late in the recording", ABOVE_10_HZ: "above 10 Hz"}
"""Phase words that every model shares, in plain English."""
MOSTLY, PARTLY = 0.75, 0.25
"""Shares of what acts at events from which on it acts there only, or there too."""
ONE_SIDED = 4.0
"""How much more a phase must hold, per time spent in it, than its opposite."""


def words_of(declared: Identification) -> dict[str, str]:
    """Every phase word of a model's motion in plain English."""
    return {**declared.phases, **WORDS}


def share_at_events(size: FloatArray, event: NDArray[np.bool_]) -> float:
    """Share of ``size`` (W, N) in the steps with an ``event``, beyond what the steps beside them hold."""
    beside = np.zeros_like(size)
    beside[:, 1:-1] = 0.5 * (size[:, :-2] + size[:, 2:])
    return float(np.sum(np.maximum(size - beside, 0.0)[event])) / max(float(size.sum()), 1e-300)


def phases(
    measured: Measured, size: FloatArray, motion: Motion, event: NDArray[np.bool_] | None = None
) -> tuple[str, ...]:
    """At events or between, on which side, at which amplitudes, how late something of ``size`` (W, N) is.

    ``event`` (W, N): steps with an event of the model's `Separation`; None: not distinguished.
    """
    declared, words = measured.identification, []
    compared = np.asarray(measured.mask.any(axis=1))
    occasions = compared
    if event is not None and declared.separation is not None:
        share = share_at_events(size, event)
        words = [declared.separation.event] if share > PARTLY else []
        words += [declared.separation.between] if share < MOSTLY else []
        if share >= MOSTLY:
            occasions = occasions & event
    for dependence in declared.dependences:
        factor = np.broadcast_to(dependence.factor(motion), size.shape)
        if dependence.about_mean:
            factor = factor - 0.5 * float(np.max(factor, where=compared, initial=0.0))
        words.append(_leaning(size, factor, occasions, dependence.phases))
    records = [measured.recordings[w.recording] for w in measured.windows]
    middle = np.array([0.5 * r.time[-1] for r in records])[:, None]
    step = np.array([r.time_step for r in records])[:, None]
    time = (measured.first[:, None] + np.arange(size.shape[1])) * step
    words.append(_leaning(size, time - middle, occasions, ("", LATE)))
    return tuple(word for word in words if word) or (EVERYWHERE,)


def _leaning(size: FloatArray, factor: FloatArray, occasions: NDArray[np.bool_], names: tuple[str, str]) -> str:
    """The word for the end of ``factor`` at which the size is much larger per sample; empty for neither."""
    ends = (occasions & (factor < 0.0), occasions & (factor > 0.0))
    if not all(end.any() for end in ends):
        return ""
    low, high = (float(np.mean(size[end])) for end in ends)
    return names[0] if low > ONE_SIDED * high else names[1] if high > ONE_SIDED * low else ""
