"""The screen against white noise: errors about a model hold much of what it lacks, scatter of events a law of them.

Asked for by the search for what always acts and by that for what begins; made once for a fit and its errors.
"""

from __future__ import annotations

from collections.abc import Sequence

from diagnosis.fit.linearisation import Linearisation, linearise_about
from diagnosis.search.candidates import Candidate
from diagnosis.search.found import Search, WhiteScreen
from diagnosis.search.refit import Explanation
from diagnosis.search.screen import Score, score
from diagnosis.search.weighing import as_white_noise


def against_white_noise(
    found: Search, start: Explanation, candidates: Sequence[Candidate]
) -> tuple[Linearisation, list[Score]]:
    """The problem linearised about ``start`` as if the sensors' errors were white, and these mechanisms' scores."""
    known, wanted = found.white, frozenset(candidates)
    if known is None or known.of is not start.fitted or known.errors is not found.errors or wanted - known.candidates:
        screen = linearise_about(as_white_noise(start.fitted, found.errors))
        known = WhiteScreen(start.fitted, found.errors, wanted, screen, score(screen, candidates))
        found.white = known
    return known.screen, [one for one in known.scores if one.candidate in wanted]
