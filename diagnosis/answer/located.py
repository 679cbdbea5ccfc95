"""Where what is missing acts: named effects along the fitted motion; without a name, where something must be added."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diagnosis.answer.acts import acts, visited, within_stages
from diagnosis.answer.phases import EVERYWHERE
from diagnosis.answer.result import Located, Visited
from diagnosis.errors.model import Errors
from diagnosis.fit.solver import Fitted
from diagnosis.forces.action import action
from diagnosis.forces.columns import forces
from diagnosis.forces.scan import Missing, missing
from diagnosis.search.refit import Explanation


def located(
    base: Explanation, explained: Explanation | None, errors: Errors, seed: int = 0
) -> tuple[tuple[Located, ...], tuple[Visited, ...]]:
    """Intervals by effect, recording and channel, the largest share first, and the laws found over what was visited.

    ``explained``: an adequate model; without one there are no laws. Then the scatter of events among the ``errors``
    about the base model may be what a wrong law of them leaves, and the scan takes events to repeat.
    """
    if base.measured.stretches is not None:  # no run can be cut at a sample to see what acts there
        return (), ()
    if explained is not None:
        fitted = explained.fitted
        actions = [action(fitted.misfit.predictor, fitted.point, name) for name in explained.names]
        stages = fitted.misfit.predictor.stages
        places = tuple(
            place
            for one in actions
            for place in within_stages(fitted.measured, acts(fitted.measured, one), stages.get(one.effect, ()))
        )
        return places, tuple(visited(fitted.measured, one) for one in actions)
    if not base.measured.identification.forces:
        return (), ()
    fitted = replace(base.fitted, misfit=errors.repeating(base.fitted.misfit))
    found = missing(forces(fitted), seed)
    return (() if found is None else _without_a_name(fitted, found)), ()


def _without_a_name(fitted: Fitted, found: Missing) -> tuple[Located, ...]:
    """The windows in which a force, an impulse or an error must be added; a share by their number."""
    m = fitted.measured
    declared = m.identification
    at = next((kind.event for kind in declared.forces if kind.name == found.kind), "")
    between = declared.separation.between if declared.separation is not None else EVERYWHERE
    words = [at or between] if found.kind else [] if found.word else [EVERYWHERE]
    words += [found.word] if found.word else []
    low, high = found.windows or (0, len(m.windows) - 1)
    chosen = np.arange(low, high + 1)
    places = []
    for r, recording in enumerate(m.recordings):
        own = chosen[m.recording_of[chosen] == r]
        if own.size:
            first, last = m.windows[own[0]], m.windows[own[-1]]
            start, end = first.first * recording.time_step, (last.first + last.samples) * recording.time_step
            channel = declared.leads[0].channel
            places.append(Located(recording.name, channel, start, end, tuple(words), own.size / chosen.size))
    return tuple(sorted(places, key=lambda place: -place.share))
