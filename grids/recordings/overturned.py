"""A body that overturned: where its fall begins, beyond which no recording is worth comparing.

A fall is a rotation that passes 60 deg and does not come back, or one that ends at rest far from zero
(the body lies on its side, hangs in a catch, or its sensor is at the end of its range). What is kept ends
where the last swing leaves the largest rotation that the body had come back from.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from grids.recordings.base import FloatArray, Recording
from models.errors import InputError

LYING = np.radians(60.0)
"""rad; no wall that rocks stands up again from here."""
TURNED = np.pi
"""rad; a larger rotation is no fall but a wrong unit."""
CAUGHT = 0.1
"""rad; a body at rest beyond this leans on something."""
RESTS_FOR, STILL, OF_PEAK = 1.0, 0.05, 0.7
"""s at the end of the record within this share of its level, which is at least this share of the peak."""
FEWEST = 20
"""Samples; what is left before a fall must suffice to estimate the noise."""


def cut_before_fall(recording: Recording) -> Recording:
    """The recording up to the first fall of a body, with a note; as it is where nothing falls.

    Raises InputError when almost nothing is left.
    """
    falls = [fall for name in ("rotation_1", "rotation_2") for fall in _falls(name, recording)]
    if not falls:
        return recording
    kept, said = min(falls)
    if kept < FEWEST:
        raise InputError(f"{said}: {kept} samples before the fall are too few to compare; leave the recording out.")
    channels = {name: values[..., :kept] for name, values in recording.channels.items()}
    note = f"{said}; cut at {recording.time[kept - 1]:.4g} s, before the fall"
    lost = {name: at[at < kept] for name, at in recording.lost.items()}
    return replace(recording, time=recording.time[:kept], channels=channels, lost=lost, notes=(*recording.notes, note))


def _falls(name: str, recording: Recording) -> Iterator[tuple[int, str]]:
    """Samples before the fall and the sentence about it, if ``name`` was recorded and falls."""
    rotation = recording.channels.get(name)
    if rotation is None or np.max(np.abs(rotation)) > TURNED:
        return
    lies = _for_good(np.abs(rotation) > LYING)
    if lies is not None:
        yield (
            before_fall(rotation, lies),
            f"{name} passes {np.degrees(LYING):.0f} deg at {recording.time[lies]:.4g} s and does not come back: "
            "the body overturned",
        )
        return
    tail = rotation[-max(2, round(RESTS_FOR / recording.time_step)) :]
    level = float(np.median(tail))
    if abs(level) < max(CAUGHT, OF_PEAK * float(np.max(np.abs(rotation)))) or tail.size == rotation.size:
        return
    near = np.abs(rotation - level) < STILL * abs(level)
    rests = _for_good(near)
    if rests is not None and rests <= rotation.size - tail.size and abs(rotation[0]) < 0.5 * abs(level):
        yield (
            before_fall(rotation, rests),
            f"{name} rests at {level:.3g} rad from {recording.time[rests]:.4g} s to the end: the body fell against "
            "something, or its sensor is at the end of its range",
        )


def _for_good(holds: np.ndarray[tuple[int], np.dtype[np.bool_]]) -> int | None:
    """First sample from which it holds until the end; None where it never or always does."""
    if not holds[-1] or holds.all():
        return None
    return int(np.flatnonzero(~holds)[-1]) + 1


def before_fall(rotation: FloatArray, fallen: int) -> int:
    """Samples to keep of a rotation (n_times,) that is down from sample ``fallen`` on."""
    outward = rotation[:fallen] * np.sign(rotation[fallen])
    home = np.flatnonzero(outward <= 0.0)
    last_impact = int(home[-1]) if home.size else 0
    came_back = float(np.max(np.abs(outward[: last_impact + 1])))
    return last_impact + int(np.flatnonzero(outward[last_impact:] <= came_back)[-1]) + 1
