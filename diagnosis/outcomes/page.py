"""``report.html`` of outcomes: one page that opens anywhere, without a network."""

from __future__ import annotations

from collections.abc import Mapping

import models
from diagnosis.fit.unknowns import library
from diagnosis.outcomes.answer import OutcomeDiagnosis, Wrong
from diagnosis.outcomes.measures import SHOWN
from diagnosis.report import words
from diagnosis.report.page import environment
from diagnosis.report.svg import Picture
from grids.specimen import Specimen

HEADLINES = {
    "missing": "Something is missing from the model: {names}",
    "cannot_tell_apart": "Something is missing from the model: {names}, or a rival",
    "not_in_library": "Something is missing that is not in the library",
    "nothing_missing": "Nothing is missing that the outcomes could show",
}
MEANINGS = {measure.symbol: measure.meaning for measure in SHOWN}


def headline(answer: OutcomeDiagnosis) -> str:
    """The answer in a line."""
    names = words.listed(words.plain(effect.name) for effect in answer.effects)
    if not answer.finished:
        return f"Stopped early; found so far: {names}" if names else "Stopped before anything was found"
    return HEADLINES[answer.verdict].format(names=names)


def report_page(answer: OutcomeDiagnosis, specimen: Specimen, drawn: Mapping[str, Picture]) -> str:
    """The page as text, with the pictures ``drawn``; nothing in it is computed anew."""
    known = library(models.get(specimen.model))
    return (
        environment()
        .get_template("outcomes.html.j2")
        .render(
            d=answer,
            specimen=specimen,
            headline=headline(answer),
            effects=[
                (one, known[one.name].says({name: value.estimate for name, value in one.parameters.items()}))
                for one in answer.effects
            ],
            fell=int(answer.overturned.sum()),
            crossed=[one for one in answer.compared if one.cross_validated],
            before=[_row(one) for one in answer.wrong],
            after=[_row(one) for one in answer.left],
            group_count=len(set(answer.groups)),
            pictures={name: picture.page() for name, picture in drawn.items()},
        )
    )


def _row(one: Wrong) -> dict[str, str]:
    ends = "" if one.low is None or one.high is None else (
        f"{words.quantity(one.low, one.unit)} to {words.quantity(one.high, one.unit)}"
    )  # fmt: skip
    return {
        "over": one.over,
        "meaning": MEANINGS.get(one.over, ""),
        "ends": ends,
        "did": f"{one.wrong} of {one.runs} {'overturned' if one.predicted == 'stands' else 'stood'}",
        "predicted": one.predicted,
        "score": f"{one.standard_score:+.1f}".replace("-", "−"),
    }
