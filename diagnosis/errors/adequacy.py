"""Whether the model's own error is small, and how well events repeat: deviances of single variances.

Dropping a component raises -2 log L by D (the others estimated anew); under the null that it is absent D is half a
chi-squared with one degree of freedom, half zero (Self and Liang, J. Am. Stat. Assoc. 82, 1987).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.stats import chi2

from diagnosis.data.noise import BAND
from diagnosis.errors.base_drift import SHARE
from diagnosis.errors.components import WALK
from diagnosis.errors.likelihood import State, climbed, evaluate, maximise
from diagnosis.errors.model import Errors
from models.base import FloatArray

CLEAR = 15.0
"""Deviance from which on a variance is stated."""
LARGE = 1.0
"""Variance of the model's smooth error over that of the sensors below `BAND` beyond which the model is not adequate."""
LEVEL = 3.841458820694124
"""Rise of the deviance at the ends of a 95 % interval."""
SMALLER, LARGER = (0.85, 0.7, 0.5), (1.2, 1.5, 2.0, 3.0)
"""Of an estimate, at which its profile is computed, outwards."""
LEAST = 0.001
"""Scatter about which the profile of an estimate of zero is computed."""


@dataclass(frozen=True)
class Inadequacy:
    """The model's smooth error: ``size`` (C,) as recorded, ``ratio`` of its variance over the sensors' below `BAND` Hz.

    ``deviance``: what the likelihood loses without it, the most influential window left out. ``judged`` false: nothing
    is ever still, so it cannot be told from noise.
    """

    size: tuple[float, ...]
    ratio: float
    deviance: float
    judged: bool

    @property
    def large(self) -> bool:
        return self.deviance > CLEAR and self.ratio > LARGE

    @property
    def p_value(self) -> float:
        """Chance of such a deviance where the model is right."""
        return 1.0 if self.deviance <= 0.0 else float(0.5 * chi2.sf(self.deviance, 1))


@dataclass(frozen=True)
class Repeatability:
    """Relative standard deviation of events with 95 % interval; ``deviance``: what the likelihood loses without it.

    ``at_limit``: the estimate is as large as it may be (`Errors.most_scatter`); the events' law may differ.
    """

    events: str
    estimate: float
    low95: float
    high95: float
    deviance: float
    at_limit: bool

    @property
    def clear(self) -> bool:
        return self.deviance > CLEAR


def inadequacy(errors: Errors) -> Inadequacy:
    """The smooth error that a model has under its estimated errors."""
    acting = np.array([c.kind == "inadequacy" for c in errors.components])
    if not acting.any():
        return Inadequacy((0.0,) * errors.unit.size, 0.0, 0.0, False)
    variance = _variance(errors)
    deviance = _without_most_influential(errors, acting) if variance.any() else 0.0
    size = tuple(float(x) for x in np.sqrt(variance) * errors.unit)
    return Inadequacy(size, _ratio(errors, variance), deviance, True)


def errs(errors: Errors) -> bool:
    """`Inadequacy.large`; the likelihood is not asked where the ratio says no."""
    return _ratio(errors, _variance(errors)) > LARGE and inadequacy(errors).large


def _variance(errors: Errors) -> FloatArray:
    """Of the model's own error (C,), in units squared."""
    found = np.zeros(errors.unit.size)
    for c, theta in zip(errors.components, errors.theta, strict=True):
        if c.kind == "inadequacy":
            found[slice(None) if c.channel is None else c.channel] += theta
    return found


def _ratio(errors: Errors, variance: FloatArray) -> float:
    """Over that of the sensors' noise below `BAND`."""
    return float(np.max(variance / np.maximum([below(errors, c) for c in range(variance.size)], 1e-300)))


def below(errors: Errors, channel: int) -> float:
    """Variance of a sensor's noise below `BAND` Hz, in units squared."""
    frequency = np.linspace(0.25, BAND, 60)
    return float(np.mean(density(errors, channel, frequency)) * BAND)


