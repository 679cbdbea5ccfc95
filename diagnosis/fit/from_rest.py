"""What sensors record at the beginning of a test, of a specimen that moves with every motion of its base.

From rest to where it moves beyond the noise nothing has happened that a model could have got wrong by much: what is
left of the recording is the noise of its sensors.
"""

from __future__ import annotations

import numpy as np

from diagnosis.data.measured import Measured
from diagnosis.data.smoothing import smooth
from diagnosis.data.windows import ABOVE_NOISE
from diagnosis.fit.prediction import Point, Predictor
from diagnosis.fit.unknowns import instruments_of
from grids.instruments.staged import moved_in_stages, recorded_in_stages
from grids.instruments.windowed import samples_ahead
from models.base import FloatArray
from models.kinematics import ground_along
from models.piecewise import trajectories

LEVEL = 0.1
"""s over which a sensor's reading at rest is taken, at the start of a recording."""


def samples_within_noise(measured: Measured, recording: int) -> int:
    """Samples from the start on before a leading channel leaves its reading at rest by what may begin a window."""
    m, taken = measured, measured.recordings[recording]
    first = taken.time.size
    if m.lengths is None:
        return 0
    (window, *_) = np.flatnonzero(m.recording_of == recording)
    for lead in m.identification.leads:
        if lead.channel not in m.channels:
            continue
        smoothed = smooth(taken.channels[lead.channel], taken.time_step, m.lengths.smoothing)
        level = np.median(smoothed[: max(3, round(LEVEL / taken.time_step))])
        sigma = m.sigma[window, m.channels.index(lead.channel)]
        beyond = np.flatnonzero(np.abs(smoothed - level) > ABOVE_NOISE * sigma)
        first = min(first, int(beyond[0])) if beyond.size else first
    return first


def from_rest(predictor: Predictor, point: Point, recording: int, samples: int) -> FloatArray:
    """Channels (C, samples) from the start of a recording, as the model and its instruments have them."""
    m, taken = predictor.measured, predictor.measured.recordings[recording]
    (point,) = predictor.declared([point])
    instruments = instruments_of(point.values)
    sets = predictor.sets(instruments, taken)
    shaking = moved_in_stages(m.shakings[recording], sets)
    run = min(samples + samples_ahead(instruments, taken.time_step) + 1, shaking.horizontal.size)
    parts = predictor.parts(point.values, taken)
    first = np.zeros(1, np.int64)
    ran = trajectories(
        m.model, [part.values for part in parts], np.array([[part.first for part in parts[1:]]], np.int64), shaking,
        first=first, samples=run, initial={}, options=predictor.options,
    )  # fmt: skip
    along = ground_along(shaking, first, run)
    true = m.sensed(ran, shaking.time_step, lambda: along)
    around = m.around(taken.time_step, along[0], np.zeros((1, 1)))
    recorded = recorded_in_stages({c: true[c] for c in m.channels}, sets, around)
    return np.stack([np.ravel(recorded[c])[:samples] for c in m.channels])
