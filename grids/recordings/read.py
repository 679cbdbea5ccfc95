"""From a file to a checked recording."""

from __future__ import annotations

from dataclasses import replace
from os.path import isdir, isfile  # False for a name that is too long for a file
from pathlib import Path

import numpy as np

from grids.files import path_of
from grids.recordings import csv_toml, netcdf
from grids.recordings.base import CHANNELS, REQUIRED, FloatArray, Raw, Recording
from grids.recordings.lost import with_lost_samples
from grids.recordings.overturned import cut_before_fall
from grids.recordings.suspicions import suspicions_of
from models.errors import InputError, nearest

READERS = (netcdf, csv_toml)
BASE = "base_"
"""How the channels of the base's motion begin."""
UNKNOWN = " is no standard channel"
"""In the note about a channel that is left out, after its name."""
MEANT = "did you mean"


@np.errstate(over="ignore", invalid="ignore")  # what becomes infinite is a sample without a value
def read_recording(path: str | Path, *, base_only: bool = False) -> Recording:
    """Read and check a recording: netCDF, or CSV with a TOML beside it (either may be named).

    Samples without a value are cut off where they stand at the start or the end of the record; inside it they are an
    error, because a filled gap is not a measurement. A recording of a body that overturned is cut before its fall, and
    samples of positions that measure nothing are marked as lost, both with a note. ``base_only``: the motion of the
    base is all that is wanted and returned, as long as its own channels have values, beyond a fall too. Nothing is
    filtered or detrended.
    Raises InputError with one sentence: file, channel, place, cure.
    """
    path = path_of(path, "recording")
    table = path.with_suffix(".csv") if path.suffix == ".toml" else path
    if isdir(table):
        raise InputError(f"recording {table} is a folder; name a file in it.")
    if not isfile(table):
        beside = [p.name for p in table.parent.glob(f"*{table.suffix}")] if table.parent.is_dir() else []
        cure = nearest(table.name, beside) if beside else "check the path."
        raise InputError(f"recording {table} does not exist; {cure}")
    suffixes = [suffix for reader in READERS for suffix in reader.SUFFIXES]
    if table.suffix.lower() not in suffixes:
        raise InputError(f"recording {table.name}: ending '{table.suffix}' is not known; known: {', '.join(suffixes)}.")
    reader = next(r for r in READERS if table.suffix.lower() in r.SUFFIXES)
    try:
        recording = _checked(table.stem, reader.read(table), base_only)
        if not base_only:
            recording = cut_before_fall(with_lost_samples(recording))
        return replace(
            recording,
            source={"file": table.name, **recording.source},
            suspicions=(*recording.suspicions, *suspicions_of(recording)),
        )
    except InputError as error:
        raise InputError(f"recording {table.name}: {str(error).removeprefix(f'{table.name}: ')}") from None


def _checked(name: str, raw: Raw, base_only: bool) -> Recording:
    if REQUIRED not in raw.channels:
        found = ", ".join([*raw.channels, *(note.partition(UNKNOWN)[0] for note in raw.notes if UNKNOWN in note)])
        raise InputError(
            f"has no {REQUIRED} (found: {found or 'no channel'}); name or map it so, zeros for free rocking."
        )
    if base_only:
        raw = replace(
            raw, channels={c: x for c, x in raw.channels.items() if c.startswith(BASE)}, levels=(), suspicions=()
        )
    if not base_only and not any(c in raw.places or CHANNELS[c].response for c in raw.channels):
        responses = [channel for channel, declared in CHANNELS.items() if declared.response]
        misspelt = [note.removesuffix(" It is left out.") for note in raw.notes if UNKNOWN in note and MEANT in note]
        cure = f"add one of {', '.join(responses)}, or a channel that says its quantity."
        raise InputError(f"has no response (channels: {', '.join(raw.channels)}); {(*misspelt, cure)[0]}")
    first, last = _measured_span(raw)
    notes = list(raw.notes)
    count = raw.channels[REQUIRED].shape[-1]
    if last - first + 1 < count:
        notes.append(f"{first} samples at the start and {count - 1 - last} at the end lack a value and are cut off")
    start = raw.start + first * raw.time_step
    if start != 0.0:
        notes.append(f"time starts at {start:g} s in the file, at 0 s here")
    channels = {}
    for channel, values in raw.channels.items():
        kept = np.ascontiguousarray(values[..., first : last + 1])
        kept.flags.writeable = False
        channels[channel] = kept
    time = np.arange(last - first + 1, dtype=np.float64) * raw.time_step
    return Recording(
        name, raw.time_step, time, channels, raw.levels, tuple(notes), raw.suspicions, raw.source, raw.places,
        band_limited=raw.band_limited,
    )  # fmt: skip


def _measured_span(raw: Raw) -> tuple[int, int]:
    """First and last sample at which every channel has a value; InputError for a gap between."""
    lacking = {channel: _lacking(values) for channel, values in raw.channels.items()}
    whole = ~np.any(list(lacking.values()), axis=0)
    if whole.sum() < 10:
        worst = max(lacking, key=lambda channel: int(lacking[channel].sum()))
        raise InputError(f"{worst} lacks {int(lacking[worst].sum())} of {whole.size} values; leave the channel out.")
    first, last = (int(i) for i in np.flatnonzero(whole)[[0, -1]])
    for channel, missing in lacking.items():
        inside = np.flatnonzero(missing[first : last + 1]) + first
        if inside.size:
            begin = raw.start + float(inside[0]) * raw.time_step
            end = raw.start + float(inside[-1]) * raw.time_step
            where = f"between {begin:.6g} s and {end:.6g} s" if inside.size > 1 else f"at {begin:.6g} s"
            raise InputError(
                f"{channel} lacks {inside.size} value(s) {where}; cut the recording there or leave the channel "
                "out (gaps are not filled)."
            )
    return first, last


def _lacking(values: FloatArray) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    missing = ~np.isfinite(values)
    return np.asarray(missing.any(axis=0) if values.ndim == 2 else missing)
