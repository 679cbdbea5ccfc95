"""The base's motion in pieces on which it is linear in time, as the references integrate it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Protocol

import numpy as np

from models.base import FloatArray
from models.pitch import pitch
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


@dataclass(frozen=True)
class PitchedPiece:
    """``start`` <= t <= ``end`` (s), on which a, G, psi and psi'' are linear in time."""

    start: float
    end: float
    first: tuple[float, ...]
    slope: tuple[float, ...]

    def at(self, time: float) -> tuple[float, float, float]:
        """a - G psi, G (m s-2) and psi'' (rad s-2)."""
        past = time - self.start
        a, gravity, psi, second = (v + past * d for v, d in zip(self.first, self.slope, strict=True))
        return a - gravity * psi, gravity, second


def pitched_pieces(
    wall: BaseMotion, shaking: Shaking, scale: float, until: float, per_acceleration: float, low_pass: float
) -> Iterator[PitchedPiece]:
    """As `pieces`, of a base that pitches by ``per_acceleration`` (rad s2 m-1) below ``low_pass`` (Hz)."""
    offset, gravity, factor = wall.offset.item(), wall.gravity.item(), wall.vertical_factor.item()
    horizontal, psi = scale * shaking.horizontal, np.zeros((2, shaking.horizontal.size))
    vertical = np.zeros_like(horizontal) if shaking.vertical is None else shaking.vertical
    if per_acceleration != 0.0:
        psi = per_acceleration * scale * np.stack(pitch(shaking, low_pass))
    samples = np.stack([offset + horizontal, gravity + factor * scale * vertical, *psi])
    for low, high in straight(samples):
        start, end = low * shaking.time_step, high * shaking.time_step
        if start >= until:
            return
        slope = (samples[:, high] - samples[:, low]) / (end - start)
        yield PitchedPiece(start, min(end, until), tuple(samples[:, low].tolist()), tuple(slope.tolist()))
    if until > shaking.duration:
        yield PitchedPiece(shaking.duration, until, (offset, gravity, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0))


def straight(samples: FloatArray) -> Iterator[tuple[int, int]]:
    """Index pairs (low, high) of the longest runs on which every row of ``(k, n)`` is one straight line."""
    count = samples.shape[1]
    kinks = np.flatnonzero(np.any(np.diff(samples, n=2, axis=1) != 0.0, axis=0)) + 1
    yield from ((low, high) for low, high in pairwise([0, *kinks.tolist(), count - 1]) if high > low)


def _two(values: FloatArray) -> tuple[float, float]:
    first, second = values.tolist()
    return first, second
