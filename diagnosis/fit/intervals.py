"""95 % intervals: a sandwich clustered by windows, and the profile likelihood for named parameters.

With the Gauss-Newton Hessian H and the windows' scores s_w (states eliminated) the covariance is

    V = H^-1 (sum_w s_w s_w' W/(W - k) + P) H^-1,      P the priors' part of H,

which stays right when residuals within a window are correlated or the noise level is off; the larger
of V and H^-1 is taken. Errors of the count of events before the windows (`diagnosis.fit.miscounts`), columns c of unit
variance, move the estimates by -H^-1 J'c each, and V has that times its transpose too. The profile raises the loss by
3.84 V/H^-1 on either side, so a curved loss gives a lopsided interval, and one that goes flat (a floor that is no
longer reached) an open one. Under other parameters a window may have other events, which its states do not reach step
by step: where the loss has risen enough, windows in which it has start again from scattered states. Where a profile
falls under the optimum the fit goes on from there (`settled`).

Where a fit works with another coordinate c than the model's own parameter x (`Identification.coordinates`: the slope of
a layer under its load beside its stiffness), x depends on the other unknowns too, such as a law's: its interval is that
of c, on a logarithmic scale, times sd(log x)/sd(log c), both from the gradients g and the covariance C, sd^2 = g'C g.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from diagnosis.fit.miscounts import miscounts
from diagnosis.fit.misfit import STEP, reduce
from diagnosis.fit.solver import CLEARLY, Fitted, fit, normal, scattered
from diagnosis.fit.unknowns import Unknown
from models.base import FloatArray

QUANTILE = 1.959963984540054
LEVEL = QUANTILE**2
PROFILE_ITERATIONS = 4
PROFILE_TRIES = 9
NEARLY = 0.95
"""Share of the rise at which an end is near enough, and from which windows are looked at that may be stuck."""
FLAT = 0.1
"""Root of a rise under which nothing depends on a parameter yet: the end is sought by halves then."""
BETTER = 1.0
"""Fall of the loss along a profile that makes its point a better start of the fit."""
RETURNS = 3
UNINFORMED = 1e-9
"""Standard deviation of a coordinate that the pseudo-inverse gives when nothing depends on it."""
FIRST_STEP = 0.1
"""Share of its range over which the profile of such a coordinate begins: further off something may depend on it."""


@dataclass(frozen=True)
class Estimate:
    """A fitted parameter with its 95 % interval; ``at_bound`` names a bound the fit ran into."""

    estimate: float
    low95: float
    high95: float
    unit: str
    at_bound: Literal["", "low", "high"] = ""


def covariances(fitted: Fitted) -> tuple[FloatArray, FloatArray]:
    """Sandwich and inverse Hessian (k, k) of the coordinates."""
    misfit = fitted.misfit
    linear = misfit.linearise(fitted.u, fitted.states)
    reduced = reduce(linear)
    weights = misfit.weights(linear.residual)
    hessian, _ = normal(misfit, reduced, weights, fitted.u)
    precision, _ = misfit.prior_normal(fitted.u)
    each = np.einsum("w,wmi,wm->wi", weights, reduced.by_unknown, reduced.residual, optimize=True)
    windows, k = each.shape[0], fitted.u.size
    spread = each.T @ each * windows / max(windows - k, 1)
    inverse = np.asarray(np.linalg.pinv(hessian, hermitian=True), np.float64)
    cover = inverse @ (spread + precision) @ inverse
    columns = miscounts(misfit.predictor, fitted.point)
    if columns.shape[-1]:
        counted = misfit.whitening(np.moveaxis(columns, -1, 0))
        moved = inverse @ np.einsum("w,wmi,kwm->ik", weights, reduced.by_unknown, counted, optimize=True)
        cover = cover + moved @ moved.T
    return np.asarray(cover)[:k, :k], inverse[:k, :k]


def at_least(sandwich: FloatArray, laplace: FloatArray) -> FloatArray:
    """The sandwich (k, k) with each standard deviation at least that of the inverse Hessian."""
    naive, robust = (np.sqrt(np.maximum(np.diag(cover), 0.0)) for cover in (laplace, sandwich))
    scale = np.maximum(naive, robust) / np.maximum(robust, 1e-300)
    return np.asarray(sandwich * np.outer(scale, scale))


def correlation(fitted: Fitted) -> FloatArray:
    """Correlation (k, k) of the estimates, from the sandwich."""
    cover, _ = covariances(fitted)
    sd = np.sqrt(np.maximum(np.diag(cover), 1e-300))
    return np.asarray(cover / np.outer(sd, sd))


def estimates(fitted: Fitted, profiled: Sequence[str] = ()) -> dict[str, Estimate]:
    """Every unknown with its 95 % interval, in its own unit; a profile for the names in ``profiled``."""
    sandwich, laplace = covariances(fitted)
    found, own, wider = {}, fitted.point.values, _own_widths(fitted, at_least(sandwich, laplace))
    for i, unknown in enumerate(fitted.misfit.unknowns):
        naive = float(np.sqrt(max(laplace[i, i], 0.0)))
        sd = max(naive, float(np.sqrt(max(sandwich[i, i], 0.0))))
        if unknown.name in profiled:
            width = unknown.bounds[1] - unknown.bounds[0]
            told = naive > UNINFORMED
            ends = _profile(fitted, i, sd if told else FIRST_STEP * width, (sd / naive) ** 2 if told else 1.0)
        elif naive < UNINFORMED:
            ends = unknown.bounds
        else:
            ends = (fitted.u[i] - QUANTILE * sd, fitted.u[i] + QUANTILE * sd)
        one = _estimate(unknown, float(fitted.u[i]), ends, fitted.at_bound(i))
        if unknown.name in fitted.misfit.predictor.coordinates:
            one = _as_own(one, own[unknown.name], wider[unknown.name])
        found[unknown.name] = one
    return found


def _as_own(one: Estimate, own: float, wider: float) -> Estimate:
    """The model's own parameter: its value, and the interval of the fit's coordinate ``wider`` in its logarithm."""
    low, high = (own * (end / one.estimate) ** wider for end in (one.low95, one.high95))
    return replace(one, estimate=own, low95=low, high95=high)


def _own_widths(fitted: Fitted, cover: FloatArray) -> dict[str, float]:
    """By coordinate: standard deviation of the logarithm of the model's own parameter over that of the coordinate."""
    unknowns, predictor = fitted.misfit.unknowns, fitted.misfit.predictor
    fitted_ones = [i for i, x in enumerate(unknowns) if x.name in predictor.coordinates]
    if not fitted_ones:
        return {}
    bounds = np.array([x.bounds for x in unknowns])
    steps = STEP * np.eye(len(unknowns))
    ends = np.clip(np.stack([fitted.u - steps, fitted.u + steps], axis=1), bounds[:, 0], bounds[:, 1])
    flat = ends.reshape(-1, len(unknowns))
    moved = np.einsum("iji->ij", ends)
    width = moved[:, 1] - moved[:, 0]
    owns = predictor.declared([fitted.misfit.point(u, fitted.states) for u in flat])
    found = {}
    for i in fitted_ones:
        name = unknowns[i].name
        if cover[i, i] < UNINFORMED**2:
            found[name] = 1.0
            continue
        own = np.log([point.values[name] for point in owns]).reshape(-1, 2)
        slope = (own[:, 1] - own[:, 0]) / width
        coordinate = np.log(unknowns[i].value(moved[i, 1]) / unknowns[i].value(moved[i, 0])) / width[i]
        found[name] = float(np.sqrt((slope @ cover @ slope) / (coordinate**2 * cover[i, i])))
    return found


