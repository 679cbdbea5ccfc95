"""What an event that does not repeat exactly leaves in the rest of its window.

One column an event: the derivative of the recorded channels by a relative change of the joint's rate just after it, by
an impulse there, which changes the rates of other bodies too. Short runs from the first sample after the event, with
the rates and what they have turned since changed up and down, give it (reading it off the responses to pulses of base
acceleration of 20 ms is 15-20 % low). Where one rate alone changes, a pulse of one sample makes nearly the same change:
its height is known too, so that a run can have its events as they were (`diagnosis.errors.scattered`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from diagnosis.fit.along import Along
from diagnosis.fit.prediction import Point, Predictor
from diagnosis.fit.unknowns import without_instruments
from models.base import FloatArray
from models.identification import Closing

CHANGE = 0.01
FEWEST_LEFT = 3
"""Samples of a window that must follow an event."""
PULSE = 0.01
"""m s-2, height of the pulses that are tried."""
BEFORE = 2
"""Samples from the last one before an event to its pulse."""


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

    def losing(self, share: FloatArray, first: NDArray[np.int64]) -> FloatArray:
        """Change (W, C, N) of the channels where every event takes a ``share`` of the rate.

        ``share`` (W, N) along the windows, read just before an event; ``first`` (W,): the windows' first samples.
        """
        return self.changing(-share[self.window, self.sample - first[self.window] - BEFORE])

    def changing(self, changes: FloatArray) -> FloatArray:
        """Change (W, C, N) of the channels by relative ``changes`` (E,) of the rate after each event."""
        each = np.zeros(self.columns.shape[::3])
        each[self.window, self.place] = changes
        return np.asarray(np.einsum("wcnk,wk->wcn", self.columns, each, optimize=True))


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
    along = Along(predictor, point)
    for r in along.plain:
        for joint in declared.joints:
            window, after = _events(along, r, joint)
            if not window.size:
                continue
            start = along.at(window, after)
            changes = _changes(along, joint, start)
            slope, ends = _left(along, r, window, after, start, changes | _since(along, r, joint, start, changes))
            np.minimum.at(followed, window, ends)
            columns += list(zip(window.tolist(), slope, strict=True))
            sampled.append(m.first[window] + after - 1 + BEFORE)
            heights.append(_heights(along, r, window, after, start, changes))
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


def _events(along: Along, r: int, joint: Closing) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Windows of recording ``r`` and their first samples after the events of a joint, with enough samples left."""
    m = along.predictor.measured
    sign = np.sign(joint.port.coordinate(along.plain[r]))
    row, sample = np.nonzero(sign[:, 1:] * sign[:, :-1] < 0.0)
    window, after = along.windows(r)[row], sample + 1
    inside = after + FEWEST_LEFT < m.mask[window].any(axis=1).sum(axis=1)
    return window[inside], after[inside]


def _changes(along: Along, joint: Closing, start: Mapping[str, FloatArray]) -> dict[str, FloatArray]:
    """By state, the change (n,) of its rate by the impulse at the joint that changes the joint's own rate by itself."""
    m = along.predictor.measured
    wall = m.model.build(without_instruments(along.point.values), along.predictor.options)
    jumps = {name: np.asarray(jump, np.float64) for name, jump in joint.port.jumps(wall, start).items()}
    own, by_impulse = np.broadcast_arrays(joint.rate(start), joint.rate(jumps))
    impulse = np.divide(own, by_impulse, out=np.zeros(own.shape), where=by_impulse != 0.0)
    return {name: impulse * jump for name, jump in jumps.items() if name in m.free}


def _since(
    along: Along, r: int, joint: Closing, start: Mapping[str, FloatArray], changes: Mapping[str, FloatArray]
) -> dict[str, FloatArray]:
    """By state, its change (n,) by these changes of rates since the event, up to a sample before."""
    m = along.predictor.measured
    coordinate, rate = joint.port.coordinate(start), joint.rate(start)
    since = np.divide(coordinate, rate, out=np.zeros(rate.shape), where=rate != 0.0)
    since = np.clip(since, 0.0, m.recordings[r].time_step)
    angles = {state.name: state.channel for state in m.identification.free if state.rate}
    return {angles[name]: since * change for name, change in changes.items()}


def _left(
    along: Along, r: int, window: NDArray[np.intp], after: NDArray[np.intp], start: Mapping[str, FloatArray],
    changes: Mapping[str, FloatArray],
) -> tuple[FloatArray, NDArray[np.intp]]:  # fmt: skip
    """What a relative change of the rate leaves (n, C, N), and the sample (n,) up to which it is in proportion."""
    m = along.predictor.measured
    samples = m.values.shape[2]
    every, since = np.tile(window, 3), np.tile(after, 3)
    shares = np.repeat([CHANGE, -CHANGE, 0.0], window.size)
    changed = {name: np.concatenate([x, x, x]) for name, x in start.items()}
    for name, change in changes.items():
        changed[name] = changed[name] + shares * np.tile(change, 3)
    ran = along.run(r, m.first[every] + since, samples, changed)
    more, less, same = along.recorded(every, since, ran).reshape(3, window.size, *m.values.shape[1:])
    straight = 0.5 * np.abs(more + less - 2.0 * same) <= m.units[window, :, None]
    bent = np.any(~straight & m.mask[window], axis=1)
    ends = np.where(bent.any(axis=1), bent.argmax(axis=1), samples)
    return (more - less) / (2.0 * CHANGE), ends


def _heights(
    along: Along, r: int, window: NDArray[np.intp], after: NDArray[np.intp], start: Mapping[str, FloatArray],
    changes: Mapping[str, FloatArray],
) -> FloatArray:  # fmt: skip
    """Height (n,) of the pulse of one sample that makes a relative change of one; 0 where several rates change.

    Those change with the base motion in other proportions.
    """
    if len(changes) != 1:
        return np.zeros(window.size)
    (rate,) = changes
    first = along.predictor.measured.first[window]
    pulse = np.zeros(along.predictor.measured.shakings[r].horizontal.size)
    pulse[first + after - 1 + BEFORE] = PULSE
    pushed, free = (
        along.run(r, first + after, FEWEST_LEFT, start, push)[rate][:, FEWEST_LEFT - 1] for push in (pulse, None)
    )
    return np.divide(PULSE * free, pushed - free, out=np.zeros(window.size), where=pushed != free)
