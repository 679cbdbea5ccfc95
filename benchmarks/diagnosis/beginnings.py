"""Effects that begin or end: things that happen to a specimen or its instruments in a sequence of tests.

The sequence is train_1, train_2, test_1. An interval (s) of a recording is one in which the effect acts; sizes are
nominal over the windows of the training recording that shows it best, as ever.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from benchmarks.diagnosis.suite import CaseDesign, Kind, in_mixed_order
from models.shaking import Shaking

Intervals = tuple[tuple[float, float], ...]
When = tuple[Intervals, Intervals, Intervals]
"""Intervals by recording."""
NOISE = 0.005
EACH = 4
NULLS = 10
INSTANT = (0.2, 0.6)
"""Share of the integral of the squared base acceleration at which something begins or ends."""
WHILE = 3.0
"""s for which something lasts that comes and goes."""


def _whole(duration: float) -> Intervals:
    return ((0.0, duration),)


def _from_train_1(at: Sequence[float], durations: Sequence[float]) -> When:
    return ((at[0], durations[0]),), _whole(durations[1]), _whole(durations[2])


def _from_train_2(at: Sequence[float], durations: Sequence[float]) -> When:
    return (), ((at[1], durations[1]),), _whole(durations[2])


def _to_train_2(at: Sequence[float], durations: Sequence[float]) -> When:
    return _whole(durations[0]), ((0.0, at[1]),), ()


def _within_train_1(at: Sequence[float], durations: Sequence[float]) -> When:
    return ((at[0], min(at[0] + WHILE, durations[0])),), (), ()


def _in_each(at: Sequence[float], durations: Sequence[float]) -> When:
    first, second, third = (((a, min(a + WHILE, d)),) for a, d in zip(at, durations, strict=True))
    return first, second, third


def _train_1_alone(at: Sequence[float], durations: Sequence[float]) -> When:
    return _whole(durations[0]), (), ()


def _train_2_alone(at: Sequence[float], durations: Sequence[float]) -> When:
    return (), _whole(durations[1]), ()


def _from_train_2_whole(at: Sequence[float], durations: Sequence[float]) -> When:
    return (), _whole(durations[1]), _whole(durations[2])


@dataclass(frozen=True)
class Beginning:
    """What happens: the effect by its name in the catalogue, when, and (where not either) the end of its range."""

    name: str
    effect: str
    when: Callable[[Sequence[float], Sequence[float]], When]
    ends: tuple[float, ...] = ()


BEGINNINGS = {
    one.name: one
    for one in (
        Beginning("a joint cracks", "restitution", _from_train_2, (0.5,)),
        Beginning("a corner spalls", "pivot_inset", _from_train_1),
        Beginning("a strap slips off", "added_stiffness", _to_train_2, (0.5,)),
        Beginning("a sensor is knocked", "offset", _from_train_2),
        Beginning("a range is switched", "gain", _train_2_alone),
        Beginning("a guide rubs for a while", "coulomb_damping", _within_train_1),
        Beginning("the base settles", "tilt", _from_train_2),
        Beginning("the base's accelerometer comes loose", "base_gain", _from_train_1),
        Beginning("a logger starts late", "delay", _from_train_2_whole),
        Beginning("a damper is taken off", "viscous_damping", _train_1_alone),
        Beginning("a strap tightens in every test", "added_stiffness", _in_each, (0.5,)),
        Beginning("a guide rubs in every test", "coulomb_damping", _in_each),
    )
}


def draw(name: str, motions: Sequence[Shaking], rng: np.random.Generator) -> When:
    """In which intervals (s) of recordings under these base motions the effect acts."""
    at = []
    for motion in motions:
        energy = np.cumsum(motion.horizontal**2)
        at.append(motion.time_step * int(np.searchsorted(energy, float(rng.uniform(*INSTANT)) * energy[-1])))
    return BEGINNINGS[name].when(at, [motion.duration for motion in motions])


def suite(seed: int) -> list[CaseDesign]:
    """Every kind as often as every other one, and nulls among them, in the order in which they are run."""
    rng = np.random.default_rng(seed)
    kinds = [str(one) for _ in range(EACH) for one in rng.permutation(list(BEGINNINGS))]
    groups: list[list[tuple[Kind, str]]] = [[("single", name) for name in kinds], [("null", "")] * NULLS]
    return [
        CaseDesign(number, kind, (BEGINNINGS[name].effect,) if name else (), NOISE, 1.0, beginning=name)
        for number, (kind, name) in enumerate(in_mixed_order(groups, rng))
    ]
