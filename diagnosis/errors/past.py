"""What came before a window, as far as a sensor remembers it: a window's start is guessed, and the guess has an error.

A filter's output at the start of a window depends on the motion before, which no window knows; instruments continue the
motion backwards (`grids.instruments.filter`). What that gets wrong is seen inside the windows, where the motion before
is known: from a sample s on, a peak as windows start at,

    d(t) = recorded from the whole window - recorded from its sample s on,

as large in any window, for a rocking block's acceleration does not grow with its rotation. With the n of all windows as
rows of D, D/sqrt(n) = U S V', and V S are columns whose squares add up to the covariance of what is wrong there. It is
too small for a high-pass that remembers more than a third of a window, whose slow errors are those of a drift.
"""

from __future__ import annotations

import numpy as np
from scipy.signal import argrelmax

from diagnosis.data.measured import Measured
from diagnosis.fit.along import Along
from diagnosis.fit.prediction import Point, Predictor
from diagnosis.fit.unknowns import instruments_of
from grids.instruments.base import Switched
from grids.instruments.windowed import recorded_in_windows, remembering
from models.base import FloatArray

MIDDLE = (0.3, 0.7)
"""Shares of a window between which s lies: of a low-pass, what was guessed before the window no longer counts."""
MOST = 6
"""Columns of a window."""


def before_windows(predictor: Predictor, point: Point) -> FloatArray:
    """Columns (W, C, N, K) of unit variance of what instruments with a memory get wrong at ``point``; K <= `MOST`."""
    m = predictor.measured
    found = np.zeros((*m.values.shape, MOST))
    if m.stretches is not None or not remembering(instruments_of(point.values)):
        return found[..., :0]
    true = Along(predictor, point).states
    errors: dict[int, FloatArray] = {}
    for w, window in enumerate(m.windows):
        sets = predictor.sets(instruments_of(point.values), m.recordings[window.recording], point.stages)
        if acting := remembering([on for first, on in sets if first <= window.first][-1]):
            motion = np.stack([true[c][w, : window.samples] for c in m.channels])
            errors[w] = _error(motion, acting, m, float(m.time_steps[w]))
    for step in set(m.time_steps.tolist()):
        alike = [w for w in errors if m.time_steps[w] == step]
        rows = [errors[w] for w in alike if np.isfinite(errors[w]).all()]
        if rows:
            padded = [np.pad(row, ((0, 0), (0, m.values.shape[2] - row.shape[1]))).ravel() for row in rows]
            _, s, v = np.linalg.svd(np.stack(padded) / np.sqrt(len(rows)), full_matrices=False)
            found[alike, ..., : s[:MOST].size] = (v[:MOST].T * s[:MOST]).reshape(*m.values.shape[1:], -1)
    return np.asarray(found * m.mask[..., None])


def _error(motion: FloatArray, instruments: Switched, m: Measured, step: float) -> FloatArray:
    """d (C, samples from s on) of one window's ``motion`` (C, samples)."""

    def recorded(first: int) -> FloatArray:
        around = m.around(step, np.zeros(motion.shape[1] - first))
        seen = recorded_in_windows(dict(zip(m.channels, motion[:, None, first:], strict=True)), instruments, around)
        return np.stack([seen[c][0] for c in m.channels])

    whole = recorded(0)
    begin, end = (round(share * motion.shape[1]) for share in MIDDLE)
    peaks = begin + argrelmax(np.abs(whole[m.lead, begin:end]))[0]
    start = int(peaks[np.argmax(np.abs(whole[m.lead, peaks]))]) if peaks.size else begin
    return whole[:, start:] - recorded(start)
