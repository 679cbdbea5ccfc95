"""When an effect acts that does not always act: stages in the recordings learned from and held out, in words."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np

from diagnosis.answer.result import EffectStage, HeldStage
from diagnosis.fit.misfit import Misfit
from diagnosis.search.candidates import Candidate
from diagnosis.search.for_a_while import asking, exact, gain
from diagnosis.search.found import MISSING
from diagnosis.search.instants import Instant, ends_of
from diagnosis.search.refit import Explanation
from diagnosis.search.spells import LASTS, InEach, Interval, When
from diagnosis.search.tables import form_of
from grids.stages import Stage
from models.base import FloatArray
from models.errors import InputError

Spans = list[tuple[float, float]]


def merged(spans: Sequence[tuple[float, float]]) -> Spans:
    """The same times as intervals that do not touch, in order."""
    found: Spans = []
    for begin, end in sorted(spans):
        if found and begin <= found[-1][1]:
            found[-1] = (found[-1][0], max(end, found[-1][1]))
        else:
            found.append((begin, end))
    return found


def stages_of(explanation: Explanation, candidate: Candidate) -> tuple[EffectStage, ...]:
    """The stages of one of the explanation's effects with intervals of their instants; none of one that always acts."""
    spell = candidate.spell
    if spell is None:
        return ()
    names = [r.name for r in explanation.measured.recordings]
    stages = [EffectStage(one.recording, one.begins, one.ends) for one in spell.stages(names)]
    for part in spell.parts:
        if not part.instants:
            continue
        try:
            ends = ends_of(explanation, candidate.name, part)
        except InputError:  # it acts in whole recordings only
            break
        if part.begins is not None and (interval := _interval(ends.begins, part.first, part.begins)):
            stages[part.first] = replace(stages[part.first], begins_low95=interval[0], begins_high95=interval[1])
        if part.ends is not None and (interval := _interval(ends.ends, part.last, part.ends)):
            stages[part.last] = replace(stages[part.last], ends_low95=interval[0], ends_high95=interval[1])
    return tuple(stages)


def _interval(instant: Instant, recording: int, estimate: float) -> tuple[float, float] | None:
    """The 95 % interval, which holds the estimate that the parameters were fitted with; None in another recording."""
    if instant.low95 is None or instant.high95 is None or instant.recording != recording:
        return None
    return min(instant.low95, estimate), max(instant.high95, estimate)


def may_change_again(spell: When, recordings: int) -> bool:
    """Whether nothing is known of later recordings: what came and went, or changed from one recording to the next.

    What begins within a recording and is there to the end has happened to the specimen, and stays.
    """
    if isinstance(spell, InEach):
        return True
    begins = spell.begins is not None or spell.first > 0
    return begins and (spell.begins is None or spell.ends is not None or spell.last < recordings - 1)


def held_stages(explanation: Explanation, misfit: Misfit, states: FloatArray) -> tuple[HeldStage, ...]:
    """How each effect with stages is predicted in other recordings, those of ``misfit`` (nothing unknown in it).

    An effect that may change again acts in the run of windows that asks for it there by more than MISSING and the price
    of a spell, or not at all; any other one as after the last recording learned from.
    """
    learned = len(explanation.measured.recordings)
    found: list[HeldStage] = []
    for candidate in explanation.candidates:
        if candidate.spell is None:
            continue
        own = may_change_again(candidate.spell, learned)
        acts = candidate.spell.stages([r.name for r in explanation.measured.recordings])[-1].ends == LASTS
        nulls = {x.name: x.value(float(u)) for x, u in zip(candidate.unknowns, candidate.null, strict=True)}
        gained = gain(misfit, candidate.name, nulls, states) if own else np.zeros(0)
        for r, recording in enumerate(misfit.measured.recordings):
            begins, ends = (0.0, LASTS) if acts else (0.0, 0.0)
            if own:
                asked = asking(misfit.measured, r, gained, MISSING + _price_of_one(candidate))
                begins, ends = _exact(misfit, candidate.name, states, r, asked)
            found.append(HeldStage(candidate.name, recording.name, begins, ends, own))
    return (*found, *_of_law(explanation, misfit, states))


def _exact(misfit: Misfit, mechanism: str, states: FloatArray, r: int, interval: Interval) -> Interval:
    """`exact`, or whole windows where the run of a specimen cannot be cut within one."""
    try:
        return exact(misfit, mechanism, states, r, interval)
    except InputError:
        return interval