def density(errors: Errors, channel: int, frequency: FloatArray, moving: bool = False) -> FloatArray:
    """One-sided density (units squared per Hz) of a sensor's noise, hum left out; with inadequacy if ``moving``."""
    found = np.zeros_like(frequency)
    for component, theta in zip(errors.components, errors.theta, strict=True):
        of_all = component.kind == "inadequacy" and component.channel is None
        if (of_all or component.channel == channel) and (moving or not component.moving):
            found += theta * component.density(frequency, errors.step)
    return found


def repeatability(errors: Errors, events: str) -> Repeatability | None:
    """How well events repeat, by profile likelihood; None where there are none."""
    index = next((k for k, c in enumerate(errors.components) if c.kind == "scatter"), None)
    if index is None:
        return None
    sd = float(np.sqrt(errors.theta[index]))
    acting = np.arange(errors.theta.size) == index
    lost = _without(errors, acting) if sd > 0.0 else 0.0
    low = 0.0 if lost < LEVEL else _end(errors, acting, sd, [sd * factor for factor in SMALLER] + [0.0])
    reach = max(sd, LEAST)
    high = _end(errors, acting, sd, [reach * factor for factor in LARGER])
    return Repeatability(events, sd, low, high, lost, sd >= errors.most_scatter)


def drifting_base(errors: Errors, seconds: float) -> float | None:
    """Standard deviation, after ``seconds``, of the drift of the base accelerometer's zero, over the peak.

    0 where the likelihood does not clearly ask for one; None where the errors know of none.
    """
    acting = np.array([c.kind == "base_drift" for c in errors.components])
    if not acting.any():
        return None
    if not errors.theta[acting].any() or _without(errors, acting) <= CLEAR:
        return 0.0
    walks = np.array([np.isinf(c.scale) for c in errors.components])
    variance = errors.theta * np.where(walks, seconds / WALK, 1.0)
    return SHARE * float(np.sqrt(variance[acting].sum()))


def _end(errors: Errors, held: np.ndarray, estimate: float, at: Sequence[float]) -> float:
    """Where a profile that rises along ``at`` crosses LEVEL, linear in its root; the last point if it never does."""
    last, root = estimate, 0.0
    for value in at:
        ahead = float(np.sqrt(_without(errors, held, value**2)))
        if ahead >= np.sqrt(LEVEL):
            return last + float(np.sqrt(LEVEL) - root) / max(ahead - root, 1e-12) * (value - last)
        last, root = value, ahead
    return last


def _without(errors: Errors, held: np.ndarray, value: float = 0.0) -> float:
    """Rise of the deviance with the ``held`` variances at a value and the others estimated anew."""
    return max(_held(errors, held, value).deviance - errors.deviance, 0.0)


def _without_most_influential(errors: Errors, held: np.ndarray) -> float:
    """Rise of the deviance without the ``held`` variances, the piece left out that asks most for them."""
    full = evaluate(errors.pieces, errors.prior, errors.theta, errors.weights, slopes=False)
    less = _held(errors, held, 0.0)
    each = less.determinants - full.determinants + errors.weights * (less.chi2 - full.chi2)
    rest = [k for k in range(len(errors.pieces)) if k != int(np.argmax(each))]
    pieces = tuple(errors.pieces[k] for k in rest)
    _, state = maximise(pieces, errors.prior, errors.theta, errors.weights[rest])
    return _without(replace(errors, pieces=pieces, weights=errors.weights[rest], deviance=state.deviance), held)


def _held(errors: Errors, held: np.ndarray, value: float) -> State:
    """The likelihood with the ``held`` variances at a value and the others estimated anew."""
    pieces = [piece.holding(held, value) for piece in errors.pieces]
    prior = errors.prior.without(held)
    theta, _ = climbed(pieces, prior, errors.theta[~held], errors.weights, 0, 1)
    return maximise(pieces, prior, np.maximum(theta, 1e-6), errors.weights)[1]
