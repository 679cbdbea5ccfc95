"""Whether a property stays the same over a sequence of tests, and what it changes with.

Each test gives ln y_i with a standard error s_i, from its 95 % interval. Constancy: Q = sum ((ln y_i - mean)/s_i)^2 is
chi-squared with k - 1 degrees of freedom. A change with an exposure x (the largest strain so far, the number of
closings so far) is

    ln y = a + b (1 - exp(-x/x0)),        x0 from a tenth of the largest x to ten times it,

by weighted least squares; large x0 make it a straight line. Exposures have the same number of parameters, so what each
leaves of Q says which of them it is, where the tests can tell: a weaker test has to follow a stronger one.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2

from diagnosis.fit.intervals import QUANTILE, Estimate
from models.base import FloatArray
from models.errors import InputError
from models.identification import Exposure

CHANCE = 0.05
"""p-value, all properties together, under which one is said to drift."""
APART = 6.0
"""What an exposure must leave of Q over another one to be ruled out: a likelihood ratio of 20."""
FEWEST = 3
"""Tests from which on a change is followed."""
SHAPES = np.geomspace(0.1, 10.0, 25)
"""x0 over the largest exposure."""


@dataclass(frozen=True)
class Curve:
    """A change with an exposure: ``values`` (k,) of it by test, ``left`` of Q, and a, b, x0 of the fit."""

    exposure: Exposure
    values: FloatArray
    left: float
    parameters: tuple[float, float, float]

    def at(self, exposure: float) -> float:
        """The property there."""
        a, b, shape = self.parameters
        return float(np.exp(a + b * -np.expm1(-exposure / shape)))


@dataclass(frozen=True)
class Drift:
    """One property over the tests: ``estimates`` by recording, its weighted ``mean``, the p-value of constancy.

    ``curves``: one an exposure, the best first; none with too few tests. ``drifts``: whether the property is not
    constant. ``left_p``: chance of what the best curve leaves.
    """

    parameter: str
    estimates: Mapping[str, Estimate]
    mean: float
    p_constant: float
    drifts: bool
    curves: tuple[Curve, ...]

    @property
    def with_what(self) -> tuple[Curve, ...]:
        """The exposures that the tests cannot rule out, the best first; none where the property is constant."""
        if not self.drifts or not self.curves:
            return ()
        return tuple(c for c in self.curves if c.left < self.curves[0].left + APART)

    @property
    def left_p(self) -> float:
        """Chance of what the best curve leaves, where more tests than its parameters tell."""
        free = len(self.estimates) - FEWEST
        return float(chi2.sf(self.curves[0].left, free)) if self.curves and free > 0 else 1.0

    def __repr__(self) -> str:
        if not self.drifts:
            return f"{self.parameter} stays the same over the tests (p = {self.p_constant:.2g})"
        said = f"{self.parameter} is not the same in all tests ({_chance(self.p_constant)})"
        if not self.curves:
            few = len(self.estimates) < FEWEST
            why = f"{FEWEST} tests or more would tell" if few else "the runs of these tests do not tell"
            return f"{said}; with what it changes, {why}"
        if self.left_p < CHANCE:
            return f"{said}; neither the {' nor the '.join(c.exposure.meaning for c in self.curves)} explains it"
        names = [f"{c.exposure.meaning}, {c.values.min():.3g} to {c.values.max():.3g}" for c in self.with_what]
        change = self.curves[0].at(self.curves[0].values.max()) / self.curves[0].at(self.curves[0].values.min()) - 1.0
        told = f"it changes by {change:+.0%} with the {names[0]}"
        return f"{said}: {told}" + "".join(f", or with the {name}: these tests cannot tell" for name in names[1:])


def drift_of(
    parameter: str, estimates: Mapping[str, Estimate], exposed: Sequence[tuple[Exposure, FloatArray]], tested: int = 1
) -> Drift | None:
    """The property over the tests in their order; None where fewer than two tests tell anything of it.

    ``exposed``: exposures and their values (k,) after each test; ``tested``: properties that are tested together.
    """
    told = [
        k for k, one in enumerate(estimates.values()) if one.estimate > 0.0 and one.low95 > 0.0 and not one.at_bound
    ]
    if len(told) < 2:
        return None
    known = [(name, one) for k, (name, one) in enumerate(estimates.items()) if k in told]
    y = np.log([one.estimate for _, one in known])
    width = np.log([one.high95 / one.low95 for _, one in known])
    weight = (2.0 * QUANTILE / width) ** 2
    mean = float(weight @ y / weight.sum())
    p_value = float(chi2.sf(weight @ (y - mean) ** 2, y.size - 1))
    curves = [_curve(exposure, values[told], y, weight) for exposure, values in exposed if y.size >= FEWEST]
    found = sorted((c for c in curves if c is not None), key=lambda c: c.left)
    return Drift(parameter, dict(known), float(np.exp(mean)), p_value, p_value < CHANCE / tested, tuple(found))


def value_at(found: Drift, name: str, level: float) -> float:
    """The property at a ``level`` of the exposure of that name: that of the curve, or the mean where it is constant.

    Raises InputError beyond the tests, and where the property changes with something else.
    """
    for known in found.curves:
        low, high = float(known.values.min()), float(known.values.max())
        if known.exposure.name == name and not low <= level <= high:
            raise InputError(
                f"{name} = {level:g} lies beyond the tests, {low:.3g} to {high:.3g} for {found.parameter}: give one "
                "between, or test further."
            )
    if not found.drifts:
        return found.mean
    curve = next((c for c in found.with_what if c.exposure.name == name), None)
    if curve is None or found.left_p < CHANCE:
        others = " or ".join(c.exposure.meaning for c in found.with_what) or "nothing that these tests tell"
        raise InputError(
            f"{found.parameter} changes with {others} and not with the {name}: take the value of one test instead."
        )
    return curve.at(level)


def _curve(exposure: Exposure, x: FloatArray, y: FloatArray, weight: FloatArray) -> Curve | None:
    """The best curve; None where the exposure is the same in all tests."""
    if not np.ptp(x) > 1e-9 * np.max(np.abs(x), initial=1e-300):
        return None
    best: Curve | None = None
    root = np.sqrt(weight)
    for shape in SHAPES * float(x.max()):
        columns = np.stack([np.ones_like(x), -np.expm1(-x / shape)], axis=1)
        (a, b), *_ = np.linalg.lstsq(root[:, None] * columns, root * y, rcond=None)
        left = float(weight @ (y - columns @ [a, b]) ** 2)
        if best is None or left < best.left:
            best = Curve(exposure, x, left, (float(a), float(b), float(shape)))
    return best


def _chance(p_value: float) -> str:
    return "p < 1e-6" if p_value < 1e-6 else f"p = {p_value:.2g}"
