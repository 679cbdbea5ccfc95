"""The answer put together from what was found, judged and estimated."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from diagnosis.answer.constancy import Judged
from diagnosis.answer.estimates import estimated
from diagnosis.answer.experiment import next_experiment
from diagnosis.answer.extrapolated import extrapolated
from diagnosis.answer.heldout import Shown, compare, fit_figures, horizons, traces_of, windows_of
from diagnosis.answer.judgement import undecided
from diagnosis.answer.ladder import other_model
from diagnosis.answer.located import located
from diagnosis.answer.missing_force import missing_force
from diagnosis.answer.posterior import posterior
from diagnosis.answer.rescale import true_peak
from diagnosis.answer.result import Diagnosis, Effect, Located, Rival, Screened, Visited
from diagnosis.answer.shows import shows
from diagnosis.answer.task import Task
from diagnosis.answer.verdict import Judgement, judge, shown_on_held
from diagnosis.answer.whole_runs import with_runs_from_rest
from diagnosis.answer.with_law import with_law
from diagnosis.fit.channels import added_by_channels
from diagnosis.fit.intervals import Estimate
from diagnosis.search.candidates import absent
from diagnosis.search.found import Near, Search, misfit_per_sample
from diagnosis.search.ladder import Climbed
from diagnosis.search.refit import Explanation, gain_by_window
from grids.specimen import Specimen
from models.base import FloatArray
from study.provenance import program


def assemble(task: Task, found: Search, climbed: Climbed | None) -> Diagnosis:
    """The answer to a search but for its statement."""
    before, law = with_law(task, judge(task, found, climbed))
    judged, effects, base = _estimated(task, before, by_profile=law is None)
    found, climbed, final, stages = judged.found, judged.climbed, judged.final, task.stages
    shown = [judged.shown, *([judged.held] if judged.held else [])]
    missing = judged.verdict != "nothing_missing" and (task.finished or bool(effects))
    explained = found.best is not None and judged.verdict != "not_in_library"
    experiment = None
    if task.finished and judged.verdict == "cannot_tell_apart":
        experiment = stages.optional(
            "the next experiment",
            lambda: next_experiment(found, judged.near, task.specimen.places),
            lambda: None,
        )
    drawn: Mapping[str, FloatArray] = stages.optional(
        "samples of what was found", lambda: _samples(task, judged, effects), dict
    )
    acting = stages.optional(
        "where it acts",
        lambda: _places(task, judged, final if explained else None) if missing else ((), ()),
        lambda: ((), ()),
    )
    answer = Diagnosis(
        verdict=judged.verdict,
        statement="",
        effects=effects,
        rivals=tuple(_rival(r) for r in judged.near),
        located=acting[0],
        visited=acting[1],
        shows=shows(judged.shown, explained, task.seed) if missing else (),
        constancy=judged.constancy.flagged,
        detail=judged.constancy.detail,
        train=fit_figures(judged.shown, missing),
        holdout=fit_figures(judged.held, missing) if judged.held else None,
        base=base,
        screen=screened(climbed.before if climbed else found),
        null_band=found.null.band if found.null else 0.0,
        p_value=judged.p_value,
        next_experiment=experiment,
        windows=tuple(w for k, s in enumerate(shown) for w in windows_of(s, k == 1)),
        traces=stages.optional(
            "runs from rest",
            lambda: with_runs_from_rest(task.specimen, shown, found.base, final),
            lambda: tuple(t for k, s in enumerate(shown) for t in traces_of(s, k == 1)),
        ),
        extrapolated=extrapolated(*shown) if judged.held else (),
        prediction_horizon=stages.optional("prediction horizons", lambda: _horizons(shown, found.base, final), dict),
        missing_force=missing_force(found, law, stages) if law else None,
        held_stages=judged.held.held_stages if judged.held else (),
        contradicted=judged.against,
        beyond=judged.beyond,
        unfit=judged.unfit,
        other_model=other_model(climbed, final) if climbed else None,
        errors=judged.errors,
        channels=stages.optional("what each channel adds", lambda: added_by_channels(final.fitted), dict),
        posterior=drawn,
        not_tried={k: why for k, why in {**absent(found.measured), **found.not_tried}.items() if k not in final.names},
        reference_peak=true_peak(final),
        provenance=_provenance(task.specimen, found, judged.constancy, task.seed),
        finished=task.finished,
        undecided=undecided(found, judged.p_value) if judged.verdict == "nothing_missing" else None,
        unexplained=judged.unexplained,
        suspicions={r.name: r.suspicions for s in shown for r in s.measured.recordings if r.suspicions},
    )
    return replace(answer, skipped=tuple(stages.skipped) if task.finished else (), failed=dict(stages.failed))


def _estimated(
    task: Task, judged: Judgement, by_profile: bool
) -> tuple[Judgement, tuple[Effect, ...], Mapping[str, Estimate]]:
    """Effects and base parameters, and the answer shown with them where a profile has found a better optimum."""
    found, final, stages = judged.found, judged.final, task.stages
    settled, effects, base = stages.optional(
        "the profile likelihood (the intervals are symmetric instead)",
        lambda: estimated(found, final, judged.gains, judged.p_value, task.progress if by_profile else None),
        lambda: estimated(found, final, judged.gains, judged.p_value, None),
    )
    if settled.fitted.loss < final.fitted.loss:
        measured = found.measured.undisturbed
        shown = stages.needed(lambda: compare(found.base, settled, measured, found.errors, judged.shown))
        judged = replace(judged, final=settled, shown=shown)
    if judged.final is not found.chosen:
        judged = replace(judged, held=shown_on_held(task, found, judged.final, 0.95, judged.held))
    return judged, effects, base


def _rival(near: Near) -> Rival:
    return Rival(near.candidate.name, near.candidate.effect_class, near.gap, " and ".join(near.replaced))


def _places(
    task: Task, judged: Judgement, explained: Explanation | None
) -> tuple[tuple[Located, ...], tuple[Visited, ...]]:
    """Where what is missing acts; None without an answer that explains the recordings."""
    if judged.climbed is not None:  # another base model acts everywhere
        return (), ()
    task.progress("where it acts", 0.97)
    return located(judged.found.base, explained, judged.found.errors, task.seed)


def _samples(task: Task, judged: Judgement, effects: Sequence[Effect]) -> Mapping[str, FloatArray]:
    if judged.climbed or judged.unexplained:
        return {}
    ended = [e.name for e in effects if e.stages and np.isfinite(e.stages[-1].ends)]
    return posterior(judged.final.fitted, judged.found.measured.model, ended, task.seed)


def screened(found: Search) -> tuple[Screened, ...]:
    """The lines of the screen with the gains of its refits, the strongest first.

    All under the errors of the base model: later singles are those near the answer.
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
        **program(),
    }
