"""When an effect acts that does not always act: one spell in the sequence of recordings, in the order of the tests.

A spell runs from an instant of one recording, or its start, to an instant of the same or a later one, or to the end of
that one. What begins and stays, what ends, what acts in some recordings only and what comes and goes are all spells;
one that lasts to the end of the last recording goes on afterwards.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from diagnosis.data.measured import Measured
from diagnosis.fit.misfit import Misfit
from grids.stages import Stage

NOT_AT_ALL = 0.0


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
            ends = self.ends if k == self.last and self.ends is not None else float("inf")
            acts = self.first <= k <= self.last and ends > begins
            found.append(Stage(name, begins, ends) if acts else Stage(name, NOT_AT_ALL, NOT_AT_ALL))
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
    def empty(self) -> bool:
        if self.first != self.last:
            return self.first > self.last
        return self.begins is not None and self.ends is not None and self.ends <= self.begins


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


def holds(measured: Measured, spell: Spell, window: int) -> bool:
    """Whether a spell holds the whole of a window."""
    cutout = measured.windows[window]
    recording = measured.recordings[cutout.recording]
    stage = spell.stages([r.name for r in measured.recordings])[cutout.recording]
    first, last = (k * recording.time_step for k in (cutout.first, cutout.first + cutout.samples - 1))
    return stage.begins <= first and last <= stage.ends


def in_spell(misfit: Misfit, mechanism: str, spell: Spell | None) -> Misfit:
    """The misfit with a mechanism that acts in its spell alone; None: always."""
    predictor = misfit.predictor
    stages = {name: one for name, one in predictor.stages.items() if name != mechanism}
    if spell is not None:
        stages[mechanism] = spell.stages([r.name for r in predictor.measured.recordings])
    return replace(misfit, predictor=replace(predictor, stages=stages))
