"""What happened before a window: the memory of laws that wear.

The largest rotation is read off the smoothed measurement. Impacts cannot be: most are small ones under
the noise, in the decay after a strong phase. They are counted along the fitted model, run from each
window's start to the next one's.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from diagnosis.measured import Measured
from diagnosis.prediction import Point, Predictor
from diagnosis.windows import Window


def counted(predictor: Predictor, point: Point) -> Measured:
    """The measured windows with the impacts before each counted along the model at ``point``."""
    m = predictor.measured
    if "impacts" not in m.memory:
        return m
    impacts = np.zeros(len(m.windows))
    for r, recording in enumerate(m.recordings):
        own = np.flatnonzero(m.recording_of == r)
        if not own.size:
            continue
        starts = [0, *(m.windows[w].first for w in own)]
        states = np.concatenate([np.zeros((1, point.states.shape[1])), point.states[own]])
        pieces = [Window(r, a, b - a) for a, b in zip(starts[:-1], starts[1:], strict=True)]
        impacts[own] = np.cumsum(_impacts(predictor, point, pieces, states[:-1]))
    return replace(m, memory={**m.memory, "impacts": impacts})


def _impacts(predictor: Predictor, point: Point, pieces: Sequence[Window], states: np.ndarray) -> list[int]:
    """Changes of sign of the rotation along each piece."""
    m = predictor.measured
    kept = [k for k, piece in enumerate(pieces) if piece.samples > 1]
    counts = [0] * len(pieces)
    if kept:
        nothing_before = {name: np.zeros(len(kept)) for name in m.memory}
        along = replace(m.cut_again(tuple(pieces[k] for k in kept)), memory=nothing_before)
        moved = replace(predictor, measured=along).predict([Point(point.values, states[kept])])[0][:, 0]
        for row, k in enumerate(kept):
            signs = np.sign(moved[row, : pieces[k].samples])
            signs = signs[signs != 0.0]
            counts[k] = int(np.count_nonzero(signs[1:] != signs[:-1]))
    return counts
