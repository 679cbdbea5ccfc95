"""The exact strip of `models.interface.strip`, without branches, with its stiffness in contact.

Mirrored so that the body leans to +x: w(x) = z - x |S|, contact from z/|S| on, stress Y0 - x Y1 with
Y0 = k z + c z', Y1 = k |S| + c sign(S) S'. Both quotients, of both strips of a wall, come from one
division: `slopes` of each strip, the inverse of the product, then `resultants`.
"""

from __future__ import annotations

from models.lanes.compiler import inlined

TINY = 1e-60
"""Keeps a quotient finite where its denominator vanishes; the result is then cut to the strip's ends."""


@inlined
def slopes(k: float, c: float, s: float, s_rate: float) -> tuple[float, float, float, float]:
    """sign(S), |S|, Y1, and Y1 kept off zero."""
    side = 1.0 if s >= 0.0 else -1.0
    lean = abs(s) + TINY
    y1 = k * lean + c * side * s_rate
    tiny = TINY if y1 >= 0.0 else -TINY
    return side, lean, y1, y1 if y1 * y1 > TINY else tiny


@inlined
def resultants(
    b: float, clip: float, z: float, y0: float, side: float, lean: float, y1: float, steep: float, inverse: float
) -> tuple[float, float, float, float, float]:
    """N, M and the integrals d1, d2, d3 of 1, x, x^2 over the stretch that presses.

    ``inverse`` = 1/(lean steep); ``clip`` 1 for dashpot law B, 0 for A.
    """
    edge = y0 * lean * inverse
    low = max(z * steep * inverse, edge if (y1 >= 0.0) & (clip > 0.0) else -b)
    low = min(max(low, -b), b)
    high = max(min(b, edge if (y1 < 0.0) & (clip > 0.0) else b), low)
    d1 = high - low
    d2 = 0.5 * d1 * (high + low)
    d3 = d1 * (high * high + high * low + low * low) * (1.0 / 3.0)
    return y1 * d2 - y0 * d1, side * (y1 * d3 - y0 * d2), d1, side * d2, d3
