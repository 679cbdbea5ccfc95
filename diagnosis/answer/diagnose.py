"""The whole chain: calibration, screen, selection, tests, location, held-out comparison, statement."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from diagnosis.answer.constancy import Judged, judged
from diagnosis.answer.experiment import next_experiment
from diagnosis.answer.extrapolated import extrapolated
from diagnosis.answer.heldout import (
    Shown,
    as_far_as_followed,
    compare,
    fit_figures,
    horizons,
    traces_of,
    windows_of,
    worsens,
)
from diagnosis.answer.judgement import (
    contradicted,
    explains,
    p_of_effects,
    p_of_missing,
    undecided,
    unfit,
    verdict_of,
)
from diagnosis.answer.ladder import confirmed, other_model
from diagnosis.answer.located import located
from diagnosis.answer.missing_force import missing_force
from diagnosis.answer.posterior import posterior
from diagnosis.answer.ranges import beyond_ranges
from diagnosis.answer.rescale import over_peak, true_peak
from diagnosis.answer.result import Beyond, Diagnosis, Effect, Located, Rival, Screened, Visited
from diagnosis.answer.shows import shows
from diagnosis.answer.statement import statement
from diagnosis.answer.when import stages_of
from diagnosis.answer.whole_runs import with_runs_from_rest
from diagnosis.data.measured import Measured
from diagnosis.errors.model import calibrated
from diagnosis.errors.summary import summary
from diagnosis.fit.channels import added_by_channels
from diagnosis.fit.intervals import Estimate, settled
from diagnosis.fit.one_thread import one_thread
from diagnosis.fit.setup import as_recorded, measure
from diagnosis.progress import Progress, Stages, silent
from diagnosis.search import bootstrap as bootstrapping
from diagnosis.search.beginnings import alone, beside
from diagnosis.search.budget import ANSWER, ENDED, SEARCH, Budget
from diagnosis.search.candidates import absent, candidates
from diagnosis.search.found import Search, misfit_per_sample, rivals
from diagnosis.search.grown import beside_in_grown_windows, grown
from diagnosis.search.ladder import Climbed, climb, rungs
from diagnosis.search.law import missing_law
from diagnosis.search.refit import Explanation, gain_by_window
from diagnosis.search.select import first_effect, further_effects, take_best_single
from diagnosis.search.tables import Law
from diagnosis.search.variants import held_numbers, widened
from diagnosis.search.weighing import evidence
from grids.instruments import INSTRUMENTS
from grids.recordings.base import Recording
from grids.specimen import Specimen
from models.base import FloatArray


@one_thread
def diagnose(
    specimen: Specimen,
    training: Sequence[Recording],
    holdout: Sequence[Recording] = (),
    *,
    bootstrap: int = 0,
    progress: Progress = silent,
    seed: int = 0,
) -> Diagnosis:
    """What the model leaves out, from ``training``, shown on ``holdout``.

    ``bootstrap``: draws of a parametric bootstrap for the p-value (0: the score's null distribution).
    ``progress`` is called with (what is being done, share done). A KeyboardInterrupt during the search
    ends it: the answer holds what was found so far and has ``finished`` false. One after the search leaves
    out what the answer can do without (``skipped``); a second one is raised. Raises InputError.
    """
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
    except KeyboardInterrupt:
        finished = False
        if found.best is None:
            take_best_single(found)
    answer = _assemble(specimen, found, climbed, held, bootstrap, progress, seed, finished)
    answer = replace(answer, seen=tuple(str(one) for one in seen), instruments=known_instruments(specimen))
    return replace(answer, statement=statement(answer, measured.model))


def _assemble(
    specimen: Specimen,
    found: Search,
    climbed: Climbed | None,
    to_show: Measured | None,
    draws: int,
    progress: Progress,
    seed: int,
    finished: bool,
) -> Diagnosis:
    stages = Stages(stopped=not finished)
    measured = found.measured.undisturbed
    shown = [stages.needed(lambda: compare(found.base, found.chosen, measured, found.errors))]
    unexplained = not explains(shown[0])
    if unexplained:  # what a model says that explains nothing is no name
        found, climbed = replace(found, best=None, outside=None), None
        shown = [replace(shown[0], after=shown[0].before, point_after=shown[0].point_before)]
    chosen = found.chosen

    judging = found
    if climbed is not None and chosen.measured.parts_quickly:  # it was compared in windows that it need not follow
        judging = stages.needed(lambda: grown(found, chosen.measured.undisturbed, keep=False))
    constancy = judged(judging, unexplained, stages, progress)
    flagged = constancy.flagged
    near = rivals(found)
    progress("stating the errors", 0.87)
    errors = stages.needed(lambda: summary(judging.errors, measured))
    shown_with = chosen

    def of_held(explanation: Explanation, recordings: Measured, share: float) -> Shown:
        progress("before and after", share)
        return compare(found.base, explanation, recordings, found.errors)

    first_held = stages.needed(lambda: of_held(shown_with, to_show, 0.88)) if to_show else None
    against = contradicted(found, first_held) if first_held and climbed is None else None
    beyond: tuple[Beyond, ...] = ()
    if found.best is not None and climbed is None and not flagged:
        beyond = stages.optional("whether effects go beyond their ranges", lambda: beyond_ranges(found), tuple)
    far = () if unexplained else unfit(judging)
    doubted = bool(flagged) or errors.inadequacy.large or against is not None or bool(beyond) or bool(far)
    verdict = verdict_of(found, near, doubted, not unexplained, finished)
    gains = [climbed.gain] if climbed else stages.needed(lambda: evidence(found))
    p_value = p_of_missing(found, gains, errors.inadequacy, flagged, far, finished)
    if draws and finished and climbed is None:
        score_p = p_value
        p_value = stages.optional(
            "the bootstrap (the p-value is that of the score)",
            lambda: bootstrapping.p_value(specimen, found, draws, seed, progress),
            lambda: score_p,
        )
    law: Law | None = None
    if verdict == "not_in_library" and not unexplained:
        progress("the missing force as a model", 0.88)
        left = Budget(ANSWER, found.whole.began)

        def lasts() -> bool:
            if left.spent:
                found.not_tried["other laws in a table"] = ENDED
            return not left.spent

        law = stages.optional(
            "the missing force as a model", lambda: missing_law(chosen, found.base, found.errors, lasts), lambda: None
        )
    if law and to_show and worsens(chosen, law.explanation, to_show, found.errors):
        found.not_tried[law.mechanism.name] = "the tables that fit these recordings predict those held out worse"
        law = None
    final = law.explanation if law else chosen
    if law:
        gains = [gain for c, gain in zip(chosen.candidates, gains, strict=True) if c in final.candidates]
        near = [rival for rival in near if set(rival.replaced) <= set(final.names)]
        if not final.candidates:  # nothing is told of what the law replaced
            against, beyond = None, ()
        shown = [stages.needed(lambda: compare(found.base, final, measured, found.errors))]
    settled_at, effects, base = stages.optional(
        "the profile likelihood (the intervals are symmetric instead)",
        lambda: _estimates(found, final, gains, p_value, None if law else progress),
        lambda: _estimates(found, final, gains, p_value, None),
    )

    if settled_at.fitted.loss < final.fitted.loss:
        final = chosen = settled_at
        shown = [stages.needed(lambda: compare(found.base, final, measured, found.errors))]

    held = first_held
    if to_show and final is not shown_with:
        held = stages.needed(lambda: of_held(final, to_show, 0.95))
    if held:
        shown.append(held)
    missing = verdict != "nothing_missing" and (finished or bool(effects))
    train = fit_figures(shown[0], missing)
    held_fit = fit_figures(held, missing) if held else None

    explained = found.best is not None and verdict != "not_in_library"

    def places() -> tuple[tuple[Located, ...], tuple[Visited, ...]]:
        if climbed is not None:  # another base model acts everywhere
            return (), ()
        progress("where it acts", 0.97)
        return located(found.base, chosen if explained else None, found.errors, seed) if missing else ((), ())

    experiment, force = None, None
    if finished and verdict == "cannot_tell_apart":
        experiment = stages.optional(
            "the next experiment", lambda: next_experiment(found, near, specimen.places), lambda: None
        )
    if law:
        force = missing_force(found, law)

    def of_found() -> Mapping[str, FloatArray]:
        ended = [e.name for e in effects if e.stages and np.isfinite(e.stages[-1].ends)]
        return {} if climbed or unexplained else posterior(final.fitted, measured.model, ended, seed)

    drawn: Mapping[str, FloatArray] = stages.optional("samples of what was found", of_found, dict)
    acting = stages.optional("where it acts", places, lambda: ((), ()))
    answer = Diagnosis(
        verdict=verdict,
        statement="",
        effects=effects,
        rivals=tuple(Rival(r.candidate.name, r.candidate.effect_class, r.gap, " and ".join(r.replaced)) for r in near),
        located=acting[0],
        visited=acting[1],
        shows=shows(shown[0], explained, seed) if missing else (),
        constancy=flagged,
        detail=constancy.detail,
        train=train,
        holdout=held_fit,
        base=base,
        screen=_screened(climbed.before if climbed else found),
        null_band=found.null.band if found.null else 0.0,
        p_value=p_value,
        next_experiment=experiment,
        windows=tuple(w for k, s in enumerate(shown) for w in windows_of(s, k == 1)),
        traces=stages.optional(
            "runs from rest",
            lambda: with_runs_from_rest(specimen, shown, found.base, final),
            lambda: tuple(t for k, s in enumerate(shown) for t in traces_of(s, k == 1)),
        ),
        extrapolated=extrapolated(*shown) if held else (),
        prediction_horizon=stages.optional("prediction horizons", lambda: _horizons(shown, found.base, final), dict),
        missing_force=force,
        held_stages=held.held_stages if held else (),
        contradicted=against,
        beyond=beyond,
        unfit=far,
        other_model=other_model(climbed, final) if climbed else None,
        errors=errors,
        channels=stages.optional("what each channel adds", lambda: added_by_channels(final.fitted), dict),
        posterior=drawn,
        not_tried={**not_tried(found), **stages.failed},
        reference_peak=true_peak(chosen),
        provenance=_provenance(specimen, found, constancy, seed),
        finished=finished,
        undecided=undecided(found, p_value) if verdict == "nothing_missing" else None,
        unexplained=unexplained,
        suspicions={r.name: r.suspicions for s in shown for r in s.measured.recordings if r.suspicions},
    )
    return replace(answer, skipped=tuple(stages.skipped) if finished else ())


def known_instruments(specimen: Specimen) -> dict[str, Mapping[str, float]]:
    """What the instruments of the specimen do, as far as it is known."""
    return {name: values for name, values in specimen.mechanisms.items() if name in INSTRUMENTS}


def _estimates(
    found: Search, chosen: Explanation, gains: Sequence[float], p_missing: float | None, progress: Progress | None
) -> tuple[Explanation, tuple[Effect, ...], dict[str, Estimate]]:
    """Effects, strongest first, and base parameters; by profile likelihood with a ``progress`` to call.

    With the explanation that they are of: a profile may have found a better optimum.
    """
    if progress:
        progress("intervals", 0.9)
    named = [x.name for c in chosen.candidates for x in c.unknowns]
    fitted, values = settled(chosen.fitted, named if progress else ())
    chosen = replace(chosen, fitted=fitted)
    values, whole = widened(values, chosen, found), held_numbers(chosen, found.tried)
    chances = p_of_effects(found, gains, chosen.candidates)
    if len(chances) == 1 and p_missing is not None:  # of the one effect it may be the bootstrap's
        chances = [p_missing]
    effects, peak = [], true_peak(chosen)
    order = sorted(zip(chosen.candidates, gains, chances, strict=True), key=lambda entry: -entry[1])
    for candidate, gain, chance in order:
        parameters = {x.name.partition(".")[2]: values.pop(x.name) for x in candidate.unknowns}
        parameters |= {name.partition(".")[2]: whole[name] for name in candidate.held}
        parameters = over_peak(parameters, candidate, chosen.measured.reference_peak, peak)
        stages = stages_of(chosen, candidate)
        effects.append(Effect(candidate.name, candidate.effect_class, parameters, gain, chance, stages))
    tabulated = tuple(f"{name}." for name, m in chosen.measured.model.mechanisms.items() if m.tabulated)
    return chosen, tuple(effects), {name: value for name, value in values.items() if not name.startswith(tabulated)}


def _screened(found: Search) -> tuple[Screened, ...]:
    """The screen and its refits, all under the errors of the base model: later singles are those near the answer.

    A refit that explains less than the base model stayed in a valley that the base has left, and tells nothing.
    """
    found = found if found.shorter is None else found.shorter
    start = found if found.at_null is None else found.at_null
    fits = {e.candidates[0]: e for e in reversed(start.singles) if e.loss < start.base.loss}
    lines: dict[str, Screened] = {}
    for entry in found.scores:
        fit = fits.get(entry.candidate)
        estimate = None
        if fit is not None:
            own = {x.name for x in entry.candidate.unknowns}
            estimate = {k.partition(".")[2]: v for k, v in fit.fitted.values.items() if k in own}
        line = Screened(
            entry.candidate.name,
            entry.candidate.effect_class,
            entry.statistic,
            start.base.loss - fit.loss if fit else None,
            estimate,
        )
        if line.name not in lines or (line.gain or 0.0) > (lines[line.name].gain or 0.0):
            lines[line.name] = line
    return tuple(sorted(lines.values(), key=lambda s: -max(s.score, s.gain or 0.0)))


def not_tried(found: Search) -> dict[str, str]:
    """By mechanism: why it was not tried, or why not beside what was found."""
    never = absent(found.measured)
    return {**never, **found.not_tried}


def _horizons(shown: Sequence[Shown], before: Explanation, after: Explanation) -> dict[str, tuple[float, float]]:
    if before.measured.stretches is not None:  # predicted from rest to the end
        return {}
    predictors = (before.fitted.misfit.predictor, after.fitted.misfit.predictor)
    return {k: v for s in shown for k, v in horizons(s, *predictors).items()}


def _provenance(specimen: Specimen, found: Search, constancy: Judged, seed: int) -> Mapping[str, Any]:
    measured = found.measured
    gains, recordings = gain_by_window(found.base, found.chosen), list(enumerate(measured.recordings))
    tested = constancy.tested
    return {
        "specimen": specimen.title,
        "model": specimen.model,
        "model_version": measured.model.version,
        "recordings": [r.name for r in measured.recordings],
        "windows": len(measured.windows),
        "channels": list(measured.channels),
        "noise": {
            c: {"sigma": np.unique(measured.sigma[:, k]).tolist(), "unit": measured.unit_of(c)}
            for k, c in enumerate(measured.channels)
        },
        "misfit_per_sample": misfit_per_sample(found.chosen),
        "gain_by_recording": {r.name: float(gains[measured.recording_of == k].sum()) for k, r in recordings},
        "constancy_threshold": constancy.allowed,
        "largest_constancy": tested[0].statistic if tested else 0.0,
        "largest_constancy_of": f"{tested[0].kind} / {tested[0].depends_on}" if tested else "",
        "seed": seed,
    }
