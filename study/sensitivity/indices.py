"""Indices of one output at the points of a design, with bootstrap intervals (SALib).

Sobol: S_i = Var(E[Y | x_i])/Var(Y), the share of the variance that parameter i explains alone, and
S_Ti = E[Var(Y | all but x_i)]/Var(Y), its share with all interactions (Sobol, Math. Comput. Simul. 55, 2001; estimators
of Saltelli et al., Comput. Phys. Comm. 181, 2010). Of a yes or no, Var(Y) is that of its probability: S_i says how far
the probability depends on parameter i. Morris: mu*, the mean absolute elementary effect over the whole range of
quantiles, and sigma, its scatter, which interaction and curvature make (Campolongo, Cariboni, Saltelli, Environ.
Modell. Softw. 22, 2007).
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from grids.axes import Design
from grids.axes.morris import levels
from models.base import FloatArray

RESAMPLES = 200
ENDS = 0.2
"""Share of the points at either end of a parameter's distribution whose mean the table gives."""
SOBOL, MORRIS = "saltelli", "morris"
FEWEST = 8
"""Groups of points without which no index is estimated."""


def group_size(design: Design) -> int:
    """Points that must all be known: those of a base point, or of a trajectory."""
    dimensions = int(design.shares.shape[1])
    return 2 * dimensions + 2 if design.kind == SOBOL else dimensions + 1


def indices(design: Design, values: FloatArray, *, confidence: float = 0.95, seed: int = 1) -> dict[str, NDArray[Any]]:
    """Indices ``(parameters,)`` by name, `second` ``(parameters, parameters)``, with ``_low`` and ``_high``.

    A group of points with an unknown (nan) value is left out. Everything is nan where fewer than 8 groups are left or
    where the output does not vary.
    """
    dimensions = design.shares.shape[1]
    grouped = values.reshape(-1, group_size(design))
    known = np.isfinite(grouped).all(axis=1)
    kept = grouped[known].ravel()
    shares = design.shares.reshape(*grouped.shape, dimensions)[known].reshape(-1, dimensions)
    names = ("first", "total") if design.kind == SOBOL else ("mu_star", "mu", "sigma")
    nothing = {name: np.full(dimensions, np.nan) for name in names}
    if known.sum() < FEWEST or not np.ptp(kept) > 0.0:
        found = _with_interval(nothing, {name: nothing[name] for name in names if name in BOUNDED})
        pairs = {"second": np.full((dimensions, dimensions), np.nan)}
        return found | (_with_interval(pairs, pairs) if design.kind == SOBOL else {})
    problem = {"num_vars": dimensions, "names": [str(k) for k in range(dimensions)], "bounds": [[0, 1]] * dimensions}
    if design.kind == SOBOL:
        return _sobol(problem, kept, confidence, seed)
    return _morris(problem, shares, levels(design.choices), kept, confidence, seed)


BOUNDED = ("first", "total", "mu_star")
"""Indices that come with an interval."""


def _sobol(problem: Mapping[str, Any], values: FloatArray, confidence: float, seed: int) -> dict[str, NDArray[Any]]:
    import SALib.analyze.sobol

    found = SALib.analyze.sobol.analyze(
        problem, values, calc_second_order=True, num_resamples=RESAMPLES, conf_level=confidence, seed=seed
    )
    named = {"first": np.asarray(found["S1"]), "total": np.asarray(found["ST"])}
    halves = {"first": np.asarray(found["S1_conf"]), "total": np.asarray(found["ST_conf"])}
    second, half = (np.asarray(found[name], dtype=float) for name in ("S2", "S2_conf"))
    pairs = _with_interval({"second": second}, {"second": half})
    return _with_interval(named, halves) | {name: np.where(np.isnan(x), x.T, x) for name, x in pairs.items()}


def _morris(
    problem: Mapping[str, Any], shares: FloatArray, steps: int, values: FloatArray, confidence: float, seed: int
) -> dict[str, NDArray[Any]]:
    import SALib.analyze.morris

    points = np.rint(shares * steps - 0.5) / (steps - 1)
    found = SALib.analyze.morris.analyze(
        problem, points, values, num_levels=steps, num_resamples=RESAMPLES, conf_level=confidence, seed=seed
    )
    named = {"mu_star": found["mu_star"], "mu": found["mu"], "sigma": found["sigma"]}
    return _with_interval({k: np.asarray(v, dtype=float) for k, v in named.items()}, {"mu_star": found["mu_star_conf"]})


def _with_interval(values: Mapping[str, FloatArray], halves: Mapping[str, Any]) -> dict[str, NDArray[Any]]:
    ends = {f"{name}_low": values[name] - np.asarray(half, dtype=float) for name, half in halves.items()}
    return {**values, **ends, **{f"{n}_high": values[n] + np.asarray(h, dtype=float) for n, h in halves.items()}}


def at_the_ends(design: Design, values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Mean of the output ``(parameters,)`` over the points in the lowest and the highest fifth of each distribution."""
    low, high = (
        np.where(inside, values[:, None], np.nan) for inside in (design.shares <= ENDS, design.shares >= 1 - ENDS)
    )
    return _mean(low), _mean(high)


def _mean(values: FloatArray) -> FloatArray:
    count = np.isfinite(values).sum(axis=0)
    return np.where(count > 0, np.nansum(values, axis=0) / np.maximum(count, 1), np.nan)
