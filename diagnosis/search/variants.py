"""Other whole numbers of the mechanisms found: the order of a filter, an exponent of hysteresis.

They are no continuous unknowns, so each choice is a candidate of its own, and no derivative says how well one is known.
The best explanation is fitted with every other choice: a likelier one takes its place, and the 95 % interval of such a
number holds all choices whose loss is within 3.84 of the least; the intervals of the other parameters are then those of
all these fits together. So they are with a lag beside a clock: one that is too short to be named, as every logger's
filter makes one, passes for a little of the clock's rate.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from diagnosis.fit.intervals import LEVEL, Estimate, estimates
from diagnosis.search.candidates import Candidate
from diagnosis.search.found import GAP, Search
from diagnosis.search.refit import QUICK, Explanation, again, extend, further


def with_other_numbers(found: Search) -> None:
    """Fit the best explanation with every other choice of its whole numbers; the likeliest is the best."""
    if (best := found.best) is None:
        return
    for k, candidate in enumerate(best.candidates):
        for other in _other_choices(candidate, found.candidates):
            if not found.affordable(f"another whole number of {candidate.name}"):
                return
            found.tried.append(_changed(best, k, other))
    found.tried.append(best)
    found.best = min([best, *variants(best, found.tried)], key=lambda e: e.loss)


def variants(explanation: Explanation, tried: Sequence[Explanation]) -> list[Explanation]:
    """Of those ``tried``: the same mechanisms, unknowns and times under the same errors with other whole numbers."""
    mine = _kind(explanation)
    whitening = explanation.fitted.misfit.whitening
    return [
        e for e in tried
        if _kind(e) == mine and _held(e) != _held(explanation) and e.fitted.misfit.whitening.sensor is whitening.sensor
    ]  # fmt: skip


def held_numbers(explanation: Explanation, tried: Sequence[Explanation]) -> dict[str, Estimate]:
    """The whole numbers of an explanation with the range of those that explain the recordings as well."""
    near = [explanation, *_near(explanation, tried)]
    found = {}
    for candidate in explanation.candidates:
        for name, value in candidate.held.items():
            chosen = [_held(e)[name] for e in near]
            unit = candidate.mechanism.parameter(name.partition(".")[2]).unit
            found[name] = Estimate(value, min(chosen), max(chosen), unit)
    return found


def widened(found: Mapping[str, Estimate], explanation: Explanation, search: Search) -> dict[str, Estimate]:
    """Estimates of an explanation, each interval with those of the variants that explain the recordings as well."""
    wider = dict(found)
    for other in [*_near(explanation, search.tried), *_lagging(explanation, search.candidates)]:
        theirs = estimates(other.fitted)
        for name, mine in wider.items():
            low, high = min(mine.low95, theirs[name].low95), max(mine.high95, theirs[name].high95)
            wider[name] = replace(mine, low95=low, high95=high)
    return wider


def _near(explanation: Explanation, tried: Sequence[Explanation]) -> list[Explanation]:
    """The best fit of every variant within the level of a 95 % interval."""
    best: dict[tuple[tuple[str, float], ...], Explanation] = {}
    for other in sorted(variants(explanation, tried), key=lambda e: e.loss):
        if other.loss - explanation.loss < LEVEL:
            best.setdefault(tuple(sorted(_held(other).items())), other)
    return list(best.values())


def _lagging(explanation: Explanation, candidates: Sequence[Candidate]) -> list[Explanation]:
    """The explanation with a lag of the responses beside a clock that has none."""
    in_a_table = explanation.fitted.misfit.smooth is not None
    if in_a_table or "clock" not in explanation.names or {"delay", "filter"} & {*explanation.names}:
        return []
    return [extend(explanation, lag, lag.null) for lag in candidates if lag.name == "delay" and lag.spell is None]


def _changed(best: Explanation, k: int, other: Candidate) -> Explanation:
    """The best explanation refitted with ``other`` in the place of its ``k``-th mechanism."""
    misfit = replace(best.fitted.misfit, fixed={**best.fitted.misfit.fixed, **other.held})
    grown = (*best.candidates[:k], other, *best.candidates[k + 1 :])
    tried = further(Explanation(grown, replace(best.fitted, misfit=misfit)), QUICK)
    return again(tried) if tried.loss < best.loss + GAP else tried


def _other_choices(candidate: Candidate, all_of_them: Sequence[Candidate]) -> list[Candidate]:
    """The candidates that differ from one in their whole numbers alone."""
    unknowns = [x.name for x in candidate.unknowns]
    return [
        other for other in all_of_them
        if other.name == candidate.name and [x.name for x in other.unknowns] == unknowns
        and other.held.keys() == candidate.held.keys() and other.held != candidate.held
    ]  # fmt: skip


def _kind(explanation: Explanation) -> list[tuple[object, ...]]:
    return [(c.name, tuple(x.name for x in c.unknowns), c.spell) for c in explanation.candidates]


def _held(explanation: Explanation) -> dict[str, float]:
    return {name: value for c in explanation.candidates for name, value in c.held.items()}