def _price_of_one(candidate: Candidate) -> float:
    """What the choice of one interval costs, where each recording has its own."""
    return candidate.price / (len(candidate.spell.intervals) if isinstance(candidate.spell, InEach) else 1)


def _of_law(explanation: Explanation, misfit: Misfit, states: FloatArray) -> Iterator[HeldStage]:
    """The same of a law in a table that acts for a while in each recording: where one asks for it."""
    m = misfit.measured
    form = form_of(m.model)
    if form is None or form.name not in explanation.fitted.misfit.predictor.stages:
        return
    gained = gain(misfit, form.name, {f"{form.name}.{name}": null for name, null in form.nulls.items()}, states)
    for r, recording in enumerate(m.recordings):
        interval = _exact(misfit, form.name, states, r, asking(m, r, gained, MISSING))
        yield HeldStage(form.name, recording.name, *interval, True)


def as_stages(held: Sequence[HeldStage]) -> Mapping[str, tuple[Stage, ...]]:
    """The stages of recordings held out by effect."""
    names = dict.fromkeys(one.effect for one in held)
    return {
        name: tuple(Stage(one.recording, one.begins, one.ends) for one in held if one.effect == name) for name in names
    }


def when_text(stages: Sequence[EffectStage]) -> str:
    """In which part of the sequence of recordings an effect acts, as in "from 4.2 s (3.9 to 4.4 s) of b on"."""
    acting = [one for one in stages if one.ends > one.begins]
    if not acting:
        return ""
    if _interrupted(stages):
        return "in each recording for a while: " + " and ".join(
            f"from {_instant(one.begins, one.begins_low95, one.begins_high95)} to "
            f"{'the end' if one.ends == LASTS else _instant(one.ends, one.ends_low95, one.ends_high95)} "
            f"of {one.recording}" for one in acting
        )  # fmt: skip
    first, last = acting[0], acting[-1]
    begins = first.begins > 0.0 or first is not stages[0]
    ends = last.ends < LASTS or last is not stages[-1]
    start = _instant(first.begins, first.begins_low95, first.begins_high95)
    end = _instant(last.ends, last.ends_low95, last.ends_high95)
    if first is last and first.begins == 0.0 and last.ends == LASTS and len(stages) > 1 and ends:
        return f"in {first.recording} only"
    if first is last and first.begins > 0.0 and last.ends < LASTS:
        return f"from {start} to {end} of {first.recording} only"
    opening = f"from {start} of {first.recording}" if first.begins > 0.0 else f"from {first.recording} on"
    closing = f"to {end} of {last.recording}" if last.ends < LASTS else f"to the end of {last.recording}"
    if not ends:
        return f"{opening} and stays" if first.begins == 0.0 else f"{opening} on, and stays"
    return f"{opening} {closing}" if begins else f"until {closing.removeprefix('to ')}, and is gone then"


def _interrupted(stages: Sequence[EffectStage]) -> bool:
    """Whether it acts in more than one spell of the sequence."""
    acting = [k for k, one in enumerate(stages) if one.ends > one.begins]
    goes_on = (
        b == a + 1 and stages[a].ends == LASTS and stages[b].begins == 0.0
        for a, b in pairwise(acting)
    )  # fmt: skip
    return not all(goes_on)


def comes_and_goes(stages: Sequence[Mapping[str, Any]]) -> list[str]:
    """When a law in a table acts that comes and goes in each recording; ``stages`` as in `missing_force`."""
    parts = []
    for one in stages:
        until = "the end" if one["ends"] == LASTS else f"{one['ends']:.1f} s"
        if one["ends"] > one["begins"]:
            parts.append(f"from {one['begins']:.1f} s to {until} of {one['recording']}")
    return [f"It comes and goes in each recording: it acts {' and '.join(parts)}."] if parts else []


def _instant(time: float, low: float | None, high: float | None) -> str:
    return f"{time:.1f} s" if low is None or high is None else f"{time:.1f} s ({low:.1f} to {high:.1f} s)"


def held_text(held: Sequence[HeldStage]) -> list[str]:
    """In which state the recordings held out are predicted."""
    said = []
    for one in held:
        name = one.effect.replace("_", " ")
        if not one.found_there:
            state = "as after the last recording learned from" + ("" if one.ends > one.begins else ", without it")
        elif one.ends <= one.begins:
            state = "without it, for nothing asks for it there"
        else:
            until = "its end" if one.ends == LASTS else f"{one.ends:.1f} s"
            state = f"with it from {one.begins:.1f} s to {until}, the interval found there"
        said.append(f"{one.recording} is predicted {state} ({name}).")
    return said
