"""Calibrating a specimen's base model on recordings: estimates, intervals, correlation, drift."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

import models
from diagnosis.answer.drift import FEWEST, Drift, drift_of, value_at
from diagnosis.answer.heldout import frozen, relative_misfit
from diagnosis.answer.posterior import posterior
from diagnosis.data.measured import Measured
from diagnosis.data.twice import refuse_twice
from diagnosis.errors.model import Errors, calibrated
from diagnosis.fit.channels import added_by_channels
from diagnosis.fit.intervals import Estimate, correlation, estimates, profile_rise, settled
from diagnosis.fit.one_thread import one_thread
from diagnosis.fit.setup import as_recorded, measure
from diagnosis.fit.solver import Fitted
from diagnosis.fit.unknowns import instruments_of
from diagnosis.progress import Progress, silent
from diagnosis.search.refit import Explanation
from grids.given import recordings_of, specimen_of
from grids.instruments.staged import moved_in_stages
from grids.recordings.base import Recording
from grids.specimen import Specimen, with_values
from models.base import FloatArray
from models.errors import InputError
from models.identification import Exposure
from models.piecewise import simulate

PROFILE_POINTS = (-3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0)
"""Half widths of the interval at which a profile is evaluated, over 1.96."""


@dataclass(frozen=True)
class Calibration:
    """Fitted base parameters.

    ``correlation`` (k, k) in the order of ``parameters``; ``misfit`` relative rms, states estimated as
    `diagnose` does for its "before", ``noise_floor`` the same of the noise; ``profiles``: by parameter,
    values and the rise of the loss (-2 log likelihood) over the optimum; ``by_recording``: the same
    estimates from each recording alone, with several recordings; ``drifts``: whether they stay the same over the
    recordings as a sequence of tests, of the parameters that the model says may change, and with what.
    """

    parameters: Mapping[str, Estimate]
    correlation: FloatArray
    misfit: float
    noise_floor: float
    misfit_per_sample: float
    windows: int
    profiles: Mapping[str, tuple[FloatArray, FloatArray]] = field(default_factory=dict)
    by_recording: Mapping[str, Mapping[str, Estimate]] = field(default_factory=dict)
    drifts: tuple[Drift, ...] = ()
    posterior: Mapping[str, FloatArray] = field(default_factory=dict)
    """Samples of the parameters that a study can vary (`diagnosis.answer.posterior`)."""
    channels: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    """By channel and parameter: how many times wider the interval would be without the channel."""
    seen: tuple[str, ...] = ()
    """What the recordings show of their instruments by themselves."""
    instruments: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    """These instruments as mechanisms of a specimen."""

    def __repr__(self) -> str:
        lines = [f"{'parameter':<24}{'estimate':>12}{'low 95 %':>12}{'high 95 %':>12}  unit"]
        for name, value in self.parameters.items():
            bound = f"  at its {value.at_bound} bound" if value.at_bound else ""
            lines.append(
                f"{name:<24}{value.estimate:>12.6g}{value.low95:>12.6g}{value.high95:>12.6g}  {value.unit}{bound}"
            )
        lines.append(
            f"misfit {self.misfit:.4f} of the signal (noise {self.noise_floor:.4f}), "
            f"{self.misfit_per_sample:.3f} times the noise variance, {self.windows} windows"
        )
        return "\n".join(lines)


@one_thread
def calibrate(
    specimen: Specimen | str | Path,
    recordings: Sequence[Recording | str | Path],
    *,
    profile: bool = True,
    seed: int = 0,
    progress: Progress = silent,
) -> Calibration:
    """Fit the toleranced parameters and those of [calibrate]; no mechanism is looked for. Files may be named.

    ``progress`` is called with (what is being done, share done). Raises InputError when nothing is
    uncertain or nothing can be compared.
    """
    specimen, recordings = specimen_of(specimen), recordings_of(recordings)
    if not specimen.tolerance and not specimen.calibrate:
        raise InputError(
            f"nothing to calibrate in '{specimen.title}': no parameter has a [tolerance] or a range in [calibrate]; "
            "give one, for instance [tolerance] width = 0.005 (one sigma, relative)."
        )
    refuse_twice(recordings)
    given = specimen.mechanisms
    specimen, seen = as_recorded(specimen, recordings)
    measured = measure(specimen, recordings)
    compared = {window.recording for window in measured.windows}
    alone = [r for k, r in enumerate(recordings) if k in compared] if len(compared) > 1 else []
    weak = [
        f"{r.name} holds no window that can be compared: it is not fitted alone"
        for k, r in enumerate(recordings)
        if k not in compared
    ]
    profiles = len(specimen.tolerance) + len(specimen.calibrate) if profile else 0
    steps = _steps(progress, 2 + len(alone) + profiles)
    steps("fitting all recordings together")
    fitted, errors = calibrated(specimen, measured, seed)
    each = {}
    for recording in alone:
        steps(f"fitting {recording.name} alone")
        each[recording.name] = calibrated(specimen, measure(specimen, [recording], measured.reference_peak), seed)[0]
    by_recording = {name: estimates(one) for name, one in each.items()}
    found = _summary(fitted, errors, fitted.measured.undisturbed, profile, by_recording, steps)
    instruments = {name: values for name, values in specimen.mechanisms.items() if name not in given}
    drifts = drifts_of(by_recording, list(each.values()))
    return replace(found, drifts=drifts, seen=(*map(str, seen), *weak), instruments=instruments)


def calibrated_specimen(specimen: Specimen, found: Calibration) -> Specimen:
    """The specimen with the fitted values in the place of nominal ones and ranges."""
    seen = replace(specimen, mechanisms={**specimen.mechanisms, **found.instruments})
    fitted = with_values(seen, {name: value.estimate for name, value in found.parameters.items()})
    return replace(fitted, title=f"{specimen.title}, calibrated", calibrate={})


def specimen_at(specimen: Specimen, found: Calibration, exposure: str, level: float) -> Specimen:
    """The same as the tests left it when the ``exposure`` of that name had reached a ``level``.

    Raises InputError where no property may change with it, beyond the tests, or where one changes with something else.
    """
    summed = exposure_of(specimen, exposure, level, len(found.by_recording)).summed
    known = [d for d in found.drifts if any(c.exposure.name == exposure for c in d.curves)]
    if not known:
        raise InputError(
            f"the tests do not tell how a parameter changes with {exposure}: give {FEWEST} tests or more in which that "
            "differs, of a specimen whose layers have ranges in [calibrate]."
        )
    whole = calibrated_specimen(specimen, found)
    values = {d.parameter: value_at(d, exposure, level) for d in found.drifts if d in known or d.drifts}
    when = f"after {level:g} {exposure}" if summed else f"at a {exposure} of {level:g}"
    return replace(whole, title=f"{specimen.title}, {when}", parameters={**whole.parameters, **values})


def exposure_of(specimen: Specimen, name: str, level: float, tests: int) -> Exposure:
    """The exposure of that name, of any layer; raises InputError where a ``level`` of it can mean nothing.

    That is where the model follows no such exposure, ``tests`` are too few, or the level is no number or negative.
    """
    identification = models.get(specimen.model).identification
    followed = {one.name: one for one in (identification.exposures if identification else ())}
    if not followed:
        raise InputError(f"{name} is not followed over a sequence of tests for '{specimen.model}': leave it out.")
    if name not in followed:
        raise InputError(f"'{name}' is not followed over a sequence of tests: give {' or '.join(followed)}.")
    if not 0.0 <= level < np.inf:
        raise InputError(f"{name} = {level:g}: give a number of zero or more.")
    if tests < FEWEST:
        raise InputError(f"{name} = {level:g}: {FEWEST} tests or more tell what a layer was then; given are {tests}.")
    return followed[name]


def drifts_of(by_recording: Mapping[str, Mapping[str, Estimate]], each: Sequence[Fitted]) -> tuple[Drift, ...]:
    """How the parameters that the model says may change do so from test to test; empty where it says so of none.

    ``by_recording``: estimates from each recording alone; ``each``: the fits that gave them, in the same order.
    """
    if not each:
        return ()
    exposures = each[0].measured.identification.exposures
    names = [n for n in next(iter(by_recording.values())) if any(n in e.of for e in exposures)]
    if not names:
        return ()
    ran = [_from_rest(fitted) for fitted in each]
    found = []
    for name in names:
        exposed = []
        for one in exposures:
            if name in one.of:
                values = np.array([outputs[one.output] for outputs in ran], np.float64)
                exposed.append((one, np.cumsum(values) if one.summed else np.maximum.accumulate(values)))
        found.append(drift_of(name, {r: own[name] for r, own in by_recording.items()}, exposed, len(names)))
    return tuple(one for one in found if one is not None)


def _from_rest(fitted: Fitted) -> Mapping[str, float]:
    """Outputs of the run of a fit's recording from rest."""
    predictor, m = fitted.misfit.predictor, fitted.measured
    shaking = moved_in_stages(m.shakings[0], predictor.sets(instruments_of(fitted.point.values), m.recordings[0]))
    ran = simulate(
        m.model, predictor.parts(fitted.point.values, m.recordings[0]), shaking, duration=shaking.duration,
        options=predictor.options,
    )  # fmt: skip
    return ran.outputs


