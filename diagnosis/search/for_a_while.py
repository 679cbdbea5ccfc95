"""What acts for a while in each recording: intervals of its own in every one, where a spell of the sequence has one.

A strap that tightens, a guide that engages: what it does comes and goes in every test, at instants that no other test
tells. A recording says by itself in which run of its windows it asks for the effect, given what the effect does.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from diagnosis.data.measured import Measured
from diagnosis.fit.misfit import Misfit
from diagnosis.fit.solver import fit
from diagnosis.search.instants import NO_UNKNOWNS, ends_in
from diagnosis.search.runs import largest_run
from diagnosis.search.spells import Spell
from grids.stages import Stage
from models.base import FloatArray

LASTS = float("inf")
Interval = tuple[float, float]
"""Begin and end (s); an end of infinity is the recording's own, twice 0 is never."""
NEVER: Interval = (0.0, 0.0)
ALWAYS: Interval = (0.0, LASTS)


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
    step = m.recordings[r].time_step
    last = m.windows[own[high]]
    begins = 0.0 if low == 0 else m.windows[own[low]].first * step
    return begins, LASTS if high == own.size - 1 else (last.first + last.samples) * step


def acting_in(misfit: Misfit, mechanism: str, intervals: Sequence[Interval]) -> Misfit:
    """The misfit with a mechanism that acts in one interval of each recording."""
    m = misfit.measured
    own = tuple(Stage(r.name, *interval) for r, interval in zip(m.recordings, intervals, strict=True))
    return replace(misfit, predictor=replace(misfit.predictor, stages={**misfit.predictor.stages, mechanism: own}))


def exact(misfit: Misfit, mechanism: str, states: FloatArray, r: int, interval: Interval) -> Interval:
    """An interval of recording ``r`` with its instants found within the windows; nothing is unknown in ``misfit``."""
    if interval == NEVER:
        return NEVER
    begins, ends = interval
    spell = Spell(r, begins if begins > 0.0 else None, r, ends if np.isfinite(ends) else None)
    found = ends_in(misfit, states, mechanism, spell).spell
    if found.first != r or found.last != r:
        return interval
    return found.begins or 0.0, LASTS if found.ends is None else found.ends
