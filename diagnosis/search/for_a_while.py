"""In which interval a recording asks for an effect, given what it does: no other recording tells that.

So it is found in recordings learned from and in those held out alike.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from diagnosis.data.measured import Measured
from diagnosis.fit.misfit import Misfit
from diagnosis.fit.solver import fit
from diagnosis.search.instants import NO_UNKNOWNS, ends_within
from diagnosis.search.runs import largest_run
from diagnosis.search.spells import LASTS, NEVER, Interval, Spell, interval_of
from models.base import FloatArray


def gain(misfit: Misfit, mechanism: str, nulls: Mapping[str, float], states: FloatArray) -> FloatArray:
    """What a mechanism takes off the loss of each window (W,) when it acts everywhere; nothing is unknown in it."""
    stages = {name: one for name, one in misfit.predictor.stages.items() if name != mechanism}
    on = replace(misfit, predictor=replace(misfit.predictor, stages=stages))
    off = replace(on, fixed={**on.fixed, **nulls})
    return np.asarray(np.subtract(*(fit(one, NO_UNKNOWNS, states).window_losses for one in (off, on))))


def asking(m: Measured, r: int, gained: FloatArray, least: float) -> Interval:
    """The run of windows of recording ``r`` that asks for what gains this (W,) there, by ``least`` in all."""
    own = np.flatnonzero(m.recording_of == r)
    if not own.size:
        return NEVER
    low, high = largest_run(gained[own])
    if float(gained[own[low : high + 1]].sum()) < least:
        return NEVER
    return interval_of(m, int(own[low]), int(own[high]))


def exact(misfit: Misfit, mechanism: str, states: FloatArray, r: int, interval: Interval) -> Interval:
    """An interval of recording ``r`` with its instants found within the windows; nothing is unknown in ``misfit``."""
    if interval == NEVER or not np.any(misfit.measured.recording_of == r):  # without a window nothing tells it
        return interval
    begins, ends = interval
    spell = Spell(r, begins if begins > 0.0 else None, r, ends if np.isfinite(ends) else None)
    found = ends_within(misfit, states, mechanism, spell).spell
    return found.begins or 0.0, LASTS if found.ends is None else found.ends
