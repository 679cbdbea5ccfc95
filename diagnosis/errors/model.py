"""The estimated errors of the recordings, and how they weigh residuals."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from diagnosis.data.measured import Measured
from diagnosis.errors.components import CORNERS, DECAYS, LOW_PASS, SLOW_DRIFTS, SMOOTH, Component, Kind
from diagnosis.errors.drifts import columns, knots_of
from diagnosis.errors.followed import followed
from diagnosis.errors.kicks import Kicks, kicks
from diagnosis.errors.likelihood import Piece, Prior, by_piece, climbed, maximise
from diagnosis.errors.lines import lines
from diagnosis.errors.own import AS_MOTION, own_error
from diagnosis.errors.past import before_windows
from diagnosis.errors.pieces import LARGEST, Scene, opened, peaks_of, prior_of, windows
from diagnosis.errors.scattered import Events, gauss_newton, known_changes, linear_about, shortened
from diagnosis.errors.sensors import of_sensors
from diagnosis.errors.stills import stills
from diagnosis.fit.long_steps import in_long_steps
from diagnosis.fit.misfit import Misfit
from diagnosis.fit.prediction import Point, Predictor
from diagnosis.fit.setup import base_fit
from diagnosis.fit.solver import Fitted, fit_thoroughly
from diagnosis.fit.whitening import Whitening, base_columns, responses
from grids.recordings.noise import noise_of
from grids.specimen import Specimen
from models.base import FloatArray

STEPS, AGAIN = 10, 3
"""Multiplicative steps from the first start, and from an estimate."""
SCATTER = 0.01
"""Where the scatter of events starts, relative."""
REPEATS = 0.001
"""Scatter under which events repeat: what it leaves in a window is in proportion."""
RELINEARISED = 4
"""Times that events are predicted anew about the motion with those predicted before."""
AT_MOST = 0.95
"""Share of the largest scatter from which on it is as large as it may be."""
FAINT = 0.004
"""Variance of an independent part of a drift, in its units squared, under which no window could show it."""


@dataclass(frozen=True)
class Errors:
    """Variances ``theta`` (K,) of ``components``, in units squared.

    That of scatter is relative, squared; that of a drifting base in (`base_drift.SHARE` of the peak) squared.

    ``unit`` (C,): that over all recordings; `Measured.units` are those of each.

    ``deviance``: -2 log restricted likelihood of the windows and still stretches with the weights held; ``loss``: -2
    log likelihood by which models, each with its own errors, are compared (`diagnosis.errors.likelihood.by_piece`), and
    ``by_window`` (W,) of it; ``pieces`` with their ``weights``: the windows' first; ``step``: s between samples as
    recorded, of the first recording; ``base`` (W, C, N, K): columns of base noise, ``past`` of
    what sensors remember from before the windows; ``kicks``: what events leave.
    """

    components: tuple[Component, ...]
    theta: FloatArray
    unit: FloatArray
    pieces: tuple[Piece, ...]
    weights: FloatArray
    prior: Prior
    deviance: float
    loss: float
    by_window: FloatArray
    step: float
    whitening: Whitening
    base: FloatArray
    past: FloatArray
    kicks: Kicks

    def on(self, misfit: Misfit) -> Misfit:
        """The misfit weighed by these errors, about the events as they were."""
        known = self.whitening.measured.as_it_was
        predictor = replace(misfit.predictor, measured=replace(misfit.measured, as_it_was=known))
        return replace(misfit, predictor=predictor, whitening=self.whitening)

    def repeating(self, misfit: Misfit) -> Misfit:
        """The misfit weighed by these errors but the scatter of events."""
        m = self.whitening.measured
        return replace(
            misfit, whitening=_whitening(m, self.unit, self.components, self.theta, self.base, self.past, self.prior)
        )

    @property
    def scatter(self) -> float:
        """Standard deviation of the relative change of the rate by an event."""
        return _scatter(self.components, self.theta)

    @property
    def scatters(self) -> bool:
        """Whether events scatter, and no more than they may."""
        return REPEATS <= self.scatter < self.most_scatter

    @property
    def most_scatter(self) -> float:
        """Scatter from which on it is as large as it may be: then it is a law that differs."""
        return AT_MOST * float(np.sqrt(LARGEST["scatter"]))

    def of_sensors(self, measured: Measured) -> Whitening:
        """The sensors' errors in windows of other recordings; those of channels not known are taken for white."""
        channels = self.whitening.measured.channels
        peaks = peaks_of(self.whitening.measured)
        return of_sensors(self.components, self.theta, self.unit, channels, peaks, measured)

    def expected(self, predictor: Predictor, point: Point) -> Whitening:
        """What is to be expected in windows of other recordings: errors of sensors, noise of the base, scatter.

        The latter about the motion at ``point``, like what sensors remember; without drifts, which windows share. Of a
        model that runs through whole recordings, of sensors and the model's own.
        """
        m = predictor.measured
        if m.stretches is not None:
            return self.of_sensors(m).with_columns(_own(m, self.components, self.theta))
        base = base_columns(predictor, responses(predictor, point))
        scattered = self.scatter * kicks(predictor, point).columns
        columns = np.concatenate([base, before_windows(predictor, point), scattered], axis=-1)
        return self.of_sensors(m).with_columns(columns)


