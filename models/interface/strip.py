"""The exact no-tension strip under a rigid body: closed form.

Half width b; spring k (N m-2) and dashpot c (N s m-2) per unit length. The body's underside lies at
w(x) = z - x S over the unstressed layer, S the sine of its rotation; contact where w < 0. The stress
-(Y0 - x Y1), Y0 = k z + c z', Y1 = k S + c S', positive in compression, may pull under dashpot law A
and is clipped at zero under law B.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from models.base import FloatArray

OPEN = (0.0, 0.0)


class Strip(NamedTuple):
    """Resultants of one strip: N (N, up), M (N m, restoring) and the share of the length that presses.

    ``landed``: integral (m2) over what presses of the slip at landing, of layers that give way along the joint.
    """

    force: float
    moment: float
    share: float
    landed: float = 0.0


def touching(ends: tuple[float, float], z: float, s: float) -> tuple[float, float]:
    """The stretch between ``ends`` on which z - x s < 0."""
    low, high = ends
    if s > 0.0:
        low = max(low, z / s)
    elif s < 0.0:
        high = min(high, z / s)
    elif z >= 0.0:
        return OPEN
    return (low, high) if low < high else OPEN


def pressing(
    ends: tuple[float, float], k: float, c: float, z: float, s: float, z_rate: float, s_rate: float, clip: bool
) -> tuple[float, float]:
    """The stretch that carries stress: in contact, and under law B (``clip``) not pulled."""
    low, high = touching(ends, z, s)
    if not clip:
        return low, high
    y0, y1 = k * z + c * z_rate, k * s + c * s_rate
    if y1 == 0.0:
        return (low, high) if y0 < 0.0 else OPEN
    edge = y0 / y1
    low, high = (max(low, edge), high) if y1 > 0.0 else (low, min(high, edge))
    return (low, high) if low < high else OPEN


def resultants(
    stretch: tuple[float, float], k: float, c: float, z: float, s: float, z_rate: float, s_rate: float
) -> tuple[float, float]:
    """N = -(Y0 d1 - Y1 d2) and M = -(Y0 d2 - Y1 d3), d_n = [x^n/n], of all of a stretch."""
    low, high = stretch
    d1, d2, d3 = high - low, (high**2 - low**2) / 2.0, (high**3 - low**3) / 3.0
    y0, y1 = k * z + c * z_rate, k * s + c * s_rate
    return -(y0 * d1 - y1 * d2), -(y0 * d2 - y1 * d3)


def strip(
    b: float, k: float, c: float, z: float, s: float, z_rate: float = 0.0, s_rate: float = 0.0, clip: bool = True
) -> Strip:
    """Resultants of the linear law on [-b, b]."""
    stretch = pressing((-b, b), k, c, z, s, z_rate, s_rate, clip)
    return Strip(*resultants(stretch, k, c, z, s, z_rate, s_rate), (stretch[1] - stretch[0]) / (2.0 * b))


def stored(b: FloatArray, k: FloatArray, z: FloatArray, s: FloatArray) -> FloatArray:
    """Elastic energy of the linear law, k/2 times the integral of w^2 over the contact, in J; arrays broadcast."""
    lean = np.abs(s)
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        low = np.where(z + lean * b <= 0.0, -b, np.minimum(b, np.maximum(-b, z / lean)))
    d1, d2, d3 = b - low, (b * b - low * low) / 2.0, (b * b * b - low * low * low) / 3.0
    energy = 0.5 * k * (z * z * d1 - 2.0 * z * lean * d2 + lean * lean * d3)
    return np.asarray(np.where(d1 > 0.0, energy, 0.0 * energy), dtype=np.float64)
