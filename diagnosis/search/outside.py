"""Whether a law outside the library explains what one mechanism leaves better than any second mechanism.

Both are judged on the same linearised problem about the best single mechanism: the library by the
largest statistic of a second mechanism, the outside by that of a force of some kind that depends on
something (two degrees of freedom, `diagnosis.forces.constancy`). Two mechanisms that are in the library
have the second one's own direction among the first; a law of another kind has not.
"""

from __future__ import annotations

from collections.abc import Sequence

from diagnosis.forces.constancy import Constancy, flag
from diagnosis.search.found import Search
from diagnosis.search.refit import Explanation
from diagnosis.search.screen import Score

FACTOR = 1.2
MARGIN = 25.0
"""What an outside force must have over the library: this factor and this much more."""


def outside(found: Search, single: Explanation, seconds: Sequence[Score]) -> Constancy | None:
    """The force outside the library that gains more than any second mechanism, and by how much; None if none does."""
    if not single.measured.identification.forces:
        return None
    tested = found.tested(single).tested
    plain = {t.kind: t.statistic for t in tested if not t.depends_on}
    dependent = [(plain[t.kind] + t.statistic, t) for t in tested if t.depends_on]
    if not dependent:
        return None
    largest, test = max(dependent, key=lambda pair: pair[0])
    library = max((s.statistic for s in seconds), default=0.0)
    if largest < FACTOR * library + MARGIN:
        return None
    return flag(single.measured.identification, test, largest - library)
