"""Fragility: how often an event happens, over a measure of the motion."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from scipy.stats import beta

from models.base import FloatArray
from study.selection import SAMPLE
from study.sets.cells import Event, chosen_cells, happens, intensity, pairs
from study.sets.lognormal import Lognormal, fit_lognormal

BINS = 10
POINTS = 200
ENDS = ("", "_low", "_high")


def fragility(
    cube: xr.Dataset,
    event: Event,
    measure: str = "pga",
    at: Mapping[str, Any] | None = None,
    over: str | None = None,
    *,
    confidence: float = 0.95,
) -> xr.Dataset:
    """Empirical and lognormal fragility of an event over a measure of the motion, for each value of ``over``.

    Over ``level`` (200 intensities): `probability` of the lognormal fit with `probability_low`, `_high`; scalars
    `median` and `dispersion` with `_low`, `_high` (see `study.sets.lognormal`). Over ``bin``: `share` of the cells in
    which the event happens, with its Clopper-Pearson interval for as many trials as there are motions in the bin, at
    the mean `strength` of its cells; a bin is a value of the cube's own intensity axis, or a tenth of the cells.
    `cells` counts those with a valid answer, `unknown` the others. ``why`` names what cannot be fitted; its numbers are
    nan.

    Of an axis of samples left open every sample is fitted, as a step where its cells ask for one (never: the median is
    infinite): `probability` is the mean of their curves, `median` and `dispersion` are those of the middle sample, and
    all intervals but those of `share` hold the middle ``confidence`` of the samples: what is not known of the wall.
    What few motions leave open is not in them.

    Raises InputError without an axis `motion`, and for unknown names and values off the grid.
    """
    cells, selection = chosen_cells(cube, at, over, samples=True)
    strength, outcome = intensity(cells, measure), happens(cells, event)
    parts = []
    known = strength.values[np.isfinite(outcome.values) & (strength.values > 0.0)]
    levels = np.geomspace(known.min(), known.max(), POINTS) if known.size else np.full(POINTS, np.nan)
    for k in range(cells.sizes[over] if over else 1):
        of = {over: k} if over else {}
        strengths, outcomes = strength.isel(of), outcome.isel(of)
        x, y, motion = pairs(strengths, outcomes)
        if SAMPLE in outcomes.dims:
            each = [pairs(strengths.isel({SAMPLE: j}), outcomes.isel({SAMPLE: j})) for j in range(cells.sizes[SAMPLE])]
            curve = _of_samples(each, levels, confidence)
        else:
            curve = _curve(fit_lognormal(x, y, motion, confidence), levels)
        parts.append(curve.assign(_bins(x, y, motion, measure in cells.dims, confidence)))
        parts[-1]["cells"] = ((), x.size)
        parts[-1]["unknown"] = ((), int(outcomes.size - x.size))
    found = (
        xr.concat(parts, cells[over], data_vars="all", coords="minimal", compat="override", join="outer")
        if over
        else parts[0]
    )
    found["level"].attrs = found["strength"].attrs = dict(strength.attrs)
    found["median"].attrs["units"] = strength.attrs["units"]
    return found.assign_attrs(
        event=str(event),
        measure=measure,
        selection=selection,
        confidence=confidence,
        motions=cells.sizes["motion"],
        samples=cells.sizes.get(SAMPLE, 0) if over != SAMPLE else 0,
    )


def _curve(fit: Lognormal, levels: FloatArray) -> xr.Dataset:
    return _dataset({"median": fit.median, "dispersion": fit.dispersion}, fit.probability(levels), levels, fit.why)


def _of_samples(
    samples: Sequence[tuple[FloatArray, FloatArray, FloatArray]], levels: FloatArray, confidence: float
) -> xr.Dataset:
    """The mean of the samples' curves, and between which values the middle ``confidence`` of the samples lie."""
    each = [_of_sample(x, y, motion, levels) for x, y, motion in samples]
    ends = (0.5, 0.5 - confidence / 2, 0.5 + confidence / 2)
    curves = np.array([one.curve for one in each])
    outer = [np.quantile(curves, end, axis=0) for end in ends[1:]]
    triples = {
        # a sample, not a mean of two: one may be infinite
        name: tuple(float(np.quantile(values, end, method="inverted_cdf")) for end in ends)
        for name, values in (("median", [one.median for one in each]), ("dispersion", [one.dispersion for one in each]))
    }
    why = "; ".join(f"{k} of {len(each)} samples: {text}" for text, k in Counter(o.why for o in each if o.why).items())
    return _dataset(triples, (curves.mean(axis=0), *outer), levels, why)


@dataclass(frozen=True)
class _Sample:
    """The fragility of one sample: ``curve`` over the levels; ``why`` it is no lognormal one."""

    curve: FloatArray
    median: float
    dispersion: float
    why: str = ""


def _of_sample(x: FloatArray, y: FloatArray, motion: FloatArray, levels: FloatArray) -> _Sample:
    """The lognormal fit, or the step that the likelihood tends to where none, all or the stronger cells happen."""
    fit = fit_lognormal(x, y, motion)
    if np.isfinite(fit.median[0]):
        return _Sample(fit.probability(levels)[0], fit.median[0], fit.dispersion[0])
    stayed, happened = x[y < 0.5], x[y > 0.5]
    if not happened.size or not stayed.size or stayed.max() <= happened.min():
        last = stayed.max() if stayed.size else 0.0
        threshold = float(np.sqrt(last * happened.min())) if happened.size else np.inf
        return _Sample((levels >= threshold).astype(float), threshold, 0.0, fit.why)
    return _Sample(np.full(levels.size, np.nan), np.nan, np.nan, fit.why)


def _dataset(
    triples: Mapping[str, tuple[float, ...]],
    curve: tuple[FloatArray, ...],
    levels: FloatArray,
    why: str,
) -> xr.Dataset:
    values: dict[str, Any] = {"why": ((), why)}
    for name, triple in triples.items():
        values |= {f"{name}{end}": ((), v) for end, v in zip(ENDS, triple, strict=True)}
    values |= {f"probability{end}": ("level", v) for end, v in zip(ENDS, curve, strict=True)}
    return xr.Dataset(values, coords={"level": levels})


def _bins(x: FloatArray, y: FloatArray, motion: FloatArray, on_axis: bool, confidence: float) -> dict[str, Any]:
    """Shares with intervals in groups of cells, in the order of intensity."""
    order = np.argsort(x, kind="stable")
    groups = np.split(order, np.flatnonzero(np.diff(x[order])) + 1) if on_axis else np.array_split(order, BINS)
    groups = [group for group in groups if group.size]
    share = np.array([y[group].mean() for group in groups])
    trials = np.array([np.unique(motion[group]).size for group in groups], dtype=float)
    low, high = binomial_interval(share * trials, trials, confidence)
    strength = np.array([x[group].mean() for group in groups])
    found = {"strength": strength, "share": share, "share_low": low, "share_high": high}
    return {"bin": np.arange(share.size), **{name: ("bin", values) for name, values in found.items()}}


def binomial_interval(
    successes: FloatArray, trials: FloatArray, confidence: float = 0.95
) -> tuple[FloatArray, FloatArray]:
    """Clopper and Pearson's interval (Biometrika 26, 1934) of a share; successes need not be whole."""
    tail = (1.0 - confidence) / 2
    low = beta.ppf(tail, successes, trials - successes + 1.0)
    high = beta.ppf(1.0 - tail, successes + 1.0, trials - successes)
    return np.where(successes <= 0.0, 0.0, low), np.where(successes >= trials, 1.0, high)
