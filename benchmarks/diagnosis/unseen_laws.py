"""Laws of the evaluation that no catalogue lists and no development seed draws: written after the engine was frozen.

Their form is that of `open_laws`; a law that has been looked at case by case moves there.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from benchmarks.diagnosis.open_laws import LAWS, Law, no_numbers, uniform

SLIDES = 0.004
"""rad s-1 over which dry friction changes its sign."""
FADES = 4.0
"""s in which a stop wears out."""


@njit
def _right_drag(t, theta, rate, u, v, a, p, g):  # type: ignore[no-untyped-def]
    return -p[0] * rate * rate if rate > 0.0 else 0.0


@njit
def _progressive(t, theta, rate, u, v, a, p, g):  # type: ignore[no-untyped-def]
    return -p[0] * g[0] * theta * (theta / g[4]) ** 2


@njit
def _warming(t, theta, rate, u, v, a, p, g):  # type: ignore[no-untyped-def]
    return -p[0] * g[0] * g[1] * math.tanh(rate / SLIDES) * min(1.0, t / p[1])


@njit
def _structural(t, theta, rate, u, v, a, p, g):  # type: ignore[no-untyped-def]
    return -p[0] * g[0] * abs(theta) * math.tanh(rate / SLIDES)


@njit
def _humming(t, theta, rate, u, v, a, p, g):  # type: ignore[no-untyped-def]
    return p[0] * g[0] * g[1] * math.sin(2.0 * math.pi * p[1] * t)


@njit
def _pushing(t, theta, rate, u, v, a, p, g):  # type: ignore[no-untyped-def]
    return -p[0] * g[0] * max(a, 0.0) / g[2]


@njit
def _left_magnet(t, theta, rate, u, v, a, p, g):  # type: ignore[no-untyped-def]
    return p[0] * g[0] * g[1] * math.exp(theta / (p[1] * g[4])) if theta < 0.0 else 0.0


@njit
def _passing_loss(t, landing, p):  # type: ignore[no-untyped-def]
    return 1.0 - p[0] if p[4] < t < p[5] else 1.0


@njit
def _friction_band(t, theta, rate, u, v, a, p, g):  # type: ignore[no-untyped-def]
    inside = p[1] * g[4] < abs(theta) < (p[1] + 0.25) * g[4]
    return -p[0] * g[0] * g[1] * math.tanh(rate / SLIDES) if inside else 0.0


@njit
def _fading_stop(t, theta, rate, u, v, a, p, g):  # type: ignore[no-untyped-def]
    beyond = max(0.0, abs(theta) - p[1] * g[4])
    return -p[0] * g[0] * math.copysign(beyond, theta) * math.exp(-t / FADES)


@njit
def _pendulum(t, u, v, second, a, p):  # type: ignore[no-untyped-def]
    return -p[1] * p[1] * u - 0.1 * p[1] * v - a


@njit
def _under_a_pendulum(t, theta, rate, u, v, a, p, g):  # type: ignore[no-untyped-def]
    return p[0] * g[0] * p[1] * p[1] * u / g[2]


@njit
def _late_prop(t, theta, rate, u, v, a, p, g):  # type: ignore[no-untyped-def]
    return -p[0] * g[0] * theta if theta > 0.0 and t > p[4] else 0.0


@njit
def _shaken_guide(t, theta, rate, u, v, a, p, g):  # type: ignore[no-untyped-def]
    return -p[0] * rate * abs(a) / g[2]


def _slow(rng: np.random.Generator) -> tuple[float, float, float]:
    return float(2.0 * math.pi * rng.uniform(0.4, 1.0)), 0.0, 0.0


UNSEEN = {
    law.name: law
    for law in (
        Law("right_drag", "drag with the squared speed, to the right only", 15.0, no_numbers, _right_drag),
        Law("progressive_spring", "a spring with the cube of the rotation", 0.8, no_numbers, _progressive, either=True),
        Law("warming_guide", "dry friction that grows as a guide warms up", 0.3, uniform(5.0, 10.0), _warming),
        Law("structural_damping", "friction in proportion to the rotation", 0.5, no_numbers, _structural),
        Law("humming", "a machine shakes the block at its own frequency", 0.5, uniform(0.8, 3.0), _humming),
        Law("pushing_table", "the table pushes more than it pulls", 0.5, no_numbers, _pushing, either=True),
        Law("left_magnet", "an attraction to the upright position on the left", 0.8, uniform(0.1, 0.3), _left_magnet),
        Law("passing_loss", "impacts lose more for part of the time", 0.5, no_numbers, ratio=_passing_loss,
            effect="restitution"),
        Law("friction_band", "dry friction within a band of rotations", 0.5, uniform(0.1, 0.4), _friction_band),
        Law("fading_stop", "spring stops that wear out", 8.0, uniform(0.2, 0.4), _fading_stop),
        Law("slow_pendulum", "a slow pendulum pulls at the block", 1.0, _slow, _under_a_pendulum, _pendulum,
            either=True),
        Law("late_prop", "a spring on the right from some instant on", 0.8, no_numbers, _late_prop, lasts=True),
        Law("shaken_guide", "damping while the base accelerates", 10.0, no_numbers, _shaken_guide),
    )
}  # fmt: skip
EVERY_LAW = {**LAWS, **UNSEEN}
