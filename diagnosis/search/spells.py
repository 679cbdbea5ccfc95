"""When an effect acts that does not always act: one spell in the sequence of recordings, or an interval in each.

A spell runs from an instant of one recording, or its start, to an instant of the same or a later one, or to the end of
that one, in the order of the tests. What begins and stays, what ends, what acts in some recordings only and what comes
and goes once are all spells; one that lasts to the end of the last recording goes on afterwards. What comes and goes in
every test, a strap that tightens or a guide that engages, has an interval of its own in each recording.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from diagnosis.data.measured import Measured
from diagnosis.fit.misfit import Misfit
from grids.stages import Stage

LASTS = float("inf")
Interval = tuple[float, float]
"""Begin and end (s); an end of infinity is the recording's own, twice 0 is never."""
NEVER: Interval = (0.0, 0.0)
ALWAYS: Interval = (0.0, LASTS)


@dataclass(frozen=True)
class Spell:
    """From ``begins`` (s; None: the start) of recording ``first`` to ``ends`` (s; None: the end) of ``last``."""

    first: int
    begins: float | None
    last: int
    ends: float | None

    def stages(self, names: Sequence[str]) -> tuple[Stage, ...]:
        """As stages of the recordings of these names."""
        found = []
        for k, name in enumerate(names):
            begins = self.begins if k == self.first and self.begins is not None else 0.0
            ends = self.ends if k == self.last and self.ends is not None else LASTS
            acts = self.first <= k <= self.last and ends > begins
            found.append(Stage(name, begins, ends) if acts else Stage(name, *NEVER))
        return tuple(found)

    def beginning(self, recording: int, time: float | None) -> Spell:
        """The same with another beginning."""
        return replace(self, first=recording, begins=time)

    def ending(self, recording: int, time: float | None) -> Spell:
        """The same with another end."""
        return replace(self, last=recording, ends=time)

    @property
    def instants(self) -> int:
        """How many instants within a recording it has."""
        return (self.begins is not None) + (self.ends is not None)

    @property
    def parts(self) -> tuple[Spell, ...]:
        return (self,)

    @property
    def empty(self) -> bool:
        if self.first != self.last:
            return self.first > self.last
        return self.begins is not None and self.ends is not None and self.ends <= self.begins


@dataclass(frozen=True)
class InEach:
    """One interval (s) in each recording."""

    intervals: tuple[Interval, ...]

    def stages(self, names: Sequence[str]) -> tuple[Stage, ...]:
        """As stages of the recordings of these names."""
        return tuple(Stage(name, *interval) for name, interval in zip(names, self.intervals, strict=True))

    @property
    def instants(self) -> int:
        """How many instants within a recording it has."""
        return sum((begins > 0.0) + (ends < LASTS) for begins, ends in self.intervals if ends > begins)

    @property
    def is_spell(self) -> bool:
        """Whether it has instants in fewer than two recordings: one spell of the sequence says as much."""
        return sum(one not in (NEVER, ALWAYS) for one in self.intervals) < 2

    @property
    def parts(self) -> tuple[Spell, ...]:
        """Each recording in which it acts, as a spell."""
        return tuple(
            Spell(r, begins or None, r, ends if ends < LASTS else None)
            for r, (begins, ends) in enumerate(self.intervals)
            if ends > begins
        )


When = Spell | InEach


def interval_of(measured: Measured, low: int, high: int) -> Interval:
    """The interval of one recording that holds its windows ``low`` to ``high`` and no other."""
    first, last = measured.windows[low], measured.windows[high]
    step = measured.recordings[first.recording].time_step
    opens = low == 0 or measured.windows[low - 1].recording != first.recording
    closes = high + 1 == len(measured.windows) or measured.windows[high + 1].recording != last.recording
    return 0.0 if opens else first.first * step, LASTS if closes else (last.first + last.samples) * step


def of_windows(measured: Measured, low: int, high: int) -> Spell:
    """The spell that holds the windows ``low`` to ``high`` (in the order of the recordings) and no other."""
    first, last = measured.windows[low], measured.windows[high]

    def seconds(window: int) -> float:
        cutout = measured.windows[window]
        return float(cutout.first * measured.recordings[cutout.recording].time_step)

    opens = low == 0 or measured.windows[low - 1].recording != first.recording
    closes = high + 1 == len(measured.windows) or measured.windows[high + 1].recording != last.recording
    return Spell(
        first.recording, None if opens else seconds(low), last.recording, None if closes else seconds(high + 1)
    )


def holds(measured: Measured, spell: When, window: int) -> bool:
    """Whether a spell holds the whole of a window."""
    cutout = measured.windows[window]
    recording = measured.recordings[cutout.recording]
    stage = spell.stages([r.name for r in measured.recordings])[cutout.recording]
    first, last = (k * recording.time_step for k in (cutout.first, cutout.first + cutout.samples - 1))
    return stage.begins <= first and last <= stage.ends


def in_spell(misfit: Misfit, mechanism: str, spell: When | None) -> Misfit:
    """The misfit with a mechanism that acts in its spell alone; None: always."""
    predictor = misfit.predictor
    stages = {name: one for name, one in predictor.stages.items() if name != mechanism}
    if spell is not None:
        stages[mechanism] = spell.stages([r.name for r in predictor.measured.recordings])
    return replace(misfit, predictor=replace(predictor, stages=stages))
