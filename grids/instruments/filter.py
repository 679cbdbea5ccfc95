"""A Butterworth filter in the response channels: causal, or its low-pass run forwards and backwards (zero phase).

The filter acts on the signal between its samples, where it is the polynomial of fifth degree through the six nearest
ones, so that a corner above the Nyquist frequency of the recording keeps its meaning: straight lines would take 3 % of
what moves at a tenth of the sampling rate and 7 % at .15 of it, these take .02 % and .2 %. In windows it is applied in
two parts: its delay of slow signals, as a clock error, and the filter read that much later, between samples too. So a
window that starts at a recorded peak starts at the peak of the motion too. What came before its first sample and comes
after its last one are parabolas through the samples there. A low-pass of zero phase has no delay, but depends on what
comes after: windows are run `MEMORY` of its delays longer.
"""

from __future__ import annotations

from functools import lru_cache
from math import factorial
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from grids.instruments.base import Channels, Surroundings, Whole
from models.base import FloatArray, Mechanism, MechanismParameter, Values

Kind = Literal["lowpass", "highpass"]
LEAD_IN = 0.2
"""s of parabola before the first sample."""
FEWEST, MOST = 4, 8
"""Samples through which the parabola before the first one is laid: as many as `MEMORY` delays of a low-pass take."""
MEMORY = 4.0
AFTER = 3
"""Samples through which the parabola after the last one is laid."""
REACH = 3
"""Samples on either side that tell the signal between two."""


class Discrete(NamedTuple):
    """A filter of samples: its polynomials in z^-1, and what it makes of a constant input.

    Its output of a sample comes `REACH` samples later, once all that it depends on are in.
    """

    numerator: NDArray[np.float64]
    denominator: NDArray[np.float64]
    steady: float


def _pulse() -> list[NDArray[np.float64]]:
    """Coefficients, in powers of the share of a step, of what a pulse is from `REACH` steps before it to as many after.

    Of the polynomial through the six nearest samples between two of them (Lagrange's).
    """
    near = np.arange(1 - REACH, REACH + 1)
    powers = np.vander(near, increasing=True).astype(float)
    weights = np.linalg.inv(powers)  # column j: of the sample near[j]
    return [weights[:, REACH - 1 - k] for k in range(-REACH, REACH)]


PULSE = _pulse()


@lru_cache(maxsize=4096)
def discrete(corner_hz: float, order: int, kind: Kind, time_step: float, share: float = 0.0) -> Discrete:
    """The Butterworth filter for samples ``time_step`` (s) apart, read a ``share`` of a step after each.

    Of x' = A x + b u, y = c x + d u the answer to a pulse is that to its pieces, exactly; it ends in a free decay,
    which the poles take away.
    """
    from scipy.linalg import expm
    from scipy.signal import butter, tf2ss

    a, b, c, d = tf2ss(*butter(order, 2.0 * np.pi * corner_hz, btype=kind, analog=True, output="ba"))
    n, terms = a.shape[0], 2 * REACH
    rates = np.zeros((n + terms, n + terms))  # of x, and of u and its derivatives
    rates[:n, :n], rates[:n, n] = a, b[:, 0]
    rates[n:, n:] = np.eye(terms, k=1)
    step, part = expm(rates * time_step), expm(rates * (share * time_step))
    scale = np.array([factorial(k) / time_step**k for k in range(terms)])
    x, answer = np.zeros(n), []
    for piece in (*PULSE, *[np.zeros(terms)] * n):
        given = np.concatenate([x, scale * piece])
        between = part @ given
        answer.append(float(c[0] @ between[:n] + d[0, 0] * between[n]))
        x = (step @ given)[:n]
    poles = np.poly(step[:n, :n])
    numerator = np.convolve(answer, poles)[: terms + n]
    steady = 1.0 if kind == "lowpass" else 0.0
    return Discrete(numerator, np.asarray(poles, np.float64), steady)


@lru_cache(maxsize=64)
def backwards(few: int, count: int) -> NDArray[np.float64]:
    """Takes ``few`` samples to the ``count`` before them (few, count) on the parabola through them."""
    bend = np.linalg.pinv(np.vander(np.arange(few), 3, increasing=True).astype(float))
    return np.asarray((np.vander(np.arange(-count, 0), 3, increasing=True).astype(float) @ bend).T)


def stages(values: Values) -> list[tuple[float, int, Kind]]:
    order = int(values["order"])
    found: list[tuple[float, int, Kind]] = []
    if np.isfinite(values["corner_hz"]):
        found.append((float(values["corner_hz"]), order, "lowpass"))
    if values["high_pass_hz"] > 0.0:
        found.append((float(values["high_pass_hz"]), order, "highpass"))
    return found


