"""Predictions of a model that runs from rest through whole recordings, cut in the stretches that are compared.

What instruments do is done to the whole run, so that a filter that looks ahead and one that remembers need no lead-in.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from diagnosis.data.measured import Measured
from diagnosis.data.stretches import averages
from grids.instruments.staged import Sets, recorded_in_stages
from grids.recordings.levels import level_of, stem
from models.base import FloatArray
from models.kinematics import Place
from models.piecewise import Part, trajectories
from models.shaking import Shaking

LANES = 16
"""Runs at once: long histories are large."""
FARTHEST = 30.0
"""Over the largest value recorded, beyond which a run has diverged and is no prediction."""


def run_through(
    measured: Measured,
    recording: int,
    parts: Sequence[Sequence[Part]],
    sets: Sequence[Sets],
    shaking: Shaking,
    options: Mapping[str, str],
) -> FloatArray:
    """Channels (P, C, n) of P settings as means along one recording; ``sets``: what instruments do."""
    m = measured
    samples = m.shakings[recording].horizontal.size
    size = round(m.recordings[recording].time_step / m.shakings[recording].time_step)
    found = np.zeros((len(parts), len(m.channels), samples // size))
    around = m.around(shaking.time_step, shaking.horizontal)
    ground = shaking.horizontal, np.zeros(samples)
    peaks = {c: float(np.max(np.abs(m.recordings[recording].channels[c]))) for c in m.channels}
    # of all levels together: one of them may hardly move
    largest = {c: max(peak for other, peak in peaks.items() if stem(other) == stem(c)) for c in m.channels}
    for low in range(0, len(parts), LANES):
        some = parts[low : low + LANES]
        values = [
            {name: np.array([one[j].values[name] for one in some]) for name in some[0][j].values}
            for j in range(len(some[0]))
        ]
        instants = np.tile(np.array([part.first for part in some[0][1:]], np.int64), (len(some), 1))
        ran = trajectories(
            m.model, values, instants, shaking, first=np.zeros(len(some), np.int64), samples=samples, initial={},
            options=options,
        )  # fmt: skip
        acting = sets[low : low + LANES]
        with np.errstate(over="ignore", invalid="ignore"):  # of runs that have diverged
            true = {c: read(m.places, ran, c, shaking.time_step, ground) for c in m.channels}
        kept = [k for k in range(len(some)) if _near(true, k, largest)]
        found[low : low + LANES] = np.nan
        for alike in _alike(acting, kept):
            recorded = recorded_in_stages({c: true[c][alike] for c in m.channels}, acting[alike[0]], around)
            for c, name in enumerate(m.channels):
                found[low + np.array(alike), c] = averages(recorded[name], size)
    return found


def _near(channels: Mapping[str, FloatArray], lane: int, largest: Mapping[str, float]) -> bool:
    """Whether a run has not diverged."""
    return all(np.max(np.abs(channels[c][lane])) < FARTHEST * most for c, most in largest.items())


def _alike(sets: Sequence[Sets], lanes: Iterable[int]) -> list[list[int]]:
    """The lanes in groups, one for each setting of the instruments: what these do is done to a group at once."""
    groups: list[list[int]] = []
    for k in lanes:
        group = next((one for one in groups if sets[one[0]] == sets[k]), None)
        if group is None:
            groups.append([k])
        else:
            group.append(k)
    return groups


def read(
    places: Mapping[str, Place],
    ran: Mapping[str, FloatArray],
    channel: str,
    time_step: float,
    ground: tuple[FloatArray, FloatArray],
) -> FloatArray:
    """A channel (P, samples) before any instrument, of a run's observables and poses."""
    if channel in places:
        return places[channel].read(ran, time_step, ground)
    level = level_of(channel)
    return ran[channel] if level is None else ran[stem(channel)][..., level, :]
