"""Sine, cosine and exponential without branches, so that a loop over lanes becomes vector code.

Polynomials through Chebyshev nodes on [0, 1.75^2] in the squared argument; absolute errors
6e-16 (sine over argument), 3e-17 (cosine). Plain Python here; `models.lanes.compiler` compiles what calls them.
"""

from __future__ import annotations


def sine_cosine(x: float) -> tuple[float, float]:
    """sin(x), cos(x) for |x| <= 1.75 rad."""
    y = x * x
    sine = -7.309987323254257e-13
    sine = sine * y + 1.604238121361749e-10
    sine = sine * y - 2.5051678064898677e-08
    sine = sine * y + 2.7557313058446525e-06
    sine = sine * y - 0.0001984126979326274
    sine = sine * y + 0.008333333333149685
    sine = sine * y - 0.1666666666666399
    sine = sine * y + 0.9999999999999993
    cosine = 4.568718846414238e-14
    cosine = cosine * y - 1.145872781571358e-11
    cosine = cosine * y + 2.087638612463356e-09
    cosine = cosine * y - 2.755731254424913e-07
    cosine = cosine * y + 2.4801587230862747e-05
    cosine = cosine * y - 0.0013888888888468065
    cosine = cosine * y + 0.04166666666665412
    cosine = cosine * y - 0.49999999999999856
    cosine = cosine * y + 1.0
    return x * sine, cosine


def exponential_decay(u: float) -> float:
    """exp(-u) for u >= 0 (0 beyond 40, where it is under 5e-18), to 2e-14 relative.

    exp(-u/64) by its series, squared six times.
    """
    v = min(u, 40.0) * (-1.0 / 64.0)
    e = 1.0 / 3628800.0
    e = e * v + 1.0 / 362880.0
    e = e * v + 1.0 / 40320.0
    e = e * v + 1.0 / 5040.0
    e = e * v + 1.0 / 720.0
    e = e * v + 1.0 / 120.0
    e = e * v + 1.0 / 24.0
    e = e * v + 1.0 / 6.0
    e = e * v + 0.5
    e = e * v + 1.0
    e = e * v + 1.0
    e *= e
    e *= e
    e *= e
    e *= e
    e *= e
    e *= e
    return e
