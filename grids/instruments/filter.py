"""A causal Butterworth filter in the response channels.

The filter acts on the signal taken as linear between samples, so that a corner above the Nyquist
frequency of the recording keeps its meaning. In windows it is applied in two parts: its delay of slow signals,
as a clock error, and the filter read that much later, between samples too. So a window that starts at a recorded
peak starts at the peak of the motion too, and what came before its first sample is the parabola through
the first samples.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from grids.instruments.base import Channels, Surroundings
from models.base import FloatArray, Mechanism, MechanismParameter, Values

Kind = Literal["lowpass", "highpass"]
LEAD_IN = 0.2
"""s of parabola before the first sample."""
FITTED = 8
"""Samples through which the parabola is laid."""


class Discrete(NamedTuple):
    """A filter for an input linear between samples: its polynomials in z^-1, and what it makes of a constant one.

    ``late``: how many samples after the first its output of the first one comes.
    """

    numerator: NDArray[np.float64]
    denominator: NDArray[np.float64]
    steady: float
    late: int = 0


@lru_cache(maxsize=4096)
def discrete(corner_hz: float, order: int, kind: Kind, time_step: float, share: float = 0.0) -> Discrete:
    """The Butterworth filter for samples ``time_step`` (s) apart, read a ``share`` of a step after each."""
    from scipy.signal import butter, cont2discrete, ss2tf, tf2ss

    continuous = tf2ss(*butter(order, 2.0 * np.pi * corner_hz, btype=kind, analog=True, output="ba"))
    a, b, c, d, _ = cont2discrete(continuous, time_step, method="foh")
    rows, poles = ss2tf(a, b, c, d)
    unit = np.linalg.solve(np.eye(a.shape[0]) - a, b[:, 0])
    steady = float(c[0] @ unit + d[0, 0])
    if not share:
        return Discrete(rows[0], poles, steady)
    return Discrete(_read_between(continuous, poles, time_step, share), poles, steady, late=1)


def _read_between(
    continuous: Sequence[NDArray[np.float64]], poles: NDArray[np.float64], time_step: float, share: float
) -> NDArray[np.float64]:
    """Numerator of the filter x' = A x + b u, y = c x + d u that is read a share of a step after each sample.

    It has no more coefficients than its answer to a pulse, which rises over one step and falls over the next, tells.
    """
    from scipy.linalg import expm

    a, b, c, d = continuous
    n = a.shape[0]
    rates = np.zeros((n + 2, n + 2))  # of x, u and the slope of u
    rates[:n, :n], rates[:n, n], rates[n, n + 1] = a, b[:, 0], 1.0
    step, part = expm(rates * time_step), expm(rates * (share * time_step))
    x, answer = np.zeros(n), []
    for before, after in ((0.0, 1.0), (1.0, 0.0), *[(0.0, 0.0)] * n):
        given = np.array([*x, before, (after - before) / time_step])
        between = part @ given
        answer.append(float(c[0] @ between[:n] + d[0, 0] * between[n]))
        x = (step @ given)[:n]
    return np.convolve(answer, poles)[: n + 2]


@lru_cache(maxsize=64)
def backwards(few: int, count: int) -> NDArray[np.float64]:
    """Takes ``few`` samples to the ``count`` before them (few, count) on the parabola through them."""
    bend = np.linalg.pinv(np.vander(np.arange(few), 3, increasing=True).astype(float))
    return np.asarray((np.vander(np.arange(-count, 0), 3, increasing=True).astype(float) @ bend).T)


def stages(values: Values) -> list[tuple[float, int, Kind]]:
    order = round(float(values["order"]))
    found: list[tuple[float, int, Kind]] = []
    if np.isfinite(values["corner_hz"]):
        found.append((float(values["corner_hz"]), order, "lowpass"))
    if values["high_pass_hz"] > 0.0:
        found.append((float(values["high_pass_hz"]), order, "highpass"))
    return found


def run(system: Discrete, signal: FloatArray, time_step: float, later: int = 0) -> FloatArray:
    """Output of the filter for signals (..., samples), each led in by its own parabola; read so many samples ``later``.

    Beyond its end a signal keeps its last value.
    """
    from scipy.signal import lfilter

    count, later = int(np.ceil(LEAD_IN / time_step)), later + system.late
    few, samples = min(FITTED, signal.shape[-1]), signal.shape[-1]
    held = np.repeat(signal[..., -1:], later, axis=-1)
    whole = np.concatenate([signal[..., :few] @ backwards(few, count), signal, held], axis=-1)
    first = whole[..., :1]
    passed = lfilter(system.numerator, system.denominator, whole - first, axis=-1) + system.steady * first
    return np.asarray(passed)[..., count + later : count + later + samples]


def delay(values: Values) -> float:
    """Delay (s) of slow signals: b_1/omega_c with b_1 the linear coefficient of the Butterworth polynomial."""
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
    return _read(channels, values, around, delay(values) / around.time_step)


def _read(channels: Channels, values: Values, around: Surroundings, later: float) -> Channels:
    """The channels as filtered, the low-pass read so many samples ``later``."""
    for corner, order, kind in stages(values):
        whole, share = divmod(later, 1.0) if kind == "lowpass" else (0.0, 0.0)
        system = discrete(corner, order, kind, around.time_step, share)
        channels = {name: run(system, x, around.time_step, int(whole)) for name, x in channels.items()}
    return channels


MECHANISM = Mechanism(
    name="filter",
    effect_class="filter",
    parameters=(
        MechanismParameter(
            "corner_hz", "f_c", "Hz", "corner of the low-pass of the response channels", 0.5, 60.0,
            null=np.inf, fit_inverse=True,
        ),
        MechanismParameter("order", "n_f", "1", "order of the Butterworth filter", 1.0, 4.0, null=2.0, shape=True),
        MechanismParameter(
            "high_pass_hz", "f_h", "Hz", "corner of a high-pass of the response channels", 0.0, 5.0, shape=True
        ),
    ),
    equation="recorded = causal Butterworth low-pass (corner_hz, order) of true, every response channel",
    signature="at impacts and above the corner; a lag of all channels",
    sentence="the response channels went through a causal low-pass of order {order:.0f} at {corner_hz:.3g} Hz",
    sentences={
        "high_pass_hz": "the response channels went through a causal high-pass of order {order:.0f} at "
        "{high_pass_hz:.3g} Hz"
    },
    acts={"response": respond, "lag": delay, "windowed": respond_in_windows},
    static_test="look up the filter settings of the logger",
    source="anti-alias and display filters of loggers",
)  # fmt: skip