def run(system: Discrete, signal: FloatArray, time_step: float, later: int = 0, fitted: int = MOST) -> FloatArray:
    """Output of the filter for signals (..., samples), read so many samples ``later``.

    Each is led in by its own parabola, through its first ``fitted`` samples.

    Beyond its end, where the filter is read later than it reaches, a signal keeps the value that it was continued to.
    """
    from scipy.signal import lfilter

    count, later = int(np.ceil(LEAD_IN / time_step)), later + REACH
    samples = signal.shape[-1]
    few, last = min(fitted, samples), min(AFTER, samples)
    after = (signal[..., -last:][..., ::-1] @ backwards(last, REACH))[..., ::-1]
    held = np.repeat(after[..., -1:], later - REACH, axis=-1)
    whole = np.concatenate([signal[..., :few] @ backwards(few, count), signal, after, held], axis=-1)
    first = whole[..., :1]
    passed = lfilter(system.numerator, system.denominator, whole - first, axis=-1) + system.steady * first
    return np.asarray(passed)[..., count + later : count + later + samples]


def both_ways(system: Discrete, signal: FloatArray, time_step: float, fitted: int) -> FloatArray:
    """The filter's output run forwards, then backwards: the square of its gain, and no phase.

    What is not finite from a sample on (a wall that falls) stays so, and holds its last value for what came before.
    """
    known = np.logical_and.accumulate(np.isfinite(signal), axis=-1)
    if not known.all():
        last = np.maximum(known.sum(axis=-1, keepdims=True) - 1, 0)
        signal = np.where(known, signal, np.take_along_axis(signal, last, axis=-1))
    forwards = run(system, signal, time_step, fitted=fitted)
    found = run(system, forwards[..., ::-1], time_step, fitted=fitted)[..., ::-1]
    return found if known.all() else np.where(known, found, np.nan)


def reach(values: Values) -> int:
    """Samples after one that tell the signal around it."""
    return REACH


def lag(values: Values) -> float:
    """Delay (s) of slow signals: none of a low-pass that is run both ways."""
    return 0.0 if values["zero_phase"] else delay(values)


def ahead(values: Values) -> float:
    """s after a sample that its output depends on."""
    return MEMORY * delay(values) if values["zero_phase"] else 0.0


def delay(values: Values) -> float:
    """Delay (s) of slow signals in one run: b_1/omega_c, b_1 the linear coefficient of the Butterworth polynomial."""
    found = 0.0
    for corner, order, kind in stages(values):
        if kind == "lowpass":
            # the poles lie on the unit circle: the coefficient is the sum of -Re(poles)
            poles = sum(np.sin(np.pi * (2 * k + 1) / (2 * order)) for k in range(order))
            found += poles / (2.0 * np.pi * corner)
    return float(found)


def respond(channels: Channels, values: Values, around: Surroundings) -> Channels:
    return _read(channels, values, around, 0.0)


def respond_in_windows(channels: Channels, values: Values, around: Surroundings) -> Channels:
    return _read(channels, values, around, lag(values) / around.time_step)


def _read(channels: Channels, values: Values, around: Surroundings, later: float) -> Channels:
    """The channels as filtered, the low-pass read so many samples ``later``."""
    remembered = int(np.clip(np.ceil(MEMORY * delay(values) / around.time_step), FEWEST, MOST))
    for corner, order, kind in stages(values):
        low = kind == "lowpass"
        whole, share = divmod(later, 1.0) if low else (0.0, 0.0)
        system, fitted = discrete(corner, order, kind, around.time_step, share), remembered if low else MOST
        if low and values["zero_phase"]:
            channels = {name: both_ways(system, x, around.time_step, fitted) for name, x in channels.items()}
        else:
            channels = {name: run(system, x, around.time_step, int(whole), fitted) for name, x in channels.items()}
    return channels


MECHANISM = Mechanism(
    name="filter",
    effect_class="filter",
    parameters=(
        MechanismParameter(
            "corner_hz", "f_c", "Hz", "corner of the low-pass of the response channels", 0.5, 60.0,
            null=np.inf, fit_inverse=True,
        ),
        Whole("order", "n_f", "1", "order of the Butterworth filter", 1.0, 4.0, null=2.0, shape=True),
        MechanismParameter(
            "high_pass_hz", "f_h", "Hz", "corner of a high-pass of the response channels", 0.0, 5.0, shape=True
        ),
        Whole(
            "zero_phase", "", "1", "1: the low-pass was run forwards and backwards, which squares its gain and leaves "
            "no lag; 0: causal", 0.0, 1.0, null=0.0, shape=True,
        ),
    ),
    equation="recorded = Butterworth low-pass (corner_hz, order) of true, every response channel: causal, or of zero "
    "phase",
    signature="at impacts and above the corner; a lag of all channels where it is causal",
    sentence="the response channels went through a causal low-pass of order {order:.0f} at {corner_hz:.3g} Hz",
    sentences={
        "corner_hz, zero_phase": "the response channels went forwards and backwards through a low-pass of order "
        "{order:.0f} at {corner_hz:.3g} Hz",
        "high_pass_hz": "the response channels went through a causal high-pass of order {order:.0f} at "
        "{high_pass_hz:.3g} Hz"
    },
    acts={"response": respond, "lag": lag, "ahead": ahead, "reach": reach, "windowed": respond_in_windows},
    static_test="look up the filter settings of the logger",
    source="anti-alias and display filters of loggers",
)  # fmt: skip