class _Better(Exception):
    """A profile has found a lower loss than that of the optimum it started from."""

    def __init__(self, fitted: Fitted) -> None:
        self.fitted = fitted


def settled(fitted: Fitted, profiled: Sequence[str]) -> tuple[Fitted, dict[str, Estimate]]:
    """The fit and its `estimates`; where a profile finds a better optimum the fit goes on from there."""
    for _ in range(RETURNS):
        try:
            return fitted, estimates(fitted, profiled)
        except _Better as found:
            fitted = found.fitted
    return fitted, estimates(fitted)


def _estimate(unknown: Unknown, u: float, ends: tuple[float, float], at_bound: str) -> Estimate:
    low, high = unknown.bounds
    values = sorted(unknown.value(float(np.clip(end, low, high))) for end in ends)
    if unknown.kind == "inverse" and at_bound:
        at_bound = "high" if at_bound == "low" else "low"
    return Estimate(unknown.value(u), values[0], values[1], unknown.unit, at_bound)  # type: ignore[arg-type]


def _profile(fitted: Fitted, index: int, sd: float, inflation: float) -> tuple[float, float]:
    """Coordinates at which the profile loss has risen by LEVEL times ``inflation``."""
    wanted = float(np.sqrt(LEVEL * inflation))
    low, high = (_end(fitted, index, sign, QUANTILE * sd, wanted) for sign in (-1.0, 1.0))
    return low, high


