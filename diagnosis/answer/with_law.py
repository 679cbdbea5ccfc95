"""A law in a table in the place of what is missing, and what is left of the answer beside it."""

from __future__ import annotations

from dataclasses import replace

from diagnosis.answer.heldout import compare, worsens
from diagnosis.answer.task import Task
from diagnosis.answer.verdict import Judgement
from diagnosis.search.budget import ANSWER, ENDED, Budget
from diagnosis.search.law import missing_law
from diagnosis.search.tables import Law


def with_law(task: Task, judged: Judgement) -> tuple[Judgement, Law | None]:
    """The law that a verdict of ``not_in_library`` asks for, if one predicts better than what was found."""
    if judged.verdict != "not_in_library" or judged.unexplained:
        return judged, None
    found, chosen, stages = judged.found, judged.final, task.stages
    task.progress("the missing force as a model", 0.88)
    left = Budget(ANSWER, found.whole.began)

    def lasts() -> bool:
        if left.spent:
            found.not_tried["other laws in a table"] = ENDED
        return not left.spent

    law = stages.optional(
        "the missing force as a model", lambda: missing_law(chosen, found.base, found.errors, lasts), lambda: None
    )
    if law is None:
        return judged, None
    if task.held and worsens(chosen, law.explanation, task.held, found.errors):
        found.not_tried[law.mechanism.name] = "the tables that fit these recordings predict those held out worse"
        return judged, None
    final = law.explanation
    told = replace(
        judged,
        final=final,
        gains=[gain for c, gain in zip(chosen.candidates, judged.gains, strict=True) if c in final.candidates],
        near=[rival for rival in judged.near if set(rival.replaced) <= set(final.names)],
        shown=stages.needed(lambda: compare(found.base, final, found.measured.undisturbed, found.errors, judged.shown)),
        unfit=(),  # of what the law replaced or acts beside
    )
    if not final.candidates:  # nothing is told of what the law replaced
        told = replace(told, against=None, beyond=())
    return told, law
