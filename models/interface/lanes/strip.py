"""The exact strip of `models.interface.strip`, without branches, with its stiffness in contact.

The stretch that presses is found mirrored, so that the body leans to +x: w(x) = z - x |S|, contact from
z/|S| on, stress Y0 - x Y1 with Y0 = k z + c z', Y1 = sign(S) (k S + c S'). Both quotients, of both strips
of a wall, come from one division: `slopes` of each strip, the inverse of the product, then `resultants`.
"""

from __future__ import annotations

from models.lanes.compiler import inlined

TINY = 1e-60
"""Keeps a quotient finite where its denominator vanishes; the result is then cut to the strip's ends."""


@inlined
def slopes(k: float, c: float, s: float, s_rate: float) -> tuple[float, float, float]:
    """k S + c S', the mirrored Y1 kept off zero, and |S| kept off zero."""
    slope = k * s + c * s_rate
    y1 = slope if s >= 0.0 else -slope
    return slope, y1 if abs(y1) > 1e-30 else TINY, abs(s) + TINY


@inlined
def resultants(
    b: float, clip: float, z: float, y0: float, s: float, slope: float, steep: float, lean: float, inverse: float,
    stiff: float,
) -> tuple[float, float, float, float, float, float]:  # fmt: skip
    """N, M, the integrals of ``stiff`` times 1, x, x^2 over the stretch that presses, and its length.

    ``inverse`` = 1/(lean steep); ``clip`` 1 for dashpot law B, 0 for A. With the stretch's length d and
    middle m: N = d (Y1 m - Y0), M = m N + Y1 d^3/12.
    """
    edge = y0 * lean * inverse
    low = max(z * steep * inverse, edge if (steep >= 0.0) & (clip > 0.0) else -b)
    low = min(max(low, -b), b)
    high = max(min(b, edge if (steep < 0.0) & (clip > 0.0) else b), low)
    length, middle = high - low, 0.5 * (high + low)
    middle = middle if s >= 0.0 else -middle
    own = length * length * length * (1.0 / 12.0)
    force = length * (slope * middle - y0)
    first = stiff * length
    second = first * middle
    return force, middle * force + slope * own, first, second, second * middle + stiff * own, length
