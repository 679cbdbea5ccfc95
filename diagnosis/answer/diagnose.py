"""The whole chain: calibration, screen, selection, tests, location, held-out comparison, statement."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from diagnosis.answer.assembly import assemble
from diagnosis.answer.heldout import as_far_as_followed
from diagnosis.answer.ladder import confirmed
from diagnosis.answer.result import Diagnosis
from diagnosis.answer.statement import statement
from diagnosis.answer.task import Task
from diagnosis.answer.unconfirmed import unless_unconfirmed
from diagnosis.data.twice import refuse_twice
from diagnosis.errors.model import calibrated
from diagnosis.fit.one_thread import one_thread
from diagnosis.fit.setup import as_recorded, measure
from diagnosis.progress import Progress, Stages, silent
from diagnosis.search.beginnings import alone, beside
from diagnosis.search.budget import SEARCH, Budget
from diagnosis.search.candidates import candidates
from diagnosis.search.found import Search
from diagnosis.search.grown import beside_in_grown_windows
from diagnosis.search.ladder import Climbed, climb, rungs
from diagnosis.search.refit import Explanation
from diagnosis.search.select import first_effect, further_effects, take_best_single
from grids.given import recordings_of, specimen_of
from grids.instruments import INSTRUMENTS
from grids.recordings.base import Recording
from grids.specimen import Specimen


@one_thread
def diagnose(
    specimen: Specimen | str | Path,
    training: Sequence[Recording | str | Path],
    holdout: Sequence[Recording | str | Path] = (),
    *,
    bootstrap: int = 0,
    progress: Progress = silent,
    seed: int = 0,
) -> Diagnosis:
    """What the model leaves out, from ``training``, shown on ``holdout``; files of either may be named.

    ``bootstrap``: draws of a parametric bootstrap for the p-value (0: the score's null distribution).
    ``progress`` is called with (what is being done, share done). A KeyboardInterrupt during the search
    ends it: the answer holds what was found so far and has ``finished`` false. One after the search leaves
    out what the answer can do without (``skipped``); a second one is raised. Raises InputError.
    """
    specimen, training, holdout = specimen_of(specimen), recordings_of(training), recordings_of(holdout)
    refuse_twice(training, holdout)
    progress("calibrating the base model and the errors of the recordings", 0.02)
    whole = Budget(SEARCH)
    specimen, seen = as_recorded(specimen, [*training, *holdout])
    measured = measure(specimen, training)
    held = measure(specimen, holdout, measured.reference_peak) if holdout else None  # refused before the search
    fitted, errors = calibrated(specimen, measured, seed)
    held = as_far_as_followed(held, fitted) if held else None
    found = Search(Explanation((), fitted), candidates(measured, specimen), errors, whole=whole)
    climbed: Climbed | None = None
    finished = True
    try:
        for stage in first_effect(found, progress):
            found = stage
        tried = rungs(found, specimen, holdout, seed, progress)
        climbed = confirmed(climb(found, tried, decisive=True), held)
        if climbed is None:
            for more in (alone, further_effects, beside):
                for stage in more(found, progress):
                    found = stage
            climbed = confirmed(climb(found, tried, decisive=False), held)
        if climbed is not None:
            found = climbed.after
        else:
            for stage in beside_in_grown_windows(found, measured, progress):
                found = stage
            found = unless_unconfirmed(found, held)
    except KeyboardInterrupt:
        finished = False
        if found.best is None:
            take_best_single(found)
    stages = Stages(stopped=not finished)
    answer = assemble(Task(specimen, held, bootstrap, progress, seed, finished, stages), found, climbed)
    answer = replace(answer, seen=tuple(str(one) for one in seen), instruments=known_instruments(specimen))
    return replace(answer, statement=statement(answer, measured.model))


def known_instruments(specimen: Specimen) -> dict[str, Mapping[str, float]]:
    """What the instruments of the specimen do, as far as it is known."""
    return {name: values for name, values in specimen.mechanisms.items() if name in INSTRUMENTS}
