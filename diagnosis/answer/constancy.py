"""Whether what was found holds everywhere: the tests for constancy, and what of them flags an answer."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from diagnosis.errors.model import Errors, estimate
from diagnosis.forces.constancy import About, Constancy, Tested, flags
from diagnosis.forces.varying import varying
from diagnosis.progress import Progress, Stages
from diagnosis.search.details import least
from diagnosis.search.found import Search


@dataclass(frozen=True)
class Judged:
    """``tested``: all tests; ``flagged``: what is not constant, beyond ``allowed``; ``detail``: what is allowed."""

    tested: Sequence[Tested]
    flagged: tuple[Constancy, ...]
    detail: Constancy | None
    allowed: float


def judged(found: Search, unexplained: bool, stages: Stages, progress: Progress) -> Judged:
    """The tests of what was found; ``unexplained``: nothing was.

    In its own windows, from window to window, and in windows that have grown with it: each where those before found
    nothing.
    """

    def of_chosen() -> About:
        progress("testing constancy", 0.85)
        return found.tested(found.chosen)

    declares = bool(found.measured.identification.forces)
    allowed = stages.needed(lambda: least(found, found.chosen))
    tested: Sequence[Tested] = []
    flagged: tuple[Constancy, ...] = ()
    detail: Constancy | None = None
    if declares:
        about = stages.needed(of_chosen)
        tested = about.tested
        flagged = () if unexplained else about.flags(allowed)
        detail = next(iter(about.flags(found.more)), None)
    if found.outside is not None:
        flagged = (found.outside, *(f for f in flagged if f.parameter != found.outside.parameter))
    if found.blow is not None:
        flagged = (found.blow, *flagged)
    if declares and not flagged and not unexplained:
        changing: list[Tested] = stages.optional(
            "whether it changes", lambda: varying(about.forces, _about_the_fit(found), allowed), list
        )
        flagged = flags(about.forces, changing, allowed)
    if found.longer is not None and not flagged and not unexplained:
        further = found.longer.tested(found.longer.chosen)
        if flagged := further.flags(allowed):
            tested = further.tested
    return Judged(tested, flagged, None if flagged or unexplained else detail, allowed)


def _about_the_fit(found: Search) -> Errors:
    """The errors estimated anew about what was found: it may have gone on since they were."""
    return estimate(found.chosen.fitted, found.errors.base, found.errors)
