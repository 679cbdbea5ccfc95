"""Displacements that were integrated twice from accelerations.

Before each integration the laboratory takes off what is slow, or offsets of the accelerometer would grow with the
square of the time: a fourth-order Butterworth high-pass, run forwards and backwards, so that it shifts no phase.
Integrating and filtering commute, so the recorded displacement is the true one after two such passes:

    recorded = H(f)^2 true,   H = |B_4|^2 = (f/f_c)^8/(1 + (f/f_c)^8).

At 2 f_c the amplitude is .992 of the true one, at f_c .25. Displacement and acceleration of a point are then one
measurement (`grids.recordings.integration`). The filter looks ahead, so it acts on whole recordings only.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from grids.instruments.base import Channels, Surroundings
from models.base import FloatArray, Mechanism, MechanismParameter, Values

ORDER = 4


def high_passed(signal: FloatArray, corner_hz: float, time_step: float) -> FloatArray:
    """Signals (..., samples) after one zero-phase high-pass; unchanged at a corner of 0."""
    from scipy.signal import sosfiltfilt

    return signal if corner_hz <= 0.0 else np.asarray(sosfiltfilt(_sections(corner_hz, time_step), signal, axis=-1))


@lru_cache(maxsize=256)
def _sections(corner_hz: float, time_step: float) -> FloatArray:
    from scipy.signal import butter

    return np.asarray(butter(ORDER, corner_hz, "highpass", output="sos", fs=1.0 / time_step))


def respond(channels: Channels, values: Values, around: Surroundings) -> Channels:
    corner, step = float(values["high_pass_hz"]), around.time_step
    return {
        name: high_passed(high_passed(x, corner, step), corner, step) if around.is_displacement(name) else x
        for name, x in channels.items()
    }


MECHANISM = Mechanism(
    name="integrated_displacement",
    effect_class="integrated_displacement",
    parameters=(
        MechanismParameter(
            "high_pass_hz", "f_i", "Hz", "corner of the high-pass before each of two integrations", 0.0, 0.5
        ),
    ),
    equation="recorded displacement = true one after two zero-phase fourth-order Butterworth high-passes",
    signature="slow: residual displacements and long periods are missing",
    sentence="the displacements were integrated twice from accelerations, high-passed at {high_pass_hz:.3g} Hz before "
    "each integration",
    acts={"whole": respond},
    static_test="ask how the displacements were made, or hold one against a displacement transducer",
    source="processing of shake-table records; Boore and Bommer (Soil Dyn. Earthq. Eng. 25, 2005)",
)
