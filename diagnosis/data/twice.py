"""Refusing the same data given twice: counted double it looks surer than it is, and it cannot test what it taught."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import combinations

import numpy as np

from grids.recordings.base import REQUIRED, FloatArray, Recording
from models.errors import InputError

ALIKE = 1e-4
"""Over the peak of a channel: rounded as another file writes it. Noise makes two tests differ by far more."""


def refuse_twice(training: Sequence[Recording], holdout: Sequence[Recording] = ()) -> None:
    """Raise InputError when two recordings hold the same samples, whatever they are called."""
    for (i, one), (j, other) in combinations(enumerate([*training, *holdout]), 2):
        if not same_samples(one, other):
            continue
        first, second = (
            f"{recording.name} ({recording.source['file']})" if "file" in recording.source else recording.name
            for recording in (one, other)
        )
        across = i < len(training) <= j
        cure = "a recording held out cannot be fitted too; leave one out" if across else "give them once"
        raise InputError(f"recordings {first} and {second} hold the same samples; {cure}.")


def same_samples(one: Recording, other: Recording) -> bool:
    """Whether the base and all responses that both hold are the same, but for rounding."""
    shared = {*one.responses} & {*other.responses}
    if one is other:
        return True
    if not shared or one.time.size != other.time.size or not math.isclose(one.time_step, other.time_step, rel_tol=1e-6):
        return False
    return all(_alike(one.channels[name], other.channels[name]) for name in (REQUIRED, *shared))


def _alike(one: FloatArray, other: FloatArray) -> bool:
    if one.shape != other.shape:
        return False
    return bool(np.max(np.abs(one - other)) <= ALIKE * max(np.max(np.abs(one)), np.max(np.abs(other))))
