"""The step of a fit whose coordinates have bounds.

Newton's step is cut at the bounds, coordinate by coordinate, as long as that promises to gain. Where it does not, it is
no step for the other coordinates, and a fit that took it for the last word would end there: then the step is the least
of the quadratic within the bounds.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import lsq_linear

from models.base import FloatArray

LEAST = 1e-12
"""Curvature, over the largest of coordinates of like size, under which a direction counts as flat."""
STEPS = 20
"""Changes of the coordinates at bounds, over the number of coordinates, until the least is found at the latest."""


def bounded_step(
    hessian: FloatArray, gradient: FloatArray, low: FloatArray, high: FloatArray, damping: float = 0.0
) -> FloatArray:
    """The step s (k,) within ``low`` <= s <= ``high`` along which q(s) = g's + s'(H + damping diag H) s/2 falls.

    ``low`` (k,) at most 0 and ``high`` (k,) at least 0, infinite where there is no bound; zero where q is least at 0.
    """
    free = np.flatnonzero(~(((low >= 0.0) & (gradient > 0.0)) | ((high <= 0.0) & (gradient < 0.0))))
    step, scale = np.zeros(gradient.size), np.diag(hessian) + 1e-9 * (np.max(np.diag(hessian), initial=0.0) + LEAST)
    damped = hessian + damping * np.diag(scale)
    if free.size:
        step[free] = -np.linalg.solve(damped[np.ix_(free, free)] + LEAST * np.eye(free.size), gradient[free])
    inside = np.clip(step, low, high)
    if np.array_equal(inside, step) or gradient @ inside + 0.5 * inside @ damped @ inside < 0.0:
        return inside
    return _least(damped, gradient, low, high)


def _least(hessian: FloatArray, gradient: FloatArray, low: FloatArray, high: FloatArray) -> FloatArray:
    """Where g's + s'H s/2 is least within the bounds, by least squares in coordinates of like curvature."""
    size = np.sqrt(np.maximum(np.diag(hessian), LEAST * np.max(np.diag(hessian))))
    values, vectors = np.linalg.eigh(hessian / np.outer(size, size))
    root = np.sqrt(np.maximum(values, LEAST * values[-1]))
    step, opened = np.zeros(gradient.size), low < high
    factor, target = (root[:, None] * vectors.T)[:, opened], -(vectors.T @ (gradient / size)) / root
    ends = ((low * size)[opened], (high * size)[opened])
    step[opened] = lsq_linear(factor, target, ends, method="bvls", max_iter=STEPS * step.size).x / size[opened]
    return np.clip(step, low, high)
