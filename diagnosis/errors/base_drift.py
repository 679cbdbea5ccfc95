"""A zero of the base accelerometer that drifts within a recording.

To the body it is a slow base acceleration that was not there: a tilt that comes and goes. It is linear between knots as
the drift of a sensor is (`diagnosis.errors.drifts`) and acts through the model's response to pulses of base
acceleration. A zero that is wrong by the same all the time is an instrument's (`accelerometer_offset`).
"""

from __future__ import annotations

import numpy as np

from diagnosis.data.measured import Measured
from diagnosis.fit.whitening import pulse_deviation
from models.base import FloatArray

SHARE = 0.001
"""Of the peak base acceleration of a recording: the unit of such a drift."""


def of_pulses(measured: Measured, base: FloatArray) -> FloatArray:
    """What pulses of base acceleration of one unit leave (W, C, N, K).

    ``base`` (W, C, N, K): what pulses of base noise do, of unit variance (`diagnosis.fit.whitening.base_columns`).
    """
    peak = np.array([np.max(np.abs(s.horizontal)) for s in measured.shakings])
    size = SHARE * peak / np.maximum(pulse_deviation(measured), 1e-300)
    return np.asarray(base * size[measured.recording_of][:, None, None, None])
