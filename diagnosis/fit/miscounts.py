"""What an error of the count of events before a window leaves in it, under a law that wears from event to event.

Windows do not follow a recording all along. Between them, and above all before the first, most events are small ones
under the noise, and whether there are a few more depends on details that nobody measured: a first uplift that happens
or does not, how long a body takes to come to rest. So every stretch that no window follows may hold more or fewer
events than the model says, and all later windows of the recording share that error.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diagnosis.fit.memory import histories
from diagnosis.fit.prediction import Point, Predictor
from models.base import FloatArray
from models.identification import Count

SHARE = 0.25
"""Standard deviation of the number of events in a stretch that no window follows, over the number counted there."""
FIRST = 1.0
"""The same of a stretch from rest on, at least: the first uplift may happen a swing earlier or later."""
LEAST = 0.25
"""Standard deviation under which the error of a stretch is left out."""


def miscounts(predictor: Predictor, point: Point) -> FloatArray:
    """Columns (W, C, N, K) of unit variance about the motion at ``point``; none where no law counts events."""
    m = predictor.measured
    columns = [np.zeros((*m.values.shape, 0))]
    for one in (memory for memory in m.identification.memories if isinstance(memory, Count)):
        more = replace(m, memory={**m.memory, one.name: m.memory[one.name] + 1.0})
        slope = replace(predictor, measured=more).predict([point])[0] - predictor.predict([point])[0]
        slope = np.where(m.mask & np.isfinite(slope), slope, 0.0)
        if not slope.any():
            continue
        for own, events in histories(predictor, point):
            begins = m.windows[own[0]]
            step = m.recordings[begins.recording].time_step
            after = [0.0, *(step * m.windows[w].samples for w in own[:-1])]  # where the window before ends
            for k, (series, end) in enumerate(zip(events, after, strict=True)):
                unseen = sum(e.kind == one.event and e.time > end for e in series)
                deviation = max(SHARE * unseen, FIRST * (k == 0 and begins.first > 0))
                if deviation < LEAST:
                    continue
                column = np.zeros((*m.values.shape, 1))
                column[own[k:], ..., 0] = deviation * slope[own[k:]]
                columns.append(column)
    return np.concatenate(columns, axis=-1)