def _end(fitted: Fitted, index: int, sign: float, step: float, wanted: float) -> float:
    """Where the root of the rise on one side is ``wanted``; the bound if it is less there."""
    at, bounds = float(fitted.u[index]), fitted.misfit.unknowns[index].bounds
    most = abs(bounds[sign > 0.0] - at)
    inside, rise_inside, outside, rise_outside = 0.0, 0.0, np.inf, np.inf
    for _ in range(PROFILE_TRIES):
        step = min(step, most)
        rise = _root_of_rise(fitted, index, at + sign * step, NEARLY * wanted)
        if abs(rise - wanted) < (1.0 - NEARLY) * wanted or (rise < wanted and step == most):
            break
        if rise < wanted:
            inside, rise_inside = step, rise
        else:
            outside, rise_outside = step, rise
        if np.isinf(outside):
            step *= float(np.clip(wanted / rise, 1.1, 3.0))
        else:
            share = (wanted - rise_inside) / (rise_outside - rise_inside)
            step = inside + (float(np.clip(share, 0.2, 0.8)) if rise_inside > FLAT else 0.5) * (outside - inside)
    return at + sign * min(step, most)


def profile_rise(fitted: Fitted, index: int, at: float) -> float:
    """How much the loss rises when one coordinate is held at ``at`` and all others are refitted."""
    return _held(fitted, index, at)[0]


def _root_of_rise(fitted: Fitted, index: int, at: float, enough: float) -> float:
    """The root of `profile_rise`, with windows that are stuck freed where it is ``enough``.

    Raises `_Better` where the profile leads to a better optimum.
    """
    rise, held = _held(fitted, index, at)
    if rise > enough**2:
        states = scattered(held, held.window_losses > fitted.window_losses + CLEARLY, seed=0)
        if states is not None:
            freed = fit(held.misfit, held.u, states, PROFILE_ITERATIONS)
            if freed.loss < held.loss:
                rise, held = rise + freed.loss - held.loss, freed
    if rise < -BETTER:
        misfit = fitted.misfit.at_level(held.misfit.level)
        again = fit(misfit, np.insert(held.u, index, at), held.states)
        if again.loss < fitted.loss - BETTER:
            raise _Better(again)
    return float(np.sqrt(max(rise, 1e-12)))


def _held(fitted: Fitted, index: int, at: float) -> tuple[float, Fitted]:
    misfit = fitted.misfit
    unknown = misfit.unknowns[index]
    keep = [i for i in range(fitted.u.size) if i != index]
    held = replace(
        misfit,
        unknowns=tuple(misfit.unknowns[i] for i in keep),
        fixed={**misfit.fixed, unknown.name: unknown.value(at)},
    )
    own = 0.0
    if unknown.prior is not None:
        mean, sd = unknown.prior
        own = ((unknown.value(at) - mean) / sd) ** 2
    found = fit(held, fitted.u[keep], fitted.states, PROFILE_ITERATIONS)
    return found.loss + own - fitted.loss, found
