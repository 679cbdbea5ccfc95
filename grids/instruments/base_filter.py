"""The accelerometer of the base went through a filter of its own: AC coupling, or a low-pass.

Measured = filtered true, so the true motion is the inverse filter on the measured one. Of the first-order high-pass
that is exact from the first sample, at rest, on: a = a_m + omega integral a_m dt, a_m linear between samples. The
inverse of a low-pass H grows with frequency and would amplify the noise without bound; it is replaced by
(1 + l^2) conj(H) / (|H|^2 + l^2), l = .05, which amplifies by at most 10, is exact at the null, and falls short
of 1/H by .25 % at the corner and 4 % at twice the corner.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from models.base import FloatArray, Mechanism, MechanismParameter, Values
from models.shaking import Shaking

REGULARISATION = 0.05
RETURN = 1.0
"""s after the end in which the signal goes back to its first value, so that its periodic continuation has no jump."""


def move(shaking: Shaking, values: Values) -> Shaking:
    signal = shaking.horizontal
    if values["high_pass_hz"] > 0.0:
        signal = without_high_pass(signal, float(values["high_pass_hz"]), shaking.time_step)
    if np.isfinite(values["low_pass_hz"]):
        signal = without_low_pass(signal, float(values["low_pass_hz"]), shaking.time_step)
    return replace(shaking, horizontal=signal)


def without_high_pass(signal: FloatArray, corner_hz: float, time_step: float) -> FloatArray:
    """x of y' + omega y = x', from rest before the first sample."""
    area = np.concatenate([[0.0], np.cumsum(0.5 * time_step * (signal[1:] + signal[:-1]))])
    return np.asarray(signal + 2.0 * np.pi * corner_hz * area)


def without_low_pass(signal: FloatArray, corner_hz: float, time_step: float) -> FloatArray:
    """The signal before a causal second-order Butterworth low-pass, regularised."""
    back = np.linspace(signal[-1], signal[0], round(RETURN / time_step) + 1)[1:]
    whole = np.concatenate([signal, back])
    s = 1j * np.fft.rfftfreq(whole.size, time_step) / corner_hz
    response = 1.0 / (1.0 + np.sqrt(2.0) * s + s**2)
    weak = REGULARISATION**2
    inverse = (1.0 + weak) * np.conj(response) / (np.abs(response) ** 2 + weak)
    return np.asarray(np.fft.irfft(inverse * np.fft.rfft(whole), whole.size)[: signal.size])


MECHANISM = Mechanism(
    name="base_filter",
    effect_class="base_filter",
    parameters=(
        MechanismParameter("high_pass_hz", "f_hb", "Hz", "corner of the base accelerometer's AC coupling", 0.0, 1.0),
        MechanismParameter(
            "low_pass_hz", "f_cb", "Hz", "corner of a low-pass of the base accelerometer", 5.0, 100.0,
            null=np.inf, fit_inverse=True,
        ),
    ),
    equation="a_measured = a through a causal first-order high-pass (high_pass_hz) and a causal second-order "
    "Butterworth low-pass (low_pass_hz), horizontal",
    signature="between impacts, with the velocity of the base; a low-pass: the responses seem to come early",
    sentence="the accelerometer of the base is AC coupled: a first-order high-pass at {high_pass_hz:.3g} Hz",
    sentences={"low_pass_hz": "the accelerometer of the base went through a low-pass at {low_pass_hz:.3g} Hz"},
    acts={"base": move},
    static_test="tilt the accelerometer of the base and see whether its reading stays",
    source="AC-coupled and piezoelectric accelerometers; data sheet of the conditioner",
)  # fmt: skip
