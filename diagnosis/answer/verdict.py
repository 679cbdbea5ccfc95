"""Whether what a search found holds: what speaks against it, its p-value and the verdict."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from diagnosis.answer.constancy import Judged, judged
from diagnosis.answer.heldout import Shown, compare
from diagnosis.answer.judgement import (
    contradicted,
    explains,
    far_from_noise,
    p_of_doubts,
    p_of_missing,
    unfit_windows,
    verdict_of,
)
from diagnosis.answer.ranges import beyond_ranges
from diagnosis.answer.result import Beyond, Unfit, Verdict
from diagnosis.answer.task import Task
from diagnosis.errors.summary import ErrorModel, summary
from diagnosis.search import bootstrap as bootstrapping
from diagnosis.search.evidence import evidence
from diagnosis.search.found import Near, Search, rivals
from diagnosis.search.grown import grown
from diagnosis.search.ladder import Climbed
from diagnosis.search.refit import Explanation


@dataclass(frozen=True)
class Judgement:
    """What was ``found`` and what it amounts to.

    ``final``: the explanation that is told, a law in a table in the place of what is missing included; ``climbed``: the
    step to another base model; ``shown`` on the recordings learned from and ``held`` on those held out; ``near`` the
    rivals and ``gains`` of the effects; ``against``, ``beyond``, ``unfit``: predictions that got worse, ranges that are
    too narrow, windows far from the noise; ``unexplained``: nothing explains more than it leaves.
    """

    found: Search
    final: Explanation
    climbed: Climbed | None
    shown: Shown
    held: Shown | None
    constancy: Judged
    errors: ErrorModel
    near: Sequence[Near]
    gains: Sequence[float]
    against: tuple[float, float] | None
    beyond: tuple[Beyond, ...]
    unfit: tuple[Unfit, ...]
    verdict: Verdict
    p_value: float | None
    unexplained: bool


def judge(task: Task, found: Search, climbed: Climbed | None) -> Judgement:
    """The verdict on a search."""
    stages, progress = task.stages, task.progress
    measured = found.measured.undisturbed
    shown = stages.needed(lambda: compare(found.base, found.chosen, measured, found.errors))
    unexplained = not explains(shown)
    if unexplained:  # what a model says that explains nothing is no name
        found, climbed = replace(found, best=None, outside=None), None
        shown = replace(shown, after=shown.before, point_after=shown.point_before)
    chosen = found.chosen
    judging = found
    if climbed is not None and chosen.measured.parts_quickly:  # it was compared in windows that it need not follow
        judging = stages.needed(lambda: grown(found, chosen.measured.undisturbed, keep=False))
    constancy = judged(judging, unexplained, stages, progress)
    near = rivals(found)
    progress("stating the errors", 0.87)
    errors = stages.needed(lambda: summary(judging.errors, measured))
    held = shown_on_held(task, found, chosen, 0.88)
    against = contradicted(found, held) if held and climbed is None else None
    beyond: tuple[Beyond, ...] = ()
    if found.best is not None and climbed is None and not constancy.flagged:
        beyond = stages.optional("whether effects go beyond their ranges", lambda: beyond_ranges(found), tuple)
    unfit = () if unexplained else stages.needed(lambda: unfit_windows(judging))
    doubts = (constancy.flagged, errors.inadequacy.large, against is not None, beyond, far_from_noise(unfit))
    verdict = verdict_of(found, near, any(map(bool, doubts)), not unexplained, task.finished)
    gains = [climbed.gain] if climbed else stages.needed(lambda: evidence(found))
    p_value = p_of_missing(found, gains, errors.inadequacy, constancy.flagged, unfit, task.finished)
    doubtful = p_of_doubts(found, errors.inadequacy, constancy.flagged, unfit)
    if task.draws and task.finished and climbed is None and (gains or not doubtful):
        score_p = p_value
        p_value = stages.optional(
            "the bootstrap (the p-value is that of the score)",
            lambda: min([bootstrapping.p_value(task.specimen, found, task.draws, task.seed, progress), *doubtful]),
            lambda: score_p,
        )
    return Judgement(
        found=found, final=chosen, climbed=climbed, shown=shown, held=held, constancy=constancy, errors=errors,
        near=near, gains=gains, against=against, beyond=beyond, unfit=unfit, verdict=verdict, p_value=p_value,
        unexplained=unexplained,
    )  # fmt: skip


def shown_on_held(
    task: Task, found: Search, explanation: Explanation, share: float, known: Shown | None = None
) -> Shown | None:
    """An explanation on the recordings held out, if there are any; ``known``: as of another explanation."""
    held = task.held
    if held is None:
        return None

    def compared() -> Shown:
        task.progress("before and after", share)
        return compare(found.base, explanation, held, found.errors, known)

    return task.stages.needed(compared)
