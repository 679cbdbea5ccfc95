"""Samples at a uniform step: what every measured series is checked for."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from models.errors import InputError

FloatArray = NDArray[np.float64]

SHORTEST = 10
"""Fewest samples of a series: fewer are a damaged file, not a record."""
FINEST = 1e-6
"""Shortest time step, s."""
CHANGED = 0.2
"""Share of the step by which one of two even parts of a record differs from the other."""
JITTER = 0.01
"""Largest departure of one interval from the mean step, as a share of the step."""


def check_step(time_step: float, where: str) -> float:
    """A time step that a recorder can have, `FINEST` to one second, s."""
    if not (math.isfinite(time_step) and FINEST <= time_step <= 1.0):
        raise InputError(f"{where}: time step is {time_step:.9g} s: give one from {FINEST:g} to 1 s")
    return time_step


def uniform_step(times: FloatArray, where: str, cure: str = "resample the record to one step") -> float:
    """The step of uniform sampling times (n,), s; ``cure`` ends the sentence about other times."""
    if times.size < SHORTEST:
        raise InputError(f"{where}: has {times.size} sample(s), fewer than {SHORTEST}: is the file cut short?")
    if not np.isfinite(times).all():
        first = int(np.flatnonzero(~np.isfinite(times))[0])
        raise InputError(f"{where}: time of sample {first + 1} is not finite: repair the time column")
    intervals = np.diff(times)
    _check_order(times, intervals, where)
    step = float((times[-1] - times[0]) / (times.size - 1))
    check_step(step, where)
    worst = int(np.argmax(np.abs(intervals - step)))
    if abs(intervals[worst] - step) > JITTER * step:
        raise InputError(
            f"{where}: sampling is not uniform, the step is {intervals[worst]:.6g} s at "
            f"{times[worst]:.6g} s and {step:.6g} s on average: {cure}"
        )
    return _rounded(step)


def _check_order(times: FloatArray, intervals: FloatArray, where: str) -> None:
    """A clock that stands, runs back, or leaves samples out is no matter of jitter."""
    back = int(np.argmin(intervals))
    if intervals[back] <= 0.0:
        raise InputError(
            f"{where}: the clock goes from {times[back]:.6g} s to {times[back + 1]:.6g} s at sample "
            f"{back + 2}: it was reset or a line stands twice, split the record there"
        )
    change = int(np.argmax(np.abs(np.diff(intervals)))) + 1
    parts = intervals[:change], intervals[change:]
    before, after = (float(np.median(part)) for part in parts)
    even = all(part.size > 2 and np.ptp(part) < CHANGED * min(before, after) for part in parts)
    if even and abs(before - after) > CHANGED * max(before, after):
        raise InputError(
            f"{where}: the step changes from {before:.6g} s to {after:.6g} s at {times[change]:.6g} s: split the "
            "record there, or resample it to one step"
        )
    gap, usual = int(np.argmax(intervals)), float(np.median(intervals))
    if intervals[gap] > 1.5 * usual:
        missing = round(float(intervals[gap]) / usual) - 1
        raise InputError(
            f"{where}: about {missing} sample(s) are missing between {times[gap]:.6g} s and "
            f"{times[gap + 1]:.6g} s: cut the record there (gaps are not filled)"
        )


def _rounded(step: float) -> float:
    """The short decimal number, or whole rate, that a step computed from stored times stands for."""
    for candidate in (float(f"{step:.6g}"), 1.0 / round(1.0 / step, 3)):
        if abs(candidate / step - 1.0) < 1e-7:
            return candidate
    return step


def parse_numbers(tokens: Sequence[str], where: str) -> FloatArray:
    """Numbers from words; an InputError that names the first word that is none."""
    try:
        return np.array(tokens, dtype=np.float64)
    except ValueError:
        for number, token in enumerate(tokens, start=1):
            try:
                float(token)
            except ValueError:
                raise InputError(
                    f"{where}: value {number} is {token!r}, not a number: the file is damaged, fetch it again"
                ) from None
        raise
