"""Pulses of ground acceleration: closed forms, sampled so that impulse and peak are kept.

A motion is linear between samples and zero outside of them. A pulse that jumps (rectangular, cosine)
is exact in this where the jump falls on the first or the last sample; so ``lead`` and ``rest`` are
zero unless asked for. With a lead or a rest, the sample at the jump takes the mean of both sides: the
impulse of the jump stays exact, and the jump takes two steps. Between samples a sinusoid
is off by at most (2 pi f time_step)^2 / 8 of its amplitude, 3e-5 at the default step.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from grids.files import Schema, check
from grids.motions.base import Motion
from grids.sampling import check_step
from grids.units import to_si
from models.errors import InputError, nearest

FloatArray = NDArray[np.float64]

STEPS_A_PERIOD = 400
"""Default steps per period 1/frequency."""


@dataclass(frozen=True)
class Shape:
    """``value(f t, periods)`` for amplitude 1, over a pulse of ``periods`` / frequency."""

    equation: str
    value: Callable[[FloatArray, float], FloatArray]
    periods: float
    repeats: bool = False


def _ricker(phase: FloatArray, periods: float) -> FloatArray:
    squared = (np.pi * (phase - periods / 2)) ** 2
    return np.asarray((1.0 - 2.0 * squared) * np.exp(-squared))


SHAPES: Mapping[str, Shape] = {
    "rectangular": Shape("a = A, for 1/(2 f)", lambda x, _: np.ones_like(x), 0.5),
    "half_sine": Shape("a = A sin(2 pi f t), for 1/(2 f)", lambda x, _: np.sin(2 * np.pi * x), 0.5),
    "sine": Shape("a = A sin(2 pi f t), for cycles/f", lambda x, _: np.sin(2 * np.pi * x), 1.0, True),
    "cosine": Shape("a = A cos(2 pi f t), for cycles/f", lambda x, _: np.cos(2 * np.pi * x), 1.0, True),
    # Ricker, Bull. Seism. Soc. Am. 33 (1943); below 1e-8 A where it is cut, 1.5/f from its centre
    "ricker": Shape("a = A (1 - 2 s^2) exp(-s^2), s = pi f (t - 1.5/f), for 3/f", _ricker, 3.0),
}


class Pulse(Schema):
    """The table ``pulse = {...}`` of a plan; exactly one of ``frequency`` and ``duration``."""

    shape: str
    amplitude: str | float
    frequency: str | float | None = None
    duration: str | float | None = None
    cycles: float | None = None
    time_step: str | float | None = None
    lead: str | float = 0.0
    rest: str | float = 0.0
    name: str | None = None


def _positive(value: object, unit: str, where: str) -> float:
    number = to_si(value, unit, where)
    if not (math.isfinite(number) and number > 0.0):
        raise InputError(f"{where} is {value!r}: give a positive finite value in {unit}")
    return number


def _steps(length: float, step: float, what: str) -> int:
    """How many steps make ``length``; a part of a step would shift the end of the pulse."""
    count = round(length / step)
    if abs(count * step - length) > 1e-6 * step:
        cure = length / math.ceil(length / step)
        raise InputError(
            f"pulse: time_step {step:.9g} s does not divide the {what} of {length:.9g} s: "
            f"give for instance {cure:.9g} s"
        )
    return count


def _check_length(length: float, step: float) -> None:
    from models.lanes.record import MOST_STEPS

    if not length / step <= MOST_STEPS:
        raise InputError(
            f"pulse: {length:.4g} s with its lead and rest take {length / step:.3g} steps of {step:.3g} s, more than "
            f"{MOST_STEPS:.0e}: shorten it, or give a longer time_step"
        )


def make_pulse(table: Mapping[str, Any]) -> Motion:
    """The motion of a pulse: shape, amplitude ("0.3 g"), frequency ("2 Hz") or duration, cycles,
    time_step, lead and rest (s of silence before and after), name. Raises InputError.

    Frequency f and duration: rectangular and half-sine last half a period, 1/(2 f); sine and cosine
    cycles/f (default one cycle); Ricker 3/f.
    """
    try:
        pulse = check(Pulse, dict(table))
    except InputError as error:
        raise InputError(f"pulse: {error}") from None
    shape = SHAPES.get(pulse.shape)
    if shape is None:
        raise InputError(f"pulse: shape {pulse.shape!r} is not known; {nearest(pulse.shape, SHAPES)}")
    if pulse.cycles is not None and not shape.repeats:
        raise InputError(f"pulse: cycles = {pulse.cycles:g} has no meaning for shape {pulse.shape!r}: leave it out")
    periods = shape.periods if pulse.cycles is None else _positive(pulse.cycles, "1", "pulse: cycles")
    amplitude = to_si(pulse.amplitude, "m s-2", "pulse: amplitude")
    if amplitude == 0.0 or not math.isfinite(amplitude):
        raise InputError(f"pulse: amplitude is {pulse.amplitude!r}: give a finite value other than zero")
    if (pulse.frequency is None) == (pulse.duration is None):
        held = "neither is given" if pulse.frequency is None else "both are given"
        raise InputError(f"pulse: give exactly one of frequency and duration; {held}")
    if pulse.frequency is not None:
        frequency = _positive(pulse.frequency, "Hz", "pulse: frequency")
        duration = periods / frequency
    else:
        duration = _positive(pulse.duration, "s", "pulse: duration")
        frequency = periods / duration
    if pulse.time_step is None:
        step = duration / max(1, math.ceil(periods * STEPS_A_PERIOD))
    else:
        step = check_step(_positive(pulse.time_step, "s", "pulse: time_step"), "pulse")
    silence = [to_si(getattr(pulse, word), "s", f"pulse: {word}") for word in ("lead", "rest")]
    for word, length in zip(("lead", "rest"), silence, strict=True):
        if not 0.0 <= length < math.inf:
            raise InputError(f"pulse: {word} is {length:g} s: give zero or a positive time")
    _check_length(duration + sum(silence), step)
    count = _steps(duration, step, "pulse")
    if pulse.time_step is None:  # silence is rounded to the step that the pulse itself asks for
        before, after = (math.ceil(length / step - 1e-9) for length in silence)
    else:
        before, after = (_steps(length, step, w) for w, length in zip(("lead", "rest"), silence, strict=True))
    values = amplitude * shape.value(np.arange(count + 1, dtype=np.float64) * (periods / count), periods)
    if before:
        values[0] /= 2
    if after:
        values[-1] /= 2
    name = pulse.name or f"{pulse.shape} {amplitude:g} m s-2, {frequency:g} Hz"
    return Motion(
        name,
        step,
        np.pad(values, (before, after)),
        components={"horizontal": pulse.shape},
        source={
            "format": "pulse",
            "equation": shape.equation,
            "amplitude": amplitude,
            "frequency": frequency,
        },
        notes=(f"pulse from {before * step:g} to {(before + count) * step:g} s",),
    )
