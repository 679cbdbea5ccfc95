"""What an event that does not repeat exactly leaves in the rest of its window.

One column an event: the derivative of the recorded channels by a relative change of the rate just after it. Short runs
from the first sample after the event, with the rate changed by a share of itself up and down, give it (reading it off
the responses to pulses of base acceleration of 20 ms is 15-20 % low). A pulse of one sample makes nearly the same
change: its height is known too, so that a run can have its events as they were (`diagnosis.errors.scattered`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from diagnosis.fit.prediction import Point, Predictor
from diagnosis.fit.unknowns import instruments_of
from grids.instruments.base import Surroundings
from grids.instruments.staged import moved_in_stages, recorded_in_stages
from grids.instruments.windowed import moved_in_windows, recorded_in_windows
from models.base import FloatArray
from models.kinematics import ground_along
from models.observed import Observed
from models.piecewise import Part, trajectories
from models.shaking import Shaking

CHANGE = 0.01
FEWEST_LEFT = 3
"""Samples of a window that must follow an event."""
PULSE = 0.01
"""m s-2, height of the pulses that are tried."""


@dataclass(frozen=True)
class Kicks:
    """Events of W windows, at most K in each; E in all.

    ``columns`` (W, C, N, K), padded with zeros: derivative by the relative change of the rate after each event.
    ``window``, ``place`` (E,): its column; ``sample`` (E,) of the recording, at which a pulse of base acceleration of
    one sample, ``height`` (E,) (m s-2) high, makes a relative change of one (0: it makes none). ``followed`` (W,):
    samples of each window over which the response to a change of `CHANGE` is in proportion within the noise.
    """

    columns: FloatArray
    window: NDArray[np.intp]
    place: NDArray[np.intp]
    sample: NDArray[np.intp]
    height: FloatArray
    followed: NDArray[np.intp]


def kicks(predictor: Predictor, point: Point) -> Kicks:
    """What the events of every window leave, about the motion at ``point``."""
    m = predictor.measured
    declared = m.identification.scatter
    nowhere = np.zeros(0, np.intp)
    followed = np.array([window.samples for window in m.windows], np.intp)
    if declared is None:
        return Kicks(np.zeros((*m.values.shape, 0)), nowhere, nowhere, nowhere, np.zeros(0), followed)
    columns: list[tuple[int, FloatArray]] = []
    sampled: list[NDArray[np.intp]] = []
    heights: list[FloatArray] = []
    samples = m.values.shape[2]
    for r, recording in enumerate(m.recordings):
        own = np.flatnonzero(m.recording_of == r)
        if not own.size:
            continue
        sets = predictor.sets(instruments_of(point.values), recording)
        parts = predictor.parts(point.values, recording)
        ground = moved_in_stages(m.shakings[r], sets, moved_in_windows)
        shaking = m.disturbed(ground, r)

        def run(
            windows: NDArray[np.intp],
            after: NDArray[np.intp],
            states: FloatArray,
            shaking: Shaking = shaking,
            samples: int = samples,
            parts: Sequence[Part] = parts,
        ) -> Mapping[str, FloatArray]:
            initial = dict(zip(m.model.states, states.T, strict=True)) | {k: v[windows] for k, v in m.memory.items()}
            first = m.first[windows] + after
            instants = np.tile(np.array([part.first for part in parts[1:]], np.int64), (first.size, 1))
            return trajectories(
                m.model, [part.values for part in parts], instants, shaking, first=first, samples=samples,
                initial=initial, options=predictor.options,
            )  # fmt: skip

        plain = run(own, np.zeros(own.size, np.int64), point.states[own])
        sign = np.sign(plain[declared.coordinate])
        window, sample = np.nonzero(sign[:, 1:] * sign[:, :-1] < 0.0)
        after = sample + 1
        inside = after + FEWEST_LEFT < m.mask[own].any(axis=1).sum(axis=1)[window]
        window, after = window[inside], after[inside]
        if not window.size:
            continue
        states = np.stack([plain[name][window, after] for name in m.model.states], axis=1)
        rate = m.model.states.index(declared.rate)
        start = np.asarray(recording.time_step * m.first[own[window], None], np.float64)
        around = Surroundings(recording.time_step, m.base[own[window]], m.reference_peak, start)
        recorded = []
        for share in (1.0 + CHANGE, 1.0 - CHANGE, 1.0):
            changed = states.copy()
            changed[:, rate] *= share
            ran = run(own[window], after, changed)
            spliced = Observed({c: partial(_spliced, plain, ran, c, window, after) for c in ran})
            channels = m.sensed(spliced, ground.time_step, ground_along(ground, m.first[own[window]], samples))
            found = recorded_in_stages(channels, sets, around, recorded_in_windows)
            recorded.append(np.stack([found[c] for c in m.channels], axis=1))
        slope = (recorded[0] - recorded[1]) / (2.0 * CHANGE)
        straight = 0.5 * np.abs(recorded[0] + recorded[1] - 2.0 * recorded[2]) <= m.units[own[window], :, None]
        bent = np.any(~straight & m.mask[own[window]], axis=1)
        np.minimum.at(followed, own[window], np.where(bent.any(axis=1), bent.argmax(axis=1), samples))
        columns += list(zip(own[window].tolist(), slope, strict=True))
        at = m.first[own[window]] + after + 1
        pulse = np.zeros(shaking.horizontal.size)
        pulse[at] = PULSE
        pushed, free = (
            run(own[window], after, states, one, FEWEST_LEFT)[declared.rate][:, FEWEST_LEFT - 1]
            for one in (replace(shaking, horizontal=shaking.horizontal + pulse), shaking)
        )
        sampled.append(at)
        heights.append(np.divide(PULSE * free, pushed - free, out=np.zeros(at.size), where=pushed != free))
    count = np.bincount([w for w, _ in columns], minlength=len(m.windows))
    found_all = np.zeros((*m.values.shape, int(count.max(initial=0))))
    filled = np.zeros(len(m.windows), np.intp)
    place = np.zeros(len(columns), np.intp)
    for k, (w, slope) in enumerate(columns):
        found_all[w, :, :, filled[w]] = np.where(m.mask[w] & np.isfinite(slope), slope, 0.0)
        place[k] = filled[w]
        filled[w] += 1
    window = np.array([w for w, _ in columns], np.intp)
    return Kicks(
        found_all, window, place, np.concatenate([nowhere, *sampled]), np.concatenate([[], *heights]), followed
    )


def _spliced(
    plain: Mapping[str, FloatArray], ran: Mapping[str, FloatArray], name: str, window: NDArray[np.intp],
    after: NDArray[np.intp],
) -> FloatArray:  # fmt: skip
    """Rows ``window`` of ``plain`` with those of ``ran`` (n, N) in their place from sample ``after`` (n,) on."""
    before, later = plain[name][window], ran[name]
    index = np.arange(before.shape[1])[None, :] - after[:, None]
    return np.where(index >= 0, np.take_along_axis(later, np.maximum(index, 0), axis=1), before)
