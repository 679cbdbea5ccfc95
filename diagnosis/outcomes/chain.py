"""The chain for outcomes: base, where it is wrong, which mechanism repairs it, what cannot be told apart, checks."""

from __future__ import annotations

import numpy as np

import models
from diagnosis.fit.one_thread import one_thread
from diagnosis.fit.unknowns import of_specimen
from diagnosis.outcomes.answer import OutcomeDiagnosis
from diagnosis.outcomes.assembly import assemble
from diagnosis.outcomes.bank import Drawn, Spread, filled
from diagnosis.outcomes.candidates import repairs
from diagnosis.outcomes.ladder import Ladder
from diagnosis.outcomes.search import CLOSER, CLOSER_ROUNDS, FIRST, MOST, Search, one_more
from diagnosis.progress import Progress, silent
from grids.recordings.outcomes import Outcomes
from grids.specimen import Specimen
from models.base import FloatArray
from models.errors import InputError

FEWEST = 10
"""Runs, and of those that overturned and stood at least two, below which nothing is diagnosed."""


@one_thread
def diagnose_outcomes(
    specimen: Specimen, outcomes: Outcomes, *, seed: int = 0, progress: Progress = silent
) -> OutcomeDiagnosis:
    """What the model leaves out, from runs of which is known only whether the specimen overturned.

    A KeyboardInterrupt ends the search; the answer holds what was found until then. Raises InputError.
    """
    flags = _usable(outcomes)
    model = models.get(specimen.model)
    rng = np.random.default_rng(seed)
    ladder = Ladder.of(model, specimen, outcomes.motions)
    unknowns = of_specimen(specimen, model)
    progress("predicting the runs with the base model", 0.02)
    closer = [CLOSER] * CLOSER_ROUNDS
    first: list[Drawn] = [(Spread(unknowns), FIRST if unknowns else 1)]
    base = filled(ladder, unknowns, flags, [first, *closer] if unknowns else [first], rng)
    found = Search(specimen, outcomes, ladder, base)
    possible, found.not_tried = repairs(model, specimen, outcomes.motions)
    try:
        while len(found.steps) < MOST and one_more(found, possible, flags, rng, progress):
            pass
    except KeyboardInterrupt:
        found.finished = False
    return assemble(found, flags, rng, progress)


def _usable(outcomes: Outcomes) -> FloatArray:
    if outcomes.overturned is None:
        raise InputError(f"{outcomes.name}: says of no run whether it overturned; name the column in 'overturned'")
    fell = int(outcomes.overturned.sum())
    if outcomes.size < FEWEST or min(fell, outcomes.size - fell) < 2:
        raise InputError(
            f"{outcomes.name}: {outcomes.size} runs, {fell} overturned: at least {FEWEST} runs are needed, and two of "
            "either outcome"
        )
    if len(set(outcomes.groups)) < 2:
        raise InputError(
            f"{outcomes.name}: all {outcomes.size} runs are of one group, '{outcomes.groups[0]}'; an answer is checked "
            "on groups that it has not learned from: give runs of two ground motions or more"
        )
    return outcomes.overturned.astype(np.float64)
