"""Laws that no catalogue lists, and a few that act for a while only: those of the development seeds.

The evaluation has laws of its own, `unseen_laws`.

A law adds an angular acceleration to theta'', may change the restitution of single impacts, and may
carry a hidden freedom u (rate v). Its functions get

    p   0: size, 1-3: the law's own numbers, 4 and 5: begin and end (s) of its activity in this
        recording, 6: lever (m) by which an impact's jump of theta' jumps v
    g   p^2 (s-2), alpha (rad), gravity (m s-2), R (m), largest rotation without the law (rad)
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numba import njit

Draw = Callable[[np.random.Generator], tuple[float, float, float]]


@njit
def nothing(t, theta, rate, u, v, a, p, g):  # type: ignore[no-untyped-def]
    return 0.0


@njit
def still(t, u, v, second, a, p):  # type: ignore[no-untyped-def]
    return 0.0


@njit
def unchanged(t, landing, p):  # type: ignore[no-untyped-def]
    return 1.0


@dataclass(frozen=True)
class Law:
    """``end``: size up to which the nominal size is sought; ``either``: either sign of it.

    ``lever`` names the place of the lever of ``p`` (0: none). ``effect``: the class of the mechanism of the catalogue
    that it is, at work for a while in each recording: that is no law outside. ``lasts``: it acts to the end.
    """

    name: str
    sentence: str
    end: float
    draw: Draw
    couple: Any = nothing
    hidden: Any = still
    ratio: Any = unchanged
    either: bool = False
    lever: int = 0
    effect: str = ""
    lasts: bool = False

    def described(self, size: float) -> dict[str, Any]:
        """As an effect of a key."""
        return {"name": self.name, "class": self.effect or "open", "parameters": {"size": size}}

    @property
    def kind(self) -> str:
        """Of the case."""
        return "single" if self.effect else "open"


def no_numbers(rng: np.random.Generator) -> tuple[float, float, float]:
    return 0.0, 0.0, 0.0


def uniform(low: float, high: float) -> Draw:
    return lambda rng: (float(rng.uniform(low, high)), 0.0, 0.0)


@njit
def _right_damping(t, theta, rate, u, v, a, p, g):  # type: ignore[no-untyped-def]
    return -p[0] * rate if theta > 0.0 else 0.0


@njit
def _right_ratio(t, landing, p):  # type: ignore[no-untyped-def]
    return 1.0 - p[0] if landing > 0.0 else 1.0


@njit
def _passing_stiffness(t, theta, rate, u, v, a, p, g):  # type: ignore[no-untyped-def]
    return -p[0] * g[0] * theta if p[4] < t < p[5] else 0.0


@njit
def _stribeck(t, theta, rate, u, v, a, p, g):  # type: ignore[no-untyped-def]
    fast = p[1] * math.sqrt(g[0]) * g[1]
    return -p[0] * g[0] * g[1] * math.tanh(rate / 0.004) * math.exp(-((rate / fast) ** 2))


@njit
def _magnet(t, theta, rate, u, v, a, p, g):  # type: ignore[no-untyped-def]
    pull = p[0] * g[0] * g[1] * math.exp(-abs(theta) / (p[1] * g[4]))
    return -pull if theta > 0.0 else pull


@njit
def _right_stop(t, theta, rate, u, v, a, p, g):  # type: ignore[no-untyped-def]
    return -p[0] * g[0] * max(0.0, theta - p[1] * g[4])


@njit
def _slosh_force(t, theta, rate, u, v, a, p, g):  # type: ignore[no-untyped-def]
    force = p[1] * p[1] * u + 0.04 * p[1] * v
    return p[0] * (p[6] * force + g[2] * u) * g[0] / (g[2] * g[3])


@njit
def _slosh(t, u, v, second, a, p):  # type: ignore[no-untyped-def]
    return -p[1] * p[1] * u - 0.04 * p[1] * v - p[6] * second - a


@njit
def _periodic_ratio(t, landing, p):  # type: ignore[no-untyped-def]
    return 1.0 - p[0] * math.sin(math.pi * t / p[1]) ** 2


@njit
def _foundation(t, u, v, second, a, p):  # type: ignore[no-untyped-def]
    return -p[1] * p[1] * u - 0.1 * p[1] * v - p[0] * a


@njit
def _on_foundation(t, theta, rate, u, v, a, p, g):  # type: ignore[no-untyped-def]
    return g[0] * u - _foundation(t, u, v, 0.0, a, p)


@njit
def _passing_couple(t, theta, rate, u, v, a, p, g):  # type: ignore[no-untyped-def]
    return p[0] * g[0] * g[1] if p[4] < t < p[5] else 0.0


@njit
def _upright_damping(t, theta, rate, u, v, a, p, g):  # type: ignore[no-untyped-def]
    return -p[0] * rate if abs(theta) < p[1] * g[4] else 0.0


@njit
def _late_damping(t, theta, rate, u, v, a, p, g):  # type: ignore[no-untyped-def]
    return -p[0] * rate if t > p[4] else 0.0


@njit
def _snubber(t, theta, rate, u, v, a, p, g):  # type: ignore[no-untyped-def]
    return -p[0] * rate if abs(theta) > p[1] * g[4] and theta * rate > 0.0 else 0.0


def _sloshing(rng: np.random.Generator) -> tuple[float, float, float]:
    return float(2.0 * math.pi * rng.uniform(0.6, 2.0)), 1.6, 0.0


def _soil(rng: np.random.Generator) -> tuple[float, float, float]:
    return float(2.0 * math.pi * rng.uniform(2.5, 5.0)), 0.0, 0.0


LAWS = {
    law.name: law
    for law in (
        Law("right_damping", "a dashpot works for theta > 0 only", 4.0, no_numbers, _right_damping),
        Law("right_restitution", "landings on the right corner lose more", 0.5, no_numbers, ratio=_right_ratio),
        Law("passing_stiffness", "a spring holds for part of the time", 0.5, no_numbers, _passing_stiffness,
            either=True, effect="added_stiffness"),
        Law("stribeck_guide", "a guide whose friction fades with speed", 0.4, uniform(0.1, 0.3), _stribeck),
        Law("magnet", "an attraction near the upright position", 0.8, uniform(0.1, 0.3), _magnet),
        Law("right_stop", "a spring stop on one side", 6.0, uniform(0.2, 0.45), _right_stop),
        Law("sloshing", "a mass swings on top", 0.3, _sloshing, _slosh_force, _slosh, lever=2),
        Law("periodic_restitution", "restitution comes and goes", 0.5, uniform(4.0, 8.0),
            ratio=_periodic_ratio),
        Law("foundation", "the foundation rocks with a frequency of its own", 6.0, _soil, _on_foundation,
            _foundation, either=True),
        Law("passing_couple", "a steady couple for part of the time", 0.6, no_numbers, _passing_couple, either=True),
        Law("upright_damping", "damping only near the upright position", 8.0, uniform(0.15, 0.35), _upright_damping),
        Law("late_damping", "a dashpot from some instant on", 1.0, no_numbers, _late_damping,
            effect="viscous_damping", lasts=True),
        Law("snubber", "damping on the way out beyond a gap", 10.0, uniform(0.25, 0.5), _snubber),
    )
}  # fmt: skip
