"""When exactly a spell begins and ends: its likelihood over instants, everything but the windows around held.

Given the parameters the windows are independent, so moving one end of a spell changes the windows around it only. They
are refitted (states alone) for instants side by side. Between two events at which it acts an effect's instant is not
told by any recording: the likelihood has flat stretches, and the estimate is the median of the instants weighed by it.
A change point's likelihood ratio is no chi-squared; its 95 % quantile is -2 log(1 - sqrt .95) = 7.35 (Hansen,
Econometrica 68, 575-603, 2000).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from diagnosis.data.measured import Measured
from diagnosis.fit.misfit import Misfit
from diagnosis.fit.solver import fit_together
from diagnosis.search.refit import Explanation
from diagnosis.search.spells import Spell, in_spell
from models.base import FloatArray

LEVEL = 7.35
FINE, COARSE = 0.04, 4
"""s between the instants that are tried, where they are likely; elsewhere every fourth one."""
MOST = 20
"""Instants that are tried where they are likely."""
AROUND = 1
"""Windows on either side of the one in which a spell begins or ends that are searched."""
ITERATIONS = 4
WHOLE = 3.84
"""Loss that an instant within a recording must take off a spell that begins or ends with one, which is simpler."""
NO_UNKNOWNS = np.zeros(0)


@dataclass(frozen=True)
class Instant:
    """An end of a spell: the time (s) in ``recording`` with its 95 % interval; None: the recording's own end."""

    recording: int
    time: float | None
    low95: float | None = None
    high95: float | None = None


@dataclass(frozen=True)
class Ends:
    """Both ends of a spell."""

    begins: Instant
    ends: Instant

    @property
    def spell(self) -> Spell:
        return Spell(self.begins.recording, self.begins.time, self.ends.recording, self.ends.time)


def ends_of(explanation: Explanation, mechanism: str, spell: Spell) -> Ends:
    """Both ends of the spell of one of the explanation's mechanisms, each the likeliest while the other is held."""
    return ends_in(explanation.fitted.frozen, explanation.fitted.states, mechanism, spell)


def ends_in(misfit: Misfit, states: FloatArray, mechanism: str, spell: Spell) -> Ends:
    """The same under a misfit in which nothing is unknown; what acts from the first start, or to the last end, does."""
    begins, ends = Instant(spell.first, None), Instant(spell.last, None)
    if (spell.first, spell.begins) != (0, None):
        begins = _end(misfit, states, mechanism, spell, True)
        spell = spell.beginning(begins.recording, begins.time)
    if (spell.last, spell.ends) != (len(misfit.measured.recordings) - 1, None):
        ends = _end(misfit, states, mechanism, spell, False)
    return Ends(begins, ends)


def ends_within(misfit: Misfit, states: FloatArray, mechanism: str, spell: Spell) -> Ends:
    """The same of a spell within one recording, which may begin in its first window and end in its last."""
    begins = _end(misfit, states, mechanism, spell, True, within=True)
    spell = spell.beginning(begins.recording, begins.time)
    return Ends(begins, _end(misfit, states, mechanism, spell, False, within=True))


def _end(
    misfit: Misfit, states: FloatArray, mechanism: str, spell: Spell, begin: bool, within: bool = False
) -> Instant:
    m = misfit.measured
    at = _window_at(m, spell, begin)
    windows = np.arange(max(at - AROUND, 0), min(at + AROUND, len(m.windows) - 1) + 1)
    if within:
        windows = windows[m.recording_of[windows] == spell.first]
    part = misfit.of_windows(windows)
    moved = [(spell.beginning if begin else spell.ending)(*instant) for instant in _instants(m, windows, begin)]
    moved = [one for one in moved if not one.empty]

    def losses(some: Sequence[Spell]) -> FloatArray:
        acting = [in_spell(part, mechanism, one) for one in some]
        return np.array([one.loss for one in fit_together(acting, NO_UNKNOWNS, states[windows], ITERATIONS)])

    coarse = [k for k, one in enumerate(moved) if k % COARSE == 0 or _whole(one, begin)]
    loss = losses([moved[k] for k in coarse])
    least = float(loss.min())
    plain = [(value, k) for value, k in zip(loss.tolist(), coarse, strict=True) if _whole(moved[k], begin)]
    if plain and min(plain)[0] < least + WHOLE:
        return Instant(_recording(moved[min(plain)[1]], begin), None)
    likely = [k for value, k in zip(loss, coarse, strict=True) if value < least + LEVEL]
    between = moved[max(0, likely[0] - COARSE) : likely[-1] + COARSE + 1]
    stride = -(-len(between) // MOST)
    fine = [one for one in between[::stride] if not _whole(one, begin)]
    loss = losses(fine)
    weight = np.cumsum(np.exp(-0.5 * (loss - loss.min())))
    middle = fine[int(np.searchsorted(weight, 0.5 * weight[-1]))]
    recording, best = _recording(middle, begin), _time(middle, begin)
    same = [
        _time(one, begin) for value, one in zip(loss, fine, strict=True)
        if value < loss.min() + LEVEL and _recording(one, begin) == recording
    ]  # fmt: skip
    return Instant(recording, best, max(0.0, min([*same, best]) - stride * FINE), max([*same, best]) + stride * FINE)


def _whole(spell: Spell, begin: bool) -> bool:
    """Whether a spell begins or ends with a recording."""
    return (spell.begins if begin else spell.ends) is None


def _recording(spell: Spell, begin: bool) -> int:
    return spell.first if begin else spell.last


def _time(spell: Spell, begin: bool) -> float:
    """The instant (s) at which a spell begins or ends within a recording."""
    time = spell.begins if begin else spell.ends
    return 0.0 if time is None else time


def _window_at(m: Measured, spell: Spell, begin: bool) -> int:
    """The first window that ends after the instant; of a recording's own end the next recording's first one."""
    recording, time = (spell.first, spell.begins) if begin else (spell.last, spell.ends)
    limit = np.inf if time is None and not begin else 0.0 if time is None else time
    for k, window in enumerate(m.windows):
        end = (window.first + window.samples) * m.recordings[window.recording].time_step
        if window.recording > recording or (window.recording == recording and end > limit):
            return k
    return len(m.windows) - 1


def _instants(m: Measured, windows: NDArray[np.int64], begin: bool) -> Sequence[tuple[int, float | None]]:
    """Instants (recording, s) in order: within the windows and the gaps after them, and between recordings."""
    found: list[tuple[int, float | None]] = []
    for w in windows.tolist():
        window = m.windows[w]
        step = m.recordings[window.recording].time_step
        start = window.first * step
        if w == 0 or m.windows[w - 1].recording != window.recording:
            if begin:
                found.append((window.recording, None))
            elif window.recording > 0:
                found.append((window.recording - 1, None))
        follows = w + 1 < len(m.windows) and m.windows[w + 1].recording == window.recording
        end = (m.windows[w + 1].first if follows else window.first + window.samples) * step
        found += [(window.recording, round(time, 6)) for time in np.arange(start, end, FINE).tolist()]
    last = int(windows[-1])
    if not begin and (last + 1 == len(m.windows) or m.recording_of[last + 1] != m.recording_of[last]):
        found.append((int(m.recording_of[last]), None))
    return found