def _steps(progress: Progress, count: int) -> Callable[[str], None]:
    """Reports to ``progress``, of ``count`` steps of about the same length, as each begins."""
    begun = iter(range(count))
    return lambda text: progress(text, next(begun) / count)


def _summary(
    fitted: Fitted,
    errors: Errors,
    measured: Measured,
    profile: bool,
    by_recording: Mapping[str, Mapping[str, Estimate]],
    steps: Callable[[str], None],
) -> Calibration:
    names = [x.name for x in fitted.misfit.unknowns]
    steps("intervals by profile likelihood" if profile else "intervals")
    fitted, found = settled(fitted, names if profile else ())
    residual = fitted.misfit.residuals([fitted.point])[0]
    profiles = {}
    if profile:
        for i, name in enumerate(names):
            steps(f"profile of {name}")
            profiles[name] = _profile(fitted, i, found[name])
    _, predicted = frozen(Explanation((), fitted), measured, errors)
    return Calibration(
        parameters=found,
        correlation=correlation(fitted),
        misfit=relative_misfit(measured, predicted),
        noise_floor=relative_misfit(measured, None),
        misfit_per_sample=float(np.sum(residual**2) / measured.count.sum()),
        windows=len(measured.windows),
        profiles=profiles,
        by_recording=by_recording,
        posterior=posterior(fitted, measured.model),
        channels=added_by_channels(fitted),
    )


def _profile(fitted: Fitted, index: int, estimate: Estimate) -> tuple[FloatArray, FloatArray]:
    """Values of one parameter and the rise of the loss with all others refitted."""
    unknown = fitted.misfit.unknowns[index]
    low, high = unknown.bounds
    ends = sorted(unknown.coordinate(end) for end in (estimate.low95, estimate.high95))
    half = 0.5 * (ends[1] - ends[0]) / 1.96
    at = np.unique(np.clip(fitted.u[index] + half * np.array(PROFILE_POINTS), low, high))
    rise = [profile_rise(fitted, index, float(u)) for u in at]
    return np.array([unknown.value(float(u)) for u in at]), np.array(rise)
