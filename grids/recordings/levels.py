"""Channels level by level: ``level_displacement_x`` over two levels is ``level_displacement_x_0`` and ``_1``."""

from __future__ import annotations

import re
from dataclasses import replace

from grids.recordings.base import CHANNELS, Recording

BY_LEVEL = tuple(name for name, channel in CHANNELS.items() if channel.by_level)


def stem(name: str) -> str:
    """The standard channel of a level's own channel; any other name as it is."""
    match = re.fullmatch(rf"({'|'.join(BY_LEVEL)})_(\d+)", name)
    return match[1] if match else name


def level_by_level(recording: Recording) -> Recording:
    """The recording with every channel over time alone, levels numbered from 0 in the order of the recording."""
    channels = {}
    for name, values in recording.channels.items():
        if values.ndim == 1:
            channels[name] = values
        else:
            channels |= {f"{name}_{k}": row for k, row in enumerate(values)}
    return replace(recording, channels=channels)
