"""Windows of recordings as lanes of one call of a model: under which motion, from where, and what acts there."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from models.base import FloatArray
from models.kinematics import ground_along
from models.shaking import Shaking

Ways = Sequence[tuple[int, frozenset[str]]]
"""From which sample on which mechanisms do not act."""


@dataclass(frozen=True)
class Lanes:
    """Windows of recording ``r`` for the points ``members``, window by window of each point.

    Under the same motion ``shaking``, on a base that moves as ``ground``; ``ways``: of each point; ``carried``: what
    the model carries to the windows, arrays (P, n, ...) of all points.
    """

    r: int
    windows: NDArray[np.intp]
    members: Sequence[int]
    shaking: Shaking
    ground: Shaking
    ways: Sequence[Ways]
    carried: Mapping[str, FloatArray]

    @property
    def size(self) -> int:
        return len(self.members) * self.windows.size

    @property
    def kind(self) -> tuple[object, ...]:
        """What lanes of one call share: step and components of the base's motion, what acts, what is carried."""
        s = self.shaking
        off = tuple(off for _, off in self.ways[0])
        return s.time_step, s.vertical is None, s.vertical_acts, off, tuple(self.carried)

    @property
    def instants(self) -> NDArray[np.int64]:
        """Samples (size, changes) at which what acts changes."""
        each = np.array([[at for at, _ in own[1:]] for own in self.ways], np.int64)
        return np.repeat(each, self.windows.size, axis=0)

    def at_start(self, name: str) -> FloatArray:
        found = self.carried[name][np.asarray(self.members)]
        return np.reshape(found, (self.size, *found.shape[2:]))

    def along(self, first: NDArray[np.int64], samples: int) -> tuple[FloatArray, FloatArray]:
        """Accelerations of the base (size, samples) in the windows, which begin at samples ``first`` of all (W,)."""
        across, up = ground_along(self.ground, first[self.windows], samples)
        times = (len(self.members), 1)
        return np.tile(across, times), np.tile(up, times)


def together_along(each: Sequence[tuple[FloatArray, FloatArray]]) -> tuple[FloatArray, FloatArray]:
    """Accelerations of the base, to the right and up, of the lanes of all parts."""
    across, up = zip(*each, strict=True)
    return np.concatenate(across), np.concatenate(up)


def held(ran: Mapping[str, FloatArray], name: str, last: NDArray[np.int64]) -> FloatArray:
    """A channel (n, samples) with the value at sample ``last`` (n,) held beyond it."""
    channel = ran[name]
    samples = np.arange(channel.shape[1])
    if np.all(last >= samples[-1]):
        return channel
    return np.asarray(np.where(samples > last[:, None], np.take_along_axis(channel, last[:, None], axis=1), channel))
