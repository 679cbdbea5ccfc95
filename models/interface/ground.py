"""The base's motion as a wall feels it, in pieces on which it is linear in time."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from models.interface.layered import LayeredWall
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


def pieces(wall: LayeredWall, shaking: Shaking, scale: float, until: float) -> Iterator[Piece]:
    """Pieces from 0 to ``until`` (s) for one wall; samples on one straight line make one piece.

    The record may jump at its ends, beyond which only the constant offset acts.
    """
    step, count = shaking.time_step, shaking.horizontal.size
    vertical = np.zeros(count) if shaking.vertical is None else shaking.vertical
    a = float(wall.offset[0]) + scale * shaking.horizontal
    gravity = float(wall.gravity[0]) + float(wall.vertical_factor[0]) * scale * vertical
    kinks = (np.diff(a, n=2) != 0.0) | (np.diff(gravity, n=2) != 0.0)
    knots = [0, *(np.flatnonzero(kinks) + 1).tolist(), count - 1]
    for low, high in pairwise(knots):
        start, end = low * step, high * step
        if start >= until:
            return
        if high > low:
            slope = (a[high] - a[low]) / (end - start), (gravity[high] - gravity[low]) / (end - start)
            first = float(a[low]), float(gravity[low])
            yield Piece(start, min(end, until), first, (float(slope[0]), float(slope[1])))
    if until > shaking.duration:
        yield Piece(shaking.duration, until, (float(wall.offset[0]), float(wall.gravity[0])), (0.0, 0.0))
