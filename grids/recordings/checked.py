"""What a recording must be that was not read but made or changed in Python."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from grids.arrays import real_number, real_numbers
from grids.recordings.base import CHANNELS, REQUIRED, Recording, unknown_channel
from models.errors import InputError


def checked(recording: Recording) -> Recording:
    """The recording with its channels as arrays; InputError about what a reader would not have let pass."""
    try:
        return _checked(recording)
    except InputError as error:
        raise InputError(f"recording {recording.name}: {error}") from None


def _checked(recording: Recording) -> Recording:
    step = real_number(recording.time_step)
    if step is None or not 0.0 < step < math.inf:
        raise InputError(f"time_step is {recording.time_step!r}: give a positive number, in s")
    if not isinstance(recording.channels, Mapping) or REQUIRED not in recording.channels:
        raise InputError(f"channels lack {REQUIRED}: add it, zeros for free rocking")
    time = real_numbers(recording.time, "time")
    if time.ndim != 1 or not np.allclose(time, step * np.arange(time.size), rtol=1e-6, atol=1e-6 * step):
        raise InputError(f"time is not 0, time_step, 2 time_step ...: give {step:g} * numpy.arange(number of samples)")
    channels = {}
    for name, values in recording.channels.items():
        if name not in CHANNELS and name not in recording.places:
            raise InputError(f"channel {unknown_channel(name)}")
        by_level = name in CHANNELS and CHANNELS[name].by_level
        wanted = (len(recording.levels), time.size) if by_level else (time.size,)
        channels[name] = real_numbers(values, f"channel {name}")
        if channels[name].shape != wanted:
            axes = "levels and samples" if by_level else "samples"
            raise InputError(f"channel {name} has shape {channels[name].shape}: give {wanted} {axes}, as time has")
        if not np.isfinite(channels[name]).all():
            raise InputError(f"channel {name} holds values that are not finite: cut them off or leave the channel out")
    return replace(recording, time_step=step, time=time, channels=channels)