def disturbance_about(fitted: Fitted) -> FloatArray:
    """What the noise of the base motion leaves in the windows: columns (W, C, N, K) of unit variance."""
    predictor, m = fitted.misfit.predictor, fitted.measured
    if m.stretches is not None:  # it goes on from stretch to stretch, and what the model gets wrong is far larger
        return np.zeros((*m.values.shape, 0))
    return base_columns(predictor, responses(predictor, fitted.point))


def calibrated(specimen: Specimen, measured: Measured, seed: int = 0) -> tuple[Fitted, Errors]:
    """The calibrated base and the errors of the recordings about it."""
    first = followed(base_fit(specimen, measured, seed))
    return refitted(first, disturbance_about(first))


def refitted(fitted: Fitted, base: FloatArray, start: Errors | None = None, rounds: int = 2) -> tuple[Fitted, Errors]:
    """A fit and its errors, each estimated under the other in turn, about the events as they were."""
    errors = estimate(fitted, base, start)
    for _ in range(rounds - 1):
        fitted, errors = fit_under(fitted, errors)
        errors = estimate(fitted, base, errors)
    return fit_under(fitted, errors)


def fit_under(fitted: Fitted, errors: Errors) -> tuple[Fitted, Errors]:
    """The fit under these errors, and they, about the events as they were; from here on in long steps of the model."""
    fitted, errors = _about_the_events(in_long_steps(fitted), errors)
    return fit_thoroughly(replace(fitted.misfit, whitening=errors.whitening), fitted.u, fitted.states), errors


def _about_the_events(fitted: Fitted, errors: Errors) -> tuple[Fitted, Errors]:
    """The fit, and its errors estimated anew, about the motion with the events as they are predicted.

    About the motion without scatter where there is none, or as much as there may be: then it is a law that differs,
    and a motion with that law and with the pulses that stand for it would have it twice. And where no pulse makes the
    change that an event leaves.
    """
    for _ in range(RELINEARISED):
        if not errors.scatters or not np.any(errors.kicks.height):
            break
        own = next(k for k, c in enumerate(errors.components) if c.kind == "scatter")
        now = Events(fitted.u, fitted.states, errors.kicks, known_changes(fitted.measured, errors.kicks))
        aim = gauss_newton(errors.pieces, errors.prior, errors.theta, errors.weights, own, now)
        known = shortened(errors.repeating(fitted.misfit), errors.scatter, now, aim)
        if known is None:
            break
        fitted = replace(fitted, misfit=linear_about(fitted.misfit, known), u=known.u, states=known.states)
        errors = estimate(fitted, errors.base, errors)
    if errors.scatters or fitted.measured.as_it_was is None:
        return fitted, errors
    fitted = replace(fitted, misfit=fitted.misfit.undisturbed)
    return fitted, estimate(fitted, errors.base, errors)


