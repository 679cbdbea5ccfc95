"""The missing force as a model: of several laws in a table the one that predicts recordings left out in turn.

Errors that were estimated without the law hold part of what it does, and a law estimated under them is too small and
too smooth. So it is estimated as if the sensors' errors were white, too, and then under errors estimated with it in.
What is missing may act for a while in each recording only (`diagnosis.search.for_a_while`): then what was named, which
took it to act always, is left out. Or it has a frequency of its own (`diagnosis.search.driven`). A law of time itself
is not among them: no other recording could be predicted. What was named and does nothing beside the law is left out.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from diagnosis.errors.model import Errors, refitted
from diagnosis.search.driven import with_oscillator
from diagnosis.search.for_a_while import asking, exact, gain
from diagnosis.search.found import MISSING
from diagnosis.search.left_out import WORSE, error_left_out
from diagnosis.search.refit import Explanation, without
from diagnosis.search.spells import ALWAYS, InEach, Interval, in_spell
from diagnosis.search.tables import Law, estimate, form_of
from diagnosis.search.weighing import as_white_noise

TURNS = 3
"""Of estimating a law in its intervals, and asking each recording for them given the law."""


def missing_law(
    explanation: Explanation, base: Explanation, errors: Errors, lasts: Callable[[], bool] = lambda: True
) -> Law | None:
    """The law that the explanation lacks, of four ways the one that predicts; ``base``: without what was named.

    ``errors``: of the recordings without it. With one recording there is nothing to predict: under the errors as they
    are. Further ways are left out once the work no longer ``lasts``.
    """
    as_they_are = estimate(explanation)
    if np.unique(explanation.measured.recording_of).size < 2:
        return as_they_are
    best, error = _better(as_they_are, None, np.inf)
    if lasts():
        best, error = _better(estimate(_as_white(explanation, errors), errors), best, error)
    named = _left_out(explanation)
    error = min(error, named)  # what was named gives way only to what predicts better than it
    if not lasts():
        return best
    plain = _as_white(base, errors)
    best, error = _better(for_a_while(plain, errors), best, error)
    if lasts():
        best, error = _better(driven(plain, errors), best, error)
    return best if best is None or not lasts() else _beside_what_acts(best, explanation, errors, named)


def _beside_what_acts(law: Law, explanation: Explanation, errors: Errors, named: float) -> Law:
    """The law without the effects that do nothing beside it, if it predicts better than they do alone (``named``).

    A rung is no effect beside it.
    """
    found = law.explanation
    if found.fitted.misfit.predictor.rung is not None:
        return law
    idle = [c for c in found.removable if without(found, c).loss - found.loss < MISSING]
    for candidate in idle:
        explanation = without(explanation, candidate)
    alone = estimate(_as_white(explanation, errors), errors) if idle else None
    return law if alone is None or WORSE * _left_out(alone.explanation) >= named else alone


def _better(law: Law | None, best: Law | None, error: float) -> tuple[Law | None, float]:
    """The better of two laws with its error; the one tried first, the simpler one, where they are alike."""
    left = np.inf if law is None else _left_out(law.explanation)
    return (law, left) if WORSE * left < error else (best, error)


def driven(explanation: Explanation, errors: Errors) -> Law | None:
    """The law with an oscillator that the base drives beside its tables; None where that is not worth it.

    Tables are chosen under errors estimated with the oscillator in: before, they would do what it does.
    """
    swinging = with_oscillator(explanation)
    if swinging is None:
        return None
    fitted, _ = refitted(swinging.fitted, errors.base, errors, rounds=1)
    return estimate(replace(swinging, fitted=fitted))


def _as_white(explanation: Explanation, errors: Errors) -> Explanation:
    return replace(explanation, fitted=as_white_noise(explanation.fitted, errors))


def for_a_while(explanation: Explanation, errors: Errors) -> Law | None:
    """The law that acts in one interval of each recording, those that ask for it; None without one, and of walls.

    Begins with the run of windows in which the explanation misses most.
    """
    m = explanation.measured
    form = form_of(m.model)
    # runs through whole recordings cannot be cut at an instant; carried states make every estimate cost minutes
    if form is None or m.stretches is not None or m.identification.carrying:
        return None
    missed = explanation.fitted.window_losses - m.count
    intervals = [asking(m, r, missed, 0.0) for r in range(len(m.recordings))]
    best: Law | None = None
    for _ in range(TURNS):
        law = _in_intervals(explanation, form.name, intervals)
        if law is None or (best is not None and law.explanation.loss >= best.explanation.loss):
            break
        best, f = law, law.explanation.fitted
        gained = gain(f.frozen, form.name, {f"{form.name}.{k}": v for k, v in form.nulls.items()}, f.states)
        asked = [asking(m, r, gained, MISSING) for r in range(len(m.recordings))]
        if asked == intervals:
            break
        intervals = asked
    if best is None:
        return None
    f = best.explanation.fitted
    intervals = [exact(f.frozen, form.name, f.states, r, interval) for r, interval in enumerate(intervals)]
    if all(interval == ALWAYS for interval in intervals):
        return estimate(explanation, errors)
    return _in_intervals(explanation, form.name, intervals, errors)


def _in_intervals(
    explanation: Explanation, mechanism: str, intervals: Sequence[Interval], errors: Errors | None = None
) -> Law | None:
    f = explanation.fitted
    acting = in_spell(f.misfit, mechanism, InEach(tuple(intervals)))
    return estimate(replace(explanation, fitted=replace(f, misfit=acting)), errors)


def _left_out(explanation: Explanation) -> float:
    """Rms of the relative error of recordings that are left out in turn."""
    squares = [error_left_out(explanation, r) ** 2 for r in np.unique(explanation.measured.recording_of)]
    return float(np.sqrt(np.mean(squares)))
