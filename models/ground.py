"""The base's motion in pieces on which it is linear in time, as the references integrate it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Protocol

import numpy as np

from models.base import FloatArray
from models.shaking import Shaking


@dataclass(frozen=True)
class Piece:
    """``start`` <= t <= ``end`` (s), with a and G (m s-2) at the start and their slopes (m s-3)."""

    start: float
    end: float
    first: tuple[float, float]
    slope: tuple[float, float]

    def at(self, time: float) -> tuple[float, float]:
        """a and G."""
        past = time - self.start
        return self.first[0] + past * self.slope[0], self.first[1] + past * self.slope[1]


class BaseMotion(Protocol):
    """How the base's motion acts on a wall of one lane: a = offset + scale a_x, G = gravity + factor scale a_z."""

    @property
    def offset(self) -> FloatArray: ...
    @property
    def gravity(self) -> FloatArray: ...
    @property
    def vertical_factor(self) -> FloatArray: ...


def pieces(wall: BaseMotion, shaking: Shaking, scale: float, until: float) -> Iterator[Piece]:
    """Pieces from 0 to ``until`` (s) for one wall.

    The record may jump at its ends, beyond which only the constant offset acts.
    """
    offset, gravity, factor = wall.offset.item(), wall.gravity.item(), wall.vertical_factor.item()
    vertical = 0.0 * shaking.horizontal if shaking.vertical is None else shaking.vertical
    samples = np.stack([offset + scale * shaking.horizontal, gravity + factor * scale * vertical])
    for low, high in straight(samples):
        start, end = low * shaking.time_step, high * shaking.time_step
        if start >= until:
            return
        slope = (samples[:, high] - samples[:, low]) / (end - start)
        yield Piece(start, min(end, until), _two(samples[:, low]), _two(slope))
    if until > shaking.duration:
        yield Piece(shaking.duration, until, (offset, gravity), (0.0, 0.0))


def straight(samples: FloatArray) -> Iterator[tuple[int, int]]:
    """Index pairs (low, high) of the longest runs on which every row of ``(k, n)`` is one straight line."""
    count = samples.shape[1]
    kinks = np.flatnonzero(np.any(np.diff(samples, n=2, axis=1) != 0.0, axis=0)) + 1
    yield from ((low, high) for low, high in pairwise([0, *kinks.tolist(), count - 1]) if high > low)


def _two(values: FloatArray) -> tuple[float, float]:
    first, second = values.tolist()
    return first, second
