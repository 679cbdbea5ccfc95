"""What happened before a window: the memory of laws that wear.

Largest values are read off the smoothed measurement. Events cannot be: most are small ones under the noise, in
the decay after a strong phase. They are counted along the fitted model, run from each window's start to the
next one's, and from rest to the first.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from diagnosis.data.measured import Measured
from diagnosis.data.windows import Window
from diagnosis.fit.prediction import Point, Predictor
from diagnosis.fit.unknowns import instruments_of, without_instruments
from grids.instruments.staged import moved_in_stages
from models.base import Event, FloatArray
from models.identification import Count
from models.piecewise import cannot_be_cut, in_force, simulate


def counted(predictor: Predictor, point: Point) -> Measured:
    """The measured windows with the events before each counted along the model at ``point``."""
    m = predictor.measured
    counts = [one for one in m.identification.memories if isinstance(one, Count)]
    if not counts:
        return m
    found = {one.name: np.zeros(len(m.windows)) for one in counts}
    for own, events in histories(predictor, point):
        for one in counts:
            found[one.name][own] = np.cumsum([sum(e.kind == one.event for e in piece) for piece in events])
    return replace(m, memory={**m.memory, **found})


def histories(predictor: Predictor, point: Point) -> list[tuple[NDArray[np.intp], list[tuple[Event, ...]]]]:
    """By recording: its windows (n,), and n series of events along the model at ``point``, each up to a window's start.

    The first from rest, the others from the start of the window before, with times in s from there.
    """
    m = predictor.measured
    rest = m.identification.rest(m.model.derive(without_instruments(point.values), predictor.options))
    found = []
    for r in range(len(m.recordings)):
        own = np.flatnonzero(m.recording_of == r)
        if not own.size:
            continue
        starts = [0, *(m.windows[w].first for w in own)]
        pieces = [Window(r, a, b - a) for a, b in pairwise(starts)]
        states = np.concatenate([[[rest[name] for name in m.free]], point.states[own]])
        found.append((own, _events(predictor, point, pieces, states[:-1])))
    return found


def _events(
    predictor: Predictor, point: Point, pieces: Sequence[Window], states: FloatArray
) -> list[tuple[Event, ...]]:
    """Events along each piece, from its state on."""
    m = predictor.measured
    instruments = instruments_of(point.values)
    found = []
    for piece, state in zip(pieces, states, strict=True):
        recording = m.recordings[piece.recording]
        moved = moved_in_stages(m.shakings[piece.recording], predictor.sets(instruments, recording))
        shaking = m.disturbed(moved, piece.recording).lines
        part = slice(piece.first, piece.first + piece.samples + 1)
        vertical = None if shaking.vertical is None else shaking.vertical[part]
        cut = replace(shaking, horizontal=shaking.horizontal[part], vertical=vertical)
        initial = {name: float(x) for name, x in zip(m.free, state, strict=True)}
        acting = in_force(predictor.parts(point.values, recording), piece.first, piece.samples)
        if cannot_be_cut(m.model, [one.values for one in acting]):
            acting = acting[:1]  # what acts at the start of the piece, all along it
        ran = simulate(m.model, acting, cut, initial=initial, duration=cut.duration, options=predictor.options)
        found.append(ran.events)
    return found
