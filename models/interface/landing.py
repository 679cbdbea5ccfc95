"""Slips at which the layers have landed: rubber that lifts lets go, and meets the other side anew, unsheared, where it
lands.

Of each of `CELLS` parts of a joint the mean slip m at landing over what touches of it, a length d, is kept. With the
slip x of the joint

    m' = (x - m) d'/d where more of the part touches, 0 where less does, m = x where nothing touches,

and the layer's force along the joint is rho_s (k (x L - integral of m over L) + c x'), L the length that presses, taken
at the end that is more compressed. A joint that has rocked need not return to where it was.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from models.base import FloatArray
from models.interface.effects import CELLS

BOUNDS = np.linspace(-1.0, 1.0, CELLS + 1)
"""Of the parts, over the half width."""


def lengths(b: FloatArray, low: FloatArray, high: FloatArray) -> FloatArray:
    """Of each part (..., `CELLS`) within [low, high] (m); arrays (...)."""
    bounds = np.asarray(b)[..., None] * BOUNDS
    within = np.minimum(np.asarray(high)[..., None], bounds[..., 1:]) - np.maximum(
        np.asarray(low)[..., None], bounds[..., :-1]
    )
    return np.asarray(np.maximum(within, 0.0))


def pressed(b: float, s: float, share: float) -> tuple[float, float]:
    """Ends (m) of what presses, a ``share`` of the joint, at S."""
    length = 2.0 * b * share
    return (b - length, b) if s >= 0.0 else (-b, length - b)


def rates(
    b: float, ends: tuple[float, float], motion: Sequence[float], slip: tuple[float, float], landed: FloatArray
) -> FloatArray:
    """m' (`CELLS`,) of one joint: what touches, S, z', S', the slip and its rate, m."""
    s, z_rate, s_rate = motion
    touching = lengths(np.array(b), np.array(ends[0]), np.array(ends[1]))
    found = np.where(touching > 0.0, 0.0, slip[1])
    front = ends[0] if s > 0.0 else ends[1]
    if s == 0.0 or not -b < front < b:
        return found
    speed = (z_rate - front * s_rate) / s
    growth = -speed if s > 0.0 else speed
    cell = min(max(int(np.searchsorted(b * BOUNDS, front)) - 1, 0), CELLS - 1)
    if growth > 0.0 and touching[cell] > 0.0:
        found[cell] = (slip[0] - landed[cell]) * growth / touching[cell]
    return found
