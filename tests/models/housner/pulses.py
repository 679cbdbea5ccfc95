"""Pulses whose record is as good as the closed form, and thresholds of overturning by bisection.

A record is linear between samples. The samples below are not the pulse's values but those of the
piecewise linear function nearest to it in the mean square: it has the same impulse and the same first
moment as the pulse, so that the response converges with the fourth power of the step instead of the
second. A jump at the first or last sample is exact (the base is at rest outside of the record).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from scipy.linalg import solveh_banded

from models.base import FloatArray
from models.shaking import Shaking
from tests.models.housner.adapter import MODEL, outcomes

LANES = 32


def sampled(function: Callable[[FloatArray], FloatArray], duration: float, steps: int) -> Shaking:
    """The record of ``function`` on [0, duration] by Galerkin projection on hat functions."""
    h = duration / steps
    points, weights = np.polynomial.legendre.leggauss(6)
    x = (points + 1) / 2
    values = function((np.arange(steps)[:, None] + x) * h) * weights / 2 * h
    load = np.zeros(steps + 1)
    load[:-1] += values @ (1 - x)
    load[1:] += values @ x
    bands = np.full((2, steps + 1), 2 * h / 3)
    bands[0], bands[1, [0, -1]] = h / 6, h / 3
    return Shaking(h, solveh_banded(bands, load))


def constant(duration: float, steps: int) -> Shaking:
    return Shaking(duration / steps, np.ones(steps + 1))


def threshold(
    values: Mapping[str, float],
    shaking: Shaking,
    low: float,
    high: float,
    *,
    digits: float,
    linear: bool = False,
    overturns_above: bool = True,
    integrator: str = "lanes",
) -> float:
    """Scale at which overturning starts (or ends) between ``low`` and ``high``, to ``digits`` relative.

    Each round runs 32 lanes over the bracket. Close to a threshold the block lingers near its unstable
    equilibrium for ln(1/distance)/p, which sets the free motion allowed after the pulse.
    """
    p = float(MODEL.derive(values)["frequency_parameter"][0])
    while True:
        scale = np.linspace(low, high, LANES)
        close = (high - low) / (LANES * high)
        tail = (np.log(1.0 / close) + 8.0) / p
        found = outcomes(integrator, values, shaking, scale, tail=tail, linear=linear, outputs=["overturned"])
        over = found["overturned"]
        beyond = over == (1 if overturns_above else 0)
        first = int(np.argmax(beyond))
        assert not beyond[0], f"beyond the threshold already at {low}"
        assert beyond[first], f"not beyond the threshold even at {high}"
        assert np.all(beyond[first:]), f"more than one change between {low} and {high}"
        low, high = float(scale[first - 1]), float(scale[first])
        if high - low < digits * high:
            return 0.5 * (low + high)
