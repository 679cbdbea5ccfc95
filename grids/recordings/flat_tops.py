"""Flat tops: runs of samples at the same extreme value, as a sensor at the end of its range leaves them.

The rounded top of a smooth swing in steps of a quantum q can hold a run too: h samples on either side of
its crest lie within q, so d samples further on it has dropped by less than q ((h + d)/h)^2 + q. A clipped
swing arrives at its level, and leaves it, with a slope.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from grids.recordings.base import FloatArray, Recording

FEWEST = 6
"""Samples at a level that no chance of the noise puts there."""
SHORTEST = 3
"""Samples, and times the usual run, which is longer than one where a slow channel is held."""
ROUNDED = 2.0
"""Margin over the drop beside a rounded top: its crest need not be a parabola."""
SHOWN = 3
"""Stretches of time that are named."""


def flat_tops(values: FloatArray) -> dict[float, list[tuple[int, int]]]:
    """First and last sample of the flat tops of one channel (n_times,), by their level.

    A run that starts or ends the record, or lies at zero or at its first value, is rest and does not count.
    """
    span, peak = float(np.ptp(values)), float(np.max(np.abs(values)))
    starts = np.flatnonzero(np.concatenate([[True], np.diff(values) != 0.0]))
    lengths = np.diff(np.append(starts, values.size))
    moving = lengths[np.abs(values[starts]) > 0.1 * peak]
    if not moving.size:
        return {}
    shortest = SHORTEST * float(np.median(moving))
    steps = np.diff(np.unique(values))
    quantum = float(np.min(steps[steps > 1e-9 * span], initial=span))
    found: dict[float, list[tuple[int, int]]] = {}
    for level in (float(np.max(values)), float(np.min(values))):
        if level in (0.0, values[0]):
            continue
        runs = []
        for start, length in zip(starts[1:-1].tolist(), lengths[1:-1].tolist(), strict=True):
            if values[start] != level or length < shortest:
                continue
            last = start + length - 1
            half = 0.5 * (length - 1)
            for beyond in (1, length):
                sides = values[[max(start - beyond, 0), min(last + beyond, values.size - 1)]]
                rounded = quantum * (((half + beyond) / half) ** 2 + 1.0)
                if np.max(np.abs(level - sides)) > ROUNDED * rounded:
                    runs.append((start, last))
                    break
        if sum(last - first + 1 for first, last in runs) >= FEWEST:
            found[level] = runs
    return found


def suspected(recording: Recording) -> Iterator[str]:
    """A sentence about every response channel with flat tops."""
    for name in recording.responses:
        channel, rows = recording.channel(name), np.atleast_2d(recording.channels[name])
        for k, row in enumerate(rows):
            tops = flat_tops(row)
            if not tops:
                continue
            where = f"{name} of level {recording.levels[k]}" if channel.by_level else name
            sides = " and ".join(_said(level, channel.unit, runs, recording) for level, runs in tops.items())
            yield f"{where} has flat tops, {sides}: is the sensor at the end of its range?"


def _said(level: float, unit: str, runs: list[tuple[int, int]], recording: Recording) -> str:
    count = sum(last - first + 1 for first, last in runs)
    times = [f"{recording.time[first]:.4g} to {recording.time[last]:.4g} s" for first, last in runs[:SHOWN]]
    if len(runs) > SHOWN:
        times.append(f"{len(runs) - SHOWN} more stretches")
    return f"{count} samples at {level:.4g} {unit} ({', '.join(times)})"
