"""When a mechanism acts: from an instant, to an instant, in some recordings only.

    [[mechanisms.restitution.stages]]
    recording = "shake_2"
    begins = 4.21                 # s from the start of the recording; default 0
    ends = inf                    # s; default inf: to the end of the recording, and afterwards

In a recording that stages name the mechanism acts in their intervals alone (``begins = ends``: not at all). In any
other recording, in studies and under other motions it is as after the last stage: it acts if that one ends with inf.
Without stages it always acts. The order of stages is that of the tests.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from grids.files import Schema
from grids.units import to_si
from models.errors import InputError

if TYPE_CHECKING:
    from grids.specimen import Specimen

ALWAYS = ((-math.inf, math.inf),)
Mechanisms = Mapping[str, Mapping[str, float]]


class StageTable(Schema):
    recording: str
    begins: float | str = 0.0
    ends: float | str = math.inf


@dataclass(frozen=True)
class Stage:
    """An interval (s) of a recording in which a mechanism acts."""

    recording: str
    begins: float = 0.0
    ends: float = math.inf


def read_stages(name: str, tables: Sequence[StageTable]) -> tuple[Stage, ...]:
    """The stages of mechanism ``name``, checked. Raises InputError."""
    found: list[Stage] = []
    for number, table in enumerate(tables, 1):
        where = f"[[mechanisms.{name}.stages]] {number}"
        begins, ends = (
            to_si(value, "s", f"{where} {key}") for key, value in (("begins", table.begins), ("ends", table.ends))
        )
        if not 0.0 <= begins < math.inf:
            raise InputError(f"{where}: begins = {begins:g} s; give a time in the recording, 0 or later.")
        if ends < begins:
            raise InputError(f"{where}: it ends ({ends:g} s) before it begins ({begins:g} s); swap them.")
        earlier = [one for one in found if one.recording == table.recording]
        if earlier and begins < earlier[-1].ends:
            raise InputError(
                f"{where}: it begins ({begins:g} s) before the stage before it in '{table.recording}' ends "
                f"({earlier[-1].ends:g} s); give stages in their order, without overlap."
            )
        found.append(Stage(table.recording, begins, ends))
    return tuple(found)


def intervals(stages: Sequence[Stage], recording: str | None) -> tuple[tuple[float, float], ...]:
    """In which times (s) of a recording a mechanism with these stages acts; ``recording`` None: of any other motion."""
    named = [one for one in stages if one.recording == recording]
    if named:
        return tuple((one.begins, one.ends) for one in named if one.ends > one.begins)
    return ALWAYS if not stages or stages[-1].ends == math.inf else ()


def changes(
    names: Collection[str], stages: Mapping[str, Sequence[Stage]], recording: str | None
) -> list[tuple[float, frozenset[str]]]:
    """From which time (s, the first 0) on which mechanisms of ``names`` act in a recording."""
    acting = {name: intervals(stages.get(name, ()), recording) for name in names}
    ends = {end for spans in acting.values() for span in spans for end in span if 0.0 < end < math.inf}
    return [
        (time, frozenset(name for name, spans in acting.items() if any(a <= time < b for a, b in spans)))
        for time in (0.0, *sorted(ends))
    ]


def stretches(specimen: Specimen, recording: str | None) -> list[tuple[float, Mechanisms]]:
    """From which time (s, the first 0) on which mechanisms of a specimen act in a recording, with their values."""
    return [
        (time, {name: values for name, values in specimen.mechanisms.items() if name in acting})
        for time, acting in changes(specimen.mechanisms.keys(), specimen.stages, recording)
    ]


def first_sample(time: float, time_step: float) -> int:
    """The first sample at or after an instant (s)."""
    return math.ceil(time / time_step - 1e-9)


def after_the_last(specimen: Specimen) -> Specimen:
    """The specimen as after the last stages: the state for studies and other motions."""
    return replace(specimen, mechanisms=stretches(specimen, None)[0][1], stages={})