def estimate(fitted: Fitted, base: FloatArray, start: Errors | None = None) -> Errors:
    """The errors about a fit; ``base`` (W, C, N, K): columns of base noise, of unit variance."""
    kicked, past = kicks(fitted.misfit.predictor, fitted.point), before_windows(fitted.misfit.predictor, fitted.point)
    scene = opened(fitted, base, past, kicked.columns)
    components = _components(scene) if start is None else start.components
    own = fitted.measured.stretches is not None
    quiet = stills(scene, components)
    known = None if start is None else start.theta
    if not quiet and not own:
        kept = np.array([c.kind != "inadequacy" for c in components])
        components = tuple(c for c, keep in zip(components, kept, strict=True) if keep)
        known = None if known is None else known[kept]
    theta = _start(components) if known is None else np.maximum(known, 1e-4 * _start(components))
    pieces = (*windows(scene, components), *quiet)
    prior = prior_of(scene, components)
    moving = len(fitted.measured.windows)
    weights = np.ones(len(pieces))
    theta, weights = climbed(pieces, prior, theta, weights, moving, STEPS if start is None else AGAIN)
    if start is None:
        heard = () if own else lines(pieces, scene.unit.size, theta, weights)
        if heard:
            components = (*components, *heard)
            pieces = (*windows(scene, components), *stills(scene, components))
            prior = prior_of(scene, components)
            theta = np.concatenate([theta, np.full(len(heard), 0.1)])
            theta, weights = climbed(pieces, prior, theta, weights, moving, AGAIN)
    theta, state = maximise(pieces, prior, theta, weights)
    known = np.concatenate([past, _scatter(components, theta) * kicked.columns], axis=-1)
    whitening = _whitening(fitted.measured, scene.unit, components, theta, base, known, prior)
    step = fitted.measured.recordings[0].time_step
    each = by_piece(state, pieces, moving)
    loss = float(each.sum()) + state.price + fitted.misfit.prior_of_unknowns(fitted.u)
    return Errors(
        components, theta, scene.unit, pieces, weights, prior, state.deviance, loss, each[:moving], step, whitening,
        base, past, kicked,
    )  # fmt: skip


def _components(scene: Scene) -> tuple[Component, ...]:
    found: list[Component] = []
    measured = scene.fitted.measured
    stretches = measured.stretches
    for c, name in enumerate(measured.channels):
        found.append(Component("white", c))
        # what is faster than a mean is white among means
        fastest = 0.0 if stretches is None else stretches.mean
        found += [Component("low_pass", c, s) for s in LOW_PASS if s > fastest]
        found += [Component("exponential", c, s) for s in DECAYS if s > fastest]
        found += [Component("slow_drift", c, s) for s in SLOW_DRIFTS]
        found.append(Component("growing", c))
        if stretches is None:
            if not all(noise_of(recording.channels[name]).white for recording in measured.recordings):
                found += [Component("filtered", c, hz) for hz in CORNERS]
            found += [Component("inadequacy", c, s) for s in SMOOTH]
    if stretches is not None:
        found += [Component("inadequacy", None, s) for s in (AS_MOTION, *stretches.smooth)]
    if scene.kicks.shape[-1]:
        found.append(Component("scatter"))
    if scene.pulses.shape[-1]:
        found += [Component("base_drift", None, s) for s in SLOW_DRIFTS]
    return tuple(found)


def _scatter(components: Sequence[Component], theta: FloatArray) -> float:
    return float(np.sqrt(sum(t for c, t in zip(components, theta, strict=True) if c.kind == "scatter")))


def _start(components: Sequence[Component]) -> FloatArray:
    known: dict[Kind, float] = {"scatter": SCATTER**2, "white": 1.0}
    return np.array([known.get(c.kind, 0.1) for c in components])


def _whitening(
    m: Measured,
    unit: FloatArray,
    components: Sequence[Component],
    theta: FloatArray,
    base: FloatArray,
    others: FloatArray,
    prior: Prior,
) -> Whitening:
    """Of the sensors' errors; the base's, ``others`` and a model's own as columns, drifts as errors windows share."""
    found = of_sensors(components, theta, unit, m.channels, peaks_of(m), m)
    found = found.with_columns(np.concatenate([base, others, _own(m, components, theta)], axis=-1))
    knots, root = knots_of(m, components), prior.root(theta)
    root = root[:, np.sum(root**2, axis=0) > FAINT]
    return found.with_shared(columns(knots, root, m, base)) if knots and root.size else found


def _own(measured: Measured, components: Sequence[Component], theta: FloatArray) -> FloatArray:
    """What a model that runs through whole recordings gets wrong by itself: columns (W, C, n, K) of unit variance."""
    found = [np.zeros((*measured.values.shape, 0))]
    for component, variance in zip(components, theta, strict=True):
        if component.kind == "inadequacy" and component.channel is None and variance > 0.0:
            found.append(np.sqrt(variance) * own_error(measured, component.scale))
    return np.concatenate(found, axis=-1)
