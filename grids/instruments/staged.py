"""Instruments that act from a sample of the recording on, or to one: what they do changes there."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from grids.instruments.base import Channels, Surroundings, Switched
from grids.instruments.whole import moved, recorded
from models.errors import InputError
from models.shaking import Shaking

Sets = Sequence[tuple[int, Switched]]
"""From which sample of the recording on which instruments act; the first from sample 0."""


def moved_in_stages(
    shaking: Shaking, sets: Sets, how: Callable[[Shaking, Switched], Shaking] = moved
) -> Shaking:  # fmt: skip
    """The motion that the base makes; ``how`` for one set of instruments. Raises InputError for a changing clock."""
    each = [how(shaking, instruments) for _, instruments in sets]
    if len(each) == 1:
        return each[0]
    if any(one.time_step != each[0].time_step for one in each):
        raise InputError("the clock of a recording cannot change within it; give 'clock' stages of whole recordings.")
    horizontal = each[0].horizontal.copy()
    for (first, _), one in zip(sets[1:], each[1:], strict=True):
        horizontal[first:] = one.horizontal[first:]
    return replace(each[0], horizontal=horizontal)


def recorded_in_stages(
    channels: Channels,
    sets: Sets,
    around: Surroundings,
    how: Callable[[Channels, Switched, Surroundings], Channels] = recorded,
) -> Channels:
    """Channels (..., samples) as recorded; ``how`` for one set of instruments."""
    found = dict(how(channels, sets[0][1], around))
    sample = np.rint(around.time / around.time_step)
    began: dict[str, float] = {}
    for (_, before), (first, instruments) in pairwise(sets):
        new = {name: first * around.time_step for name in instruments if name not in before}
        began = {name: began[name] for name in instruments if name in began} | new
        later = how(channels, instruments, replace(around, began=began))
        found = {name: np.where(sample >= first, later[name], x) for name, x in found.items()}
    return found
