"""What happened before a window: the memory of laws that wear.

The largest rotation is read off the smoothed measurement. Impacts cannot be: most are small ones under
the noise, in the decay after a strong phase. They are counted along the fitted model, run from each
window's start to the next one's.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from diagnosis.data.measured import Measured
from diagnosis.data.windows import Window
from diagnosis.fit.prediction import Point, Predictor
from diagnosis.fit.unknowns import split
from grids.instruments import INSTRUMENTS, moved


def counted(predictor: Predictor, point: Point) -> Measured:
    """The measured windows with the impacts before each counted along the model at ``point``."""
    m = predictor.measured
    if "impacts" not in m.memory:
        return m
    impacts = np.zeros(len(m.windows))
    for r in range(len(m.recordings)):
        own = np.flatnonzero(m.recording_of == r)
        if not own.size:
            continue
        starts = [0, *(m.windows[w].first for w in own)]
        states = np.concatenate([np.zeros((1, point.states.shape[1])), point.states[own]])
        pieces = [Window(r, a, b - a) for a, b in pairwise(starts)]
        impacts[own] = np.cumsum(_impacts(predictor, point, pieces, states[:-1]))
    return replace(m, memory={**m.memory, "impacts": impacts})


def _impacts(predictor: Predictor, point: Point, pieces: Sequence[Window], states: np.ndarray) -> list[int]:
    """Impacts along each piece, from its state on."""
    m = predictor.measured
    sensors = split(point.values, tuple(INSTRUMENTS))
    of_wall = {k: v for k, v in point.values.items() if k.partition(".")[0] not in INSTRUMENTS}
    counts = []
    for piece, state in zip(pieces, states, strict=True):
        shaking = moved(m.shakings[piece.recording], sensors)
        part = slice(piece.first, piece.first + piece.samples + 1)
        vertical = None if shaking.vertical is None else shaking.vertical[part]
        cut = replace(shaking, horizontal=shaking.horizontal[part], vertical=vertical)
        initial = {name: float(x) for name, x in zip(m.model.states, state, strict=True) if x != 0.0}
        ran = m.model.simulate(of_wall, cut, initial=initial or None, duration=cut.duration, options=predictor.options)
        counts.append(sum(event.kind == "impact" for event in ran.events))
    return counts
