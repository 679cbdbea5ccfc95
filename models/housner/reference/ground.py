"""The ground's motion as it acts on one block, in pieces on which it is smooth."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from models.base import FloatArray
from models.ground import straight
from models.housner.block import Block
from models.housner.pitch import pitch
from models.shaking import Shaking


@dataclass(frozen=True)
class Piece:
    """``start`` <= t <= ``end`` (s), on which a, G, psi and psi'' are linear in time."""

    start: float
    end: float
    first: tuple[float, float, float, float]
    slope: tuple[float, float, float, float]

    def at(self, time: float) -> tuple[float, float, float]:
        """a - G psi, G (m s-2) and psi'' (rad s-2)."""
        past = time - self.start
        a, gravity, psi, second = (v + past * d for v, d in zip(self.first, self.slope, strict=True))
        return a - gravity * psi, gravity, second


def pieces(block: Block, shaking: Shaking, scale: float, until: float) -> Iterator[Piece]:
    """Pieces from 0 to ``until``, for a block of one lane.

    The record has a kink at every sample and may jump at its ends, beyond which only the block's
    constant ``offset`` acts; samples on one straight line are taken together.
    """
    step, count = shaking.time_step, shaking.horizontal.size
    gravity, factor = float(block.gravity[0]), float(block.pitch_per_acceleration[0])
    offset = float(block.offset[0])
    horizontal = scale * shaking.horizontal
    vertical = np.zeros(count) if shaking.vertical is None else shaking.vertical
    if factor != 0.0:
        psi, second = pitch(horizontal, step, float(block.pitch_low_pass[0]))
    else:
        psi = second = np.zeros(count)
    samples = np.stack(
        [
            offset + horizontal,
            gravity + float(block.vertical_factor[0]) * scale * vertical,
            factor * psi,
            factor * second,
        ]
    )
    for low, high in straight(samples):
        start, end = low * step, high * step
        if start >= until:
            return
        slope = (samples[:, high] - samples[:, low]) / (end - start)
        yield Piece(start, min(end, until), _four(samples[:, low]), _four(slope))
    if until > shaking.duration:
        yield Piece(shaking.duration, until, (offset, gravity, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0))


def _four(values: FloatArray) -> tuple[float, float, float, float]:
    a, gravity, psi, second = values.tolist()
    return a, gravity, psi, second
