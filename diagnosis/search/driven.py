"""What is missing may have a frequency of its own: an oscillator that the base drives, beside a law in a table.

A foundation on soft ground or a mass that swings on top pushes the block by its own motion, which remembers what the
base did before: no table over the present state holds it. The base's motion is known, so the oscillator runs through
the whole recording (`models.oscillator`), and only its gains, frequency and damping are unknown. A score over a
grid of frequencies says where to begin; then all are fitted with everything else.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Literal

import numpy as np

from diagnosis.fit.misfit import Misfit, project, reduce
from diagnosis.fit.solver import fit, fit_thoroughly, normal
from diagnosis.fit.unknowns import Unknown, without_instruments
from diagnosis.search.refit import QUICK, Explanation, best_of
from diagnosis.search.tables import form_of
from models.base import FloatArray, Mechanism

FREQUENCIES = np.geomspace(0.3, 15.0, 40)
"""Hz that are scored."""
STARTS = 3
"""Of them, the likeliest ones from which a fit begins, each at a peak of the score."""
DAMPING = 0.05
SMALL = 0.02
"""Gain by which the score's derivative is taken."""
RIDGE = 1e-3
"""Of the information about both gains, which are alike far below the oscillator's frequency."""
SCALES = (0.1, 0.1, 0.05, 0.3)
"""Of the coordinates of both gains, and of the logarithms of frequency and damping."""
WORTH = 25.0
"""Loss that an oscillator must take off to be tried: four parameters, and the choice of a frequency."""


def with_oscillator(explanation: Explanation) -> Explanation | None:
    """The explanation with an oscillator beside it; None where it is not worth it, or the model has none."""
    f = explanation.fitted
    form = form_of(f.measured.model)
    if form is None or form.tabulated is None or not form.tabulated.oscillator:
        return None
    names = [f"{form.name}.{name}" for name in form.tabulated.oscillator]
    off = {f"{form.name}.{p.name}": p.null for p in form.parameters}
    misfit = replace(f.misfit, fixed={**f.misfit.fixed, **off})
    on = {**without_instruments(f.point.values), **off, names[0]: SMALL}
    if f.measured.model.check(on, f.misfit.predictor.options):
        return None
    scores, sizes = _scores(misfit, f.u, f.states, names)
    peaks = [k for k in range(scores.size) if scores[k] == scores[max(0, k - 1) : k + 2].max()]
    fits = []
    for k in sorted(peaks, key=lambda k: -scores[k])[:STARTS]:
        unknowns = oscillator(form, float(FREQUENCIES[k]))
        grown = replace(misfit, unknowns=(*misfit.unknowns, *unknowns))
        start = [x.coordinate(x.start) for x in unknowns]
        start[:2] = (x.coordinate(float(np.clip(size, -1.0, 1.0))) for x, size in zip(unknowns, sizes[k], strict=False))
        fits.append(replace(explanation, fitted=fit(grown, np.concatenate([f.u, start]), f.states, QUICK)))
    best = best_of(fits)
    best = replace(best, fitted=fit_thoroughly(best.fitted.misfit, best.fitted.u, best.fitted.states))
    return best if explanation.loss - best.loss > WORTH else None


def oscillator(form: Mechanism, frequency: float) -> tuple[Unknown, ...]:
    """Both gains, frequency and damping as unknowns of a fit that begins at ``frequency`` (Hz)."""
    assert form.tabulated is not None
    found = []
    for name, scale in zip(form.tabulated.oscillator, SCALES, strict=True):
        p = form.parameter(name)
        start = {"Hz": frequency}.get(p.unit, DAMPING) if p.shape else 0.0
        kind: Literal["linear", "log"] = "log" if p.shape else "linear"
        found.append(Unknown(f"{form.name}.{name}", p.unit, p.low, p.high, start, scale, kind))
    return tuple(found)


def _scores(
    misfit: Misfit, u: FloatArray, states: FloatArray, names: Sequence[str]
) -> tuple[FloatArray, FloatArray]:  # fmt: skip
    """What a small oscillator of each frequency would take off the loss (F,), and its gains that do (F, 2)."""
    linear = misfit.linearise(u, states)
    reduced, weights = reduce(linear), misfit.weights(linear.residual)
    hessian, gradient = normal(misfit, reduced, weights, u)
    inverse = np.linalg.pinv(hessian)
    here = misfit.point(u, states)
    motion, force, frequency, damping = names
    points = [
        replace(here, values={**here.values, gain: side * SMALL, frequency: float(at), damping: DAMPING})
        for at in FREQUENCIES
        for gain in (motion, force)
        for side in (-1.0, 1.0)
    ]
    ends = misfit.residuals(points)
    columns = np.moveaxis((ends[1::2] - ends[::2]) / (2.0 * SMALL), 0, -1)
    if linear.by_state.shape[-1]:
        columns = project(reduced.basis, columns)
    weighted = weights[:, None, None] * columns
    along = np.einsum("wmi,wmk->ik", reduced.by_unknown, weighted, optimize=True)
    slope = np.einsum("wmk,wm->k", weighted, reduced.residual, optimize=True) - along.T @ (inverse @ gradient)
    whole = np.einsum("wmj,wmk->jk", weighted, columns, optimize=True) - along.T @ inverse @ along
    scores, sizes = np.zeros(FREQUENCIES.size), np.zeros((FREQUENCIES.size, 2))
    for k in range(FREQUENCIES.size):
        own = slice(2 * k, 2 * k + 2)
        part = whole[own, own] + RIDGE * np.diag(np.diag(whole[own, own])) + 1e-300 * np.eye(2)
        sizes[k] = -np.linalg.solve(part, slope[own])
        scores[k] = -slope[own] @ sizes[k]
    return scores, sizes
