"""The step of a fit whose coordinates have bounds: the least of a quadratic between them.

A step that is cut at a bound, coordinate by coordinate, is no step of the others: it may gain nothing where much is to
be gained, and a fit would end there.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import lsq_linear

from models.base import FloatArray

LEAST = 1e-12
"""Curvature, over the largest of coordinates of like size, under which a direction counts as flat."""


def bounded_step(
    hessian: FloatArray, gradient: FloatArray, low: FloatArray, high: FloatArray, damping: float = 0.0
) -> FloatArray:
    """The step s (k,) that makes g's + s'(H + damping diag H) s/2 least within ``low`` <= s <= ``high``.

    ``low`` (k,) at most 0 and ``high`` (k,) at least 0, infinite where there is no bound.
    """
    held = ((low >= 0.0) & (gradient > 0.0)) | ((high <= 0.0) & (gradient < 0.0))
    free = np.flatnonzero(~held)
    step = np.zeros(gradient.size)
    if not free.size:
        return step
    part = hessian[np.ix_(free, free)]
    scale = np.diag(part) + 1e-9 * (np.max(np.diag(part)) + LEAST)
    damped = part + damping * np.diag(scale) + LEAST * np.eye(free.size)
    step[free] = -np.linalg.solve(damped, gradient[free])
    if np.all((low <= step) & (step <= high)):
        return step
    return _within(hessian, gradient, low, high, damping)


def _within(hessian: FloatArray, gradient: FloatArray, low: FloatArray, high: FloatArray, damping: float) -> FloatArray:
    """The same where bounds are in the way, by least squares in coordinates of like curvature."""
    scale = np.diag(hessian) + 1e-9 * (np.max(np.diag(hessian)) + LEAST)
    size = np.sqrt(scale)
    values, vectors = np.linalg.eigh(hessian / np.outer(size, size) + damping * np.eye(size.size))
    root = np.sqrt(np.maximum(values, LEAST * values[-1]))
    step = np.zeros(gradient.size)
    open_ = low < high
    factor = (root[:, None] * vectors.T)[:, open_]
    target = -(vectors.T @ (gradient / size)) / root
    found = lsq_linear(factor, target, ((low * size)[open_], (high * size)[open_]), method="bvls")
    step[open_] = found.x / size[open_]
    return np.clip(step, low, high)
