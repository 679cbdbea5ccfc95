"""The pieces in which nothing moves, or by no more than a model can be trusted with: a sensor's noise stands alone.

A block may rock by little from the first sample to the last: then the stillest stretch is no rest. Accelerometers and
load cells read the base's acceleration though nothing moves on it, and a wall on rubber sways with a base that moves
little: they are still where the base is. Until such a wall first moves beyond the noise what the model predicts from
rest is taken off: then it need not be still.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from diagnosis.data.measured import Measured
from diagnosis.data.noise import calm, still
from diagnosis.errors.components import Component
from diagnosis.errors.drifts import knots_of
from diagnosis.errors.likelihood import Piece
from diagnosis.errors.pieces import FLOOR, Scene, stationary
from diagnosis.fit.from_rest import from_rest, samples_within_noise
from diagnosis.fit.solver import Fitted
from models.base import FloatArray

LONGEST_STILL = 300
"""Averages of a still stretch that are used: the first and the last half of them."""
FEWEST_STILL, SHORTEST_BEGINNING = 8, 0.5
"""Averages that a still stretch has at least; s from rest to a motion beyond the noise that tell of that noise."""
MOVES = 5.0
"""Standard deviation of the stillest stretch over the noise from which on it is motion: nothing is still."""


def stills(scene: Scene, components: Sequence[Component]) -> list[Piece]:
    """Of each channel and recording the beginning and all that is still later; the level of each is unknown."""
    m = scene.fitted.measured
    found = []
    for r, recording in enumerate(m.recordings):
        own = np.flatnonzero(m.recording_of == r)
        if not own.size:
            continue
        begins = _beginning(scene.fitted, r) if m.identification.elastic else None
        size = int(m.strides[own[0]])
        units = _units(m, own, recording.time.size // size, size)
        for c, name in enumerate(m.channels):
            unit, after = units[:, c], 0
            if begins is not None:
                after = begins.shape[1]
                rest = _means(begins[c] - recording.channels[name][:after], size)
                latest = np.arange(rest.size)[-LONGEST_STILL:]
                found += _still(scene, components, r, c, latest, rest[latest] / unit[latest])
            values = recording.channels[name]
            quiet = [s for s in still(values, recording.time_step) if np.std(values[s]) < MOVES * unit[s.start // size]]
            if m.identification.elastic or (name in m.places and m.places[name].absolute):
                quiet = calm(quiet, recording)
            means = _means(values, size)
            at = np.array([i for s in quiet for i in range(-(-max(s.start, after) // size), s.stop // size)], np.int64)
            if at.size > LONGEST_STILL:
                at = np.concatenate([at[: LONGEST_STILL // 2], at[-LONGEST_STILL // 2 :]])
            found += _still(scene, components, r, c, at, -means[at] / unit[at])
    return found


def _units(m: Measured, own: NDArray[np.intp], count: int, size: int) -> FloatArray:
    """The units (n, C) of the errors of averages over ``size`` samples: those of the nearest of the windows ``own``."""
    middles = m.first[own] + np.array([m.windows[w].samples for w in own]) // 2
    nearest = np.argmin(np.abs(size * np.arange(count)[:, None] - middles), axis=1)
    return np.asarray(m.units[own[nearest]])


def _still(
    scene: Scene, components: Sequence[Component], r: int, c: int, at: NDArray[np.int64], rest: FloatArray
) -> list[Piece]:
    """The averages ``at`` of a channel, predicted minus measured to within a level: a piece, unless they are few."""
    if at.size < FEWEST_STILL:
        return []
    m, inside = scene.fitted.measured, slice(0, at.size)
    knots, k = knots_of(m, components), scene.linear.by_unknown.shape[-1]
    size = float(m.strides[int(np.flatnonzero(m.recording_of == r)[0])])
    step = m.recordings[r].time_step * size
    parts = tuple(
        stationary(component, at, step, inside, size)
        if component.channel == c and not component.moving and not component.shared
        else None
        for component in components
    )
    known, blank = np.diag(np.full(at.size, FLOOR / size)), np.zeros((at.size, k))
    time, channel = np.asarray(at * step, np.float64), np.full(at.size, c)
    near = () if knots is None else knots.near(r, channel, time)
    return [Piece(time, channel, rest - rest.mean(), np.ones((at.size, 1)), blank, known, parts, *near)]


def _means(values: FloatArray, size: int) -> FloatArray:
    """Averages over ``size`` successive samples (n,)."""
    return np.asarray(values[: values.size // size * size].reshape(-1, size).mean(axis=1))


def _beginning(fitted: Fitted, recording: int) -> FloatArray | None:
    """Channels (C, n) from rest to the first motion beyond the noise, as predicted; None where that comes at once."""
    m, predictor = fitted.measured, fitted.misfit.predictor
    samples = samples_within_noise(m, recording)
    if samples * m.recordings[recording].time_step < SHORTEST_BEGINNING:
        return None
    found = from_rest(predictor, fitted.misfit.point(fitted.u, fitted.states), recording, samples)
    return found if np.all(np.isfinite(found)) else None
