"""Where a named effect acts: intervals, channels, phase and side of its force, impulse or error along the motion.

An interval is a stretch in which the action exceeds LEAST of its largest value. Of an effect that acts through
impulses alone an interval runs from its first to its last one, as long as it leaves out no two events in a row.
Between windows nothing moves or nothing was compared: an interval goes on there if it does behind.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from diagnosis.answer.phases import MOSTLY, phases, share_at_events
from diagnosis.answer.result import Located, Visited
from diagnosis.data.measured import Measured
from diagnosis.forces.action import Action
from grids.stages import Stage, intervals
from models.base import FloatArray

LEAST = 0.01
"""Share of its largest value under which an action counts as none."""
ROUNDING = 1e-9
"""Share of the largest rate under which an impulse is rounding."""
MOST_POINTS = 500
"""Samples of a law that are kept to be drawn."""
UNSEEN = 1.0
"""s compared, at most, between an end of a stage and what acts in it: events may be as far apart."""
PAUSE = 0.1
"""s that an action may pass through zero within one interval."""


def acts(measured: Measured, action: Action) -> tuple[Located, ...]:
    """The intervals in which the effect acts, those with the largest share of its action first."""
    size = _relative(measured, action)
    total = float(size.sum())
    if total <= 0.0:
        return ()
    whole, event = size.sum(axis=1), action.event if action.kind == "force" else None
    at_events = event is not None and share_at_events(whole, event) >= MOSTLY
    words = phases(measured, whole, action.motion, event)
    found = []
    for r, recording in enumerate(measured.recordings):
        own = np.flatnonzero(measured.recording_of == r)
        for c, channel in enumerate(measured.channels):
            named = channel if action.kind == "error" else _turned(measured, c)
            level, unit = LEAST * float(size[:, c].max()), _unit(measured, action, channel, at_events)
            if not own.size or float(size[own, c].max()) <= 0.0:
                continue
            line, compared, happens = (
                _along(measured, own, recording.time.size, values)
                for values in (size[own, c], measured.mask[own, c].astype(float), action.event[own].astype(float))
            )
            if at_events:
                rate = _along(measured, own, recording.time.size, np.abs(action.motion.rate[own]))
                ratio = np.where((happens > 0.0) & (compared > 0.0), line / np.maximum(rate, 1e-12), 0.0)
                stretches = _chains(np.flatnonzero((happens > 0.0) & (compared > 0.0)), ratio > LEAST * ratio.max())
            else:
                stretches = _runs(line > level, compared > 0.0, recording.time_step)
            for low, high in stretches:
                inside = slice(low, high + 1)
                amount = np.abs(_along(measured, own, recording.time.size, action.amount[own, c])[inside]).max()
                per_time = 1.0 if at_events or action.kind == "error" else recording.time_step
                found.append(
                    Located(
                        recording.name, named, low * recording.time_step, (high + 1) * recording.time_step, words,
                        float(line[inside].sum()) / total, action.effect, float(amount) / per_time, unit,
                    )
                )  # fmt: skip
    return tuple(sorted(found, key=lambda place: -place.share))


def within_stages(measured: Measured, places: Sequence[Located], stages: Sequence[Stage]) -> tuple[Located, ...]:
    """The intervals of an effect with stages, carried on to the ends of its stages where next to nothing was compared.

    There nothing contradicts that it acts, and that it does is what the stages say.
    """
    if not stages:
        return tuple(places)
    found = []
    for place in places:
        r = next(k for k, one in enumerate(measured.recordings) if one.name == place.recording)
        recording = measured.recordings[r]
        own = np.flatnonzero(measured.recording_of == r)
        compared = _along(measured, own, recording.time.size, measured.mask[own].any(axis=1).astype(float)) > 0.0
        same = [one for one in places if one.recording == place.recording and one.channel == place.channel]
        start, end = place.start, place.end
        for begins, ends in intervals(stages, place.recording):
            begins, ends = max(begins, 0.0), min(ends, float(recording.time[-1]))
            if not any(begins <= one.start < place.start for one in same) and begins <= place.start < ends:
                skipped = compared & (recording.time >= begins) & (recording.time < start)
                start = begins if skipped.sum() * recording.time_step <= UNSEEN else start
            if not any(place.end < one.end <= ends for one in same) and begins < place.end <= ends:
                skipped = compared & (recording.time > end) & (recording.time <= ends)
                end = ends if skipped.sum() * recording.time_step <= UNSEEN else end
        found.append(replace(place, start=start, end=end))
    return tuple(found)


def visited(measured: Measured, action: Action) -> Visited:
    """The law of an effect as it acted: its force over the leading channel, its jump over the rate before, its error.

    A jump is given over the rate after the event without the effect. At most MOST_POINTS samples, evenly chosen.
    """
    size = _relative(measured, action).sum(axis=1)
    lead = measured.identification.leads[0].channel
    unit = measured.unit_of(lead)
    inside = np.asarray(measured.mask.all(axis=1))
    inside[:, :-1] &= inside[:, 1:]
    inside[:, -1] = False
    amount, rate = action.amount.sum(axis=1), action.motion.rate
    step = measured.time_steps[:, None]
    at, over, at_unit = action.motion.coordinate, lead.replace("_", " "), unit
    if action.kind == "error":
        compared = measured.channels[measured.lead]
        what, value = f"error of {compared.replace('_', ' ')}", action.amount[:, measured.lead]
        of_value = measured.unit_of(compared)
    elif share_at_events(size, action.event) >= MOSTLY:
        inside &= action.event
        without = np.roll(rate, -1, axis=1) - amount
        value = amount / np.where(np.abs(without) > ROUNDING, without, np.inf)
        what, of_value, at, over, at_unit = "relative change of the rate", "1", rate, "rate before", f"{unit} s-1"
    else:
        inside &= ~action.event
        what, value, of_value = "force over inertia", amount / step, f"{unit} s-2"
    x, y = at[inside], value[inside]
    some = slice(None, None, max(1, -(-x.size // MOST_POINTS)))
    return Visited(action.effect, over, x[some], at_unit, what, y[some], of_value)


def _relative(measured: Measured, action: Action) -> FloatArray:
    """The size of the action (W, C, N): of impulses as they are, less rounding; of errors over the noise."""
    size = np.abs(action.amount)
    if action.kind == "error":
        size = size / measured.sigma[..., None]
    else:
        size = np.where(size > ROUNDING * float(np.max(np.abs(action.motion.rate))), size, 0.0)
    return np.where(measured.mask, size, 0.0)


def _turned(measured: Measured, c: int) -> str:
    """The coordinate that a force listed under a compared channel acts on, whether it was recorded or not."""
    leads = [lead.channel for lead in measured.identification.leads if measured.standing_for(lead.channel) == c]
    return leads[0] if leads else measured.channels[c]


def _unit(measured: Measured, action: Action, channel: str, at_events: bool) -> str:
    """Of an error as its channel has it, of a force or an impulse over the inertia of the coordinate it turns."""
    if action.kind == "error":
        return measured.unit_of(channel)
    unit = measured.unit_of(measured.identification.leads[0].channel)
    return f"{unit} s-1" if at_events else f"{unit} s-2"


def _along(measured: Measured, own: NDArray[np.intp], samples: int, values: FloatArray) -> FloatArray:
    """Values (n, N) of the windows ``own`` along their recording (samples,), zero outside of them."""
    line = np.zeros(samples)
    for k, w in enumerate(own):
        window = measured.windows[w]
        line[window.first : window.first + window.samples] = values[k, : window.samples]
    return line


def _runs(acting: NDArray[np.bool_], compared: NDArray[np.bool_], time_step: float) -> Sequence[tuple[int, int]]:
    """First and last sample of every stretch, over short pauses and gaps between windows."""
    found: list[tuple[int, int]] = []
    for k in np.flatnonzero(acting).tolist():
        if found:
            pause = compared[found[-1][1] + 1 : k]
            if pause.sum() * time_step <= PAUSE:
                found[-1] = (found[-1][0], k)
                continue
        found.append((k, k))
    return found


def _chains(events: NDArray[np.intp], acting: NDArray[np.bool_]) -> Sequence[tuple[int, int]]:
    """First and last sample of every chain of acting events that leaves out no two events in a row."""
    found: list[tuple[int, int]] = []
    missed = 0
    for k in events.tolist():
        if not acting[k]:
            missed += 1
            continue
        if found and missed < 2:
            found[-1] = (found[-1][0], k)
        else:
            found.append((k, k))
        missed = 0
    return found
