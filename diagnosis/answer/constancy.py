"""Whether what was found holds everywhere: the tests for constancy, and what of them flags an answer."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from diagnosis.answer.grown import grown
from diagnosis.data.measured import Measured
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


def judged(
    found: Search, unexplained: bool, other_model: bool, whole: Measured, stages: Stages, progress: Progress
) -> Judged:
    """The tests of what was found; ``unexplained``: nothing was, ``other_model``: it stands on another base model.

    In its own windows, from window to window, and where trajectories part in windows of ``whole`` that grow with it:
    each asked where those before found nothing.
    """

    def of_chosen() -> About:
        progress("testing constancy", 0.85)
        return found.tested(found.chosen)

    def of_grown() -> About:
        progress("testing constancy in windows that grow with what was found", 0.86)
        again = grown(found, whole)
        return again.tested(again.chosen)

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
    grows = whole.parts_quickly and found.best is not None and not other_model
    if declares and grows and not flagged and not unexplained:
        further: About | None = stages.optional("windows that grow with what was found", of_grown, lambda: None)
        if further and (flagged := further.flags(allowed)):
            tested = further.tested
    return Judged(tested, flagged, None if flagged or unexplained else detail, allowed)


def _about_the_fit(found: Search) -> Errors:
    """The errors estimated anew about what was found: it may have gone on since they were."""
    return estimate(found.chosen.fitted, found.errors.base, found.errors)
