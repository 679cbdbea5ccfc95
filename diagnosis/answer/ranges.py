"""Effects that would explain more beyond the range of the library: what they are named for is something else.

A parameter at the end of its range is released: its unknown u, from the null u0 on, may go to u0 + 2 (u1 - u0), with u1
that end, and all others are refitted. Where that gains as much as one more effect must bring, the size is not one that
the library takes for possible: a law outside it that acts in a place, on a side or for a while is the usual reason.
"""

from __future__ import annotations

from dataclasses import replace

from diagnosis.answer.result import Beyond
from diagnosis.fit.solver import fit
from diagnosis.fit.unknowns import Unknown
from diagnosis.search.candidates import Candidate
from diagnosis.search.found import Search
from diagnosis.search.refit import Explanation
from models.errors import InputError

FARTHER = 2.0
"""Where a released parameter may go, over the distance of the end of its range from its null."""


def beyond_ranges(found: Search) -> tuple[Beyond, ...]:
    """Those of the best explanation's effects that need more than their range."""
    chosen = found.chosen
    tested = [_beyond(chosen, candidate) for candidate in chosen.candidates]
    return tuple(one for one in tested if one is not None and one.evidence >= found.more)


def _beyond(chosen: Explanation, candidate: Candidate) -> Beyond | None:
    """What releasing the first parameter of an effect gains; None where it is not at the end of its range."""
    fitted, own = chosen.fitted, candidate.unknowns[0]
    index = [x.name for x in fitted.misfit.unknowns].index(own.name)
    side = fitted.at_bound(index)
    end = own.bounds[side == "high"]
    if not side or own.kind == "inverse" or end == candidate.null[0]:
        return None
    unknowns = list(fitted.misfit.unknowns)
    unknowns[index] = _released(own, candidate.null[0] + FARTHER * (end - candidate.null[0]))
    try:
        freed = fit(replace(fitted.misfit, unknowns=tuple(unknowns)), fitted.u, fitted.states)
    except InputError:  # nothing has that size
        return None
    limit, wanted = own.value(end), own.value(float(freed.u[index]))
    return Beyond(candidate.name, own.name.partition(".")[2], limit, wanted, own.unit, fitted.loss - freed.loss)


def _released(unknown: Unknown, to: float) -> Unknown:
    value = unknown.value(to)
    return replace(unknown, low=min(unknown.low, value), high=max(unknown.high, value))
