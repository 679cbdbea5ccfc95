"""Channels level by level: ``level_displacement_x`` over levels 0 and 3 is ``level_displacement_x_0`` and ``_3``.

A level goes by its number, from 0 for the slab above the bearings: a recording need not hold all levels, nor in order.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

from grids.recordings.base import CHANNELS, Recording
from models.errors import InputError

BY_LEVEL = tuple(name for name, channel in CHANNELS.items() if channel.by_level)


def stem(name: str) -> str:
    """The standard channel of a level's own channel; any other name as it is."""
    match = re.fullmatch(rf"({'|'.join(BY_LEVEL)})_(\d+)", name)
    return match[1] if match else name


def level_of(name: str) -> int | None:
    """The number of the level in a level's own channel; None for any other name."""
    return None if stem(name) == name else int(name.rpartition("_")[2])


def numbered(labels: Sequence[str]) -> tuple[str, ...]:
    """The numbers of the levels that a file holds. Raises InputError for what is none, or stands twice."""
    for label in labels:
        if not re.fullmatch(r"\d+", label):
            raise InputError(
                f"level '{label}' is no whole number from 0: number the levels from 0, the slab above the bearings."
            )
    found = tuple(str(int(label)) for label in labels)
    if twice := [level for k, level in enumerate(found) if level in found[:k]]:
        raise InputError(f"level {twice[0]} stands twice in {', '.join(labels)}: give every level a number of its own.")
    return found


def level_by_level(recording: Recording) -> Recording:
    """The recording with every channel over time alone, those of a level by its number."""
    channels = {}
    for name, values in recording.channels.items():
        if values.ndim == 1:
            channels[name] = values
        else:
            channels |= {f"{name}_{k}": row for k, row in zip(recording.levels, values, strict=True)}
    return replace(recording, channels=channels)
