"""The whole chain: calibrate, screen, name, test, locate, show, say."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from diagnosis import bootstrap as bootstrapping
from diagnosis.candidates import candidates
from diagnosis.constancy import Tested, flags, tests
from diagnosis.experiment import next_experiment
from diagnosis.forces import forces
from diagnosis.found import Search, adjusted, evidence, misfit_per_sample, rivals
from diagnosis.heldout import Shown, compare, fit_figures, horizons, windows_of
from diagnosis.intervals import estimates
from diagnosis.locate import locate
from diagnosis.missing_force import missing_force
from diagnosis.refit import Explanation
from diagnosis.rescale import to_true_peak
from diagnosis.result import Diagnosis, Effect, Estimate, Rival, Screened, Verdict
from diagnosis.select import Progress, search, take_best_single
from diagnosis.sensors import SENSORS
from diagnosis.setup import base_fit, measure, silent
from diagnosis.statement import statement
from diagnosis.whole_runs import with_runs_from_rest
from grids.recordings.base import Recording
from grids.specimen import Specimen

INADEQUATE = 1.35
"""Misfit per sample of the final model beyond which no mechanism of the library is adequate."""


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
    ends it: the answer holds what was found so far and has ``finished`` false. Raises InputError.
    """
    progress("calibrating the base model", 0.02)
    measured = measure(specimen, training)
    base = Explanation((), base_fit(specimen, measured, seed))
    found = Search(base, candidates(measured, specimen))
    finished = True
    try:
        for stage in search(base, found.candidates, progress):
            found = stage
    except KeyboardInterrupt:
        finished = False
        if found.best is None:
            take_best_single(found)
    if found.scores:
        progress("testing constancy", 0.85)
    return _assemble(specimen, found, holdout, bootstrap, progress, seed, finished)


def _assemble(
    specimen: Specimen,
    found: Search,
    holdout: Sequence[Recording],
    draws: int,
    progress: Progress,
    seed: int,
    finished: bool,
) -> Diagnosis:
    chosen, measured = found.chosen, found.base.fitted.misfit.predictor.measured
    about = forces(chosen.fitted)
    tested = tests(about)
    flagged = flags(tested, found.more)
    if found.outside is not None:
        flagged = (found.outside, *(f for f in flagged if f.parameter != found.outside.parameter))
    adequate = misfit_per_sample(chosen) < INADEQUATE
    near = rivals(found)
    verdict = _verdict(found, near, bool(flagged), adequate, finished)
    progress("intervals", 0.9)
    gain = found.base.loss - (found.best or min(found.singles, key=adjusted, default=found.base)).loss
    p_value = found.null.p_value(gain) if found.null else 1.0
    if draws and finished:
        p_value = bootstrapping.p_value(specimen, found, draws, seed, progress)
    effects, base = _estimates(found, p_value, profile=finished)
    progress("before and after", 0.95)
    shown = [compare(found.base, chosen, measured)]
    held = None
    if holdout:
        held = compare(found.base, chosen, measure(specimen, holdout, measured.reference_peak))
        shown.append(held)
    missing = verdict != "nothing_missing"
    at_base = tests(forces(found.base.fitted)) if found.best is not None else tested
    train = fit_figures(shown[0], missing)
    held_fit = fit_figures(held, missing) if held else None
    sensors_only = bool(effects) and all(e.name in SENSORS for e in effects)
    explained = found.best is not None and verdict != "not_in_library"
    located = locate(shown[0], at_base, sensors_only, explained, seed) if missing else ()
    rivals_told = tuple(Rival(c.name, c.effect_class, gap) for _, c, gap in near)
    experiment = next_experiment(found, near) if finished and verdict == "cannot_tell_apart" else None
    known = {**measured.model.mechanisms, **SENSORS}
    said = statement(
        verdict, effects, rivals_told, located, flagged, train, held_fit, p_value, known, experiment, finished
    )
    return Diagnosis(
        verdict=verdict,
        statement=said,
        effects=effects,
        rivals=rivals_told,
        located=located,
        constancy=flagged,
        train=train,
        holdout=held_fit,
        base=base,
        screen=_screened(found),
        null_band=found.null.band if found.null else 0.0,
        p_value=p_value,
        next_experiment=experiment,
        windows=tuple(w for k, s in enumerate(shown) for w in windows_of(s, k == 1)),
        traces=with_runs_from_rest(specimen, shown, found.base, chosen),
        prediction_horizon=_horizons(shown, specimen),
        missing_force=missing_force(about, tested) if verdict == "not_in_library" else None,
        provenance=_provenance(specimen, found, tested, seed),
        finished=finished,
    )


def _verdict(found: Search, near: Sequence[Any], flagged: bool, adequate: bool, finished: bool) -> Verdict:
    if not finished:  # what was not tried may explain it as well
        return "cannot_tell_apart"
    if flagged or not adequate:
        return "not_in_library"
    if found.best is None:
        return "nothing_missing"
    own = set(found.best.classes)
    others = {c.effect_class for _, c, _ in near}
    return "cannot_tell_apart" if others - own else "missing"


def _estimates(found: Search, p_value: float, profile: bool) -> tuple[tuple[Effect, ...], dict[str, Estimate]]:
    chosen = found.chosen
    named = [x.name for c in chosen.candidates for x in c.unknowns[:1]]
    values = estimates(chosen.fitted, named if profile else ())
    gains = evidence(found)
    effects = []
    for candidate, gain in sorted(zip(chosen.candidates, gains, strict=True), key=lambda pair: -pair[1]):
        parameters = {x.name.partition(".")[2]: values.pop(x.name) for x in candidate.unknowns}
        for name, value in candidate.held.items():
            short = name.partition(".")[2]
            parameters[short] = Estimate(value, value, value, candidate.mechanism.parameter(short).unit)
        parameters = to_true_peak(chosen, candidate, parameters)
        each = found.null.p_value(float(gain)) if found.null and len(gains) > 1 else p_value
        effects.append(Effect(candidate.name, candidate.effect_class, parameters, float(gain), each))
    return tuple(effects), values


def _screened(found: Search) -> tuple[Screened, ...]:
    fits = {e.candidates[0]: e for e in reversed(found.singles)}
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
            found.base.loss - fit.loss if fit else None,
            estimate,
        )
        if line.name not in lines or (line.gain or 0.0) > (lines[line.name].gain or 0.0):
            lines[line.name] = line
    return tuple(sorted(lines.values(), key=lambda s: -max(s.score, s.gain or 0.0)))


def _horizons(shown: Sequence[Shown], specimen: Specimen) -> dict[str, tuple[float, float]]:
    return {k: v for s in shown for k, v in horizons(s, dict(specimen.options)).items()}


def _provenance(specimen: Specimen, found: Search, tested: Sequence[Tested], seed: int) -> Mapping[str, Any]:
    measured = found.base.fitted.misfit.predictor.measured
    return {
        "specimen": specimen.title,
        "model": specimen.model,
        "model_version": measured.model.version,
        "recordings": [r.name for r in measured.recordings],
        "windows": len(measured.windows),
        "channels": list(measured.channels),
        "noise": {c: [float(s) for s in np.unique(measured.sigma[:, k])] for k, c in enumerate(measured.channels)},
        "misfit_per_sample": misfit_per_sample(found.chosen),
        "constancy_threshold": found.more,
        "largest_constancy": tested[0].statistic if tested else 0.0,
        "largest_constancy_of": f"{tested[0].kind} / {tested[0].depends_on}" if tested else "",
        "seed": seed,
    }
