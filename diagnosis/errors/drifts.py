"""Slow drifts of the sensors and of the base accelerometer's zero.

Each is one random function over a recording, shared by its windows and still stretches, and linear between knots. It is
zero where a recording begins, if the zero is taken there, and goes on as a random walk; or it is stationary with
the correlation exp(-lag/scale), the slowest part of 1/f noise. A constant error is not among its likely paths: an
instrument's own, it has to stand out of the drift that the recordings show.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from diagnosis.data.measured import Measured
from diagnosis.errors.base_drift import of_pulses
from diagnosis.errors.components import WALK, Component
from diagnosis.fit.whitening import HALF_WIDTH
from models.base import FloatArray

SPACING, MOST = 1.0, 20
"""s between knots, and knots of a channel from which on they lie further apart."""
BASE = -1
"""Stands for a channel where the base accelerometer is meant."""


@dataclass(frozen=True)
class Knots:
    """Knots of every recording and channel, and of the base (`BASE`).

    ``time`` and ``spacing`` in s, ``recording``, ``channel``, all (q,).
    """

    time: FloatArray
    recording: NDArray[np.int64]
    channel: NDArray[np.int64]
    spacing: FloatArray

    def near(
        self, recording: int, channels: NDArray[np.int64], time: FloatArray
    ) -> tuple[NDArray[np.intp], FloatArray]:
        """The knots (p,) that samples (n,) of some ``channels`` (n,) touch, and their weights (n, p)."""
        own = np.flatnonzero(self.recording == recording)
        distance = np.abs(time[:, None] - self.time[own][None, :]) / self.spacing[own]
        weights = np.where(channels[:, None] == self.channel[own][None, :], np.maximum(1.0 - distance, 0.0), 0.0)
        touched = np.flatnonzero(weights.any(axis=0))
        return own[touched], weights[:, touched]

    def through_base(self, measured: Measured, window: int, pulses: FloatArray) -> tuple[NDArray[np.intp], FloatArray]:
        """The base's knots (p,) that a window touches and what they leave (..., p).

        ``pulses`` (..., K): what pulses of base acceleration of one unit leave.
        """
        time = measured.times(window)[0] + HALF_WIDTH * np.arange(pulses.shape[-1])
        at, weights = self.near(measured.windows[window].recording, np.full(time.size, BASE), time)
        return at, np.asarray(pulses @ weights)

    def covariance(self, component: Component) -> FloatArray | None:
        """Of a drift of variance one (q, q); a random walk has it after `WALK`. None for what is no drift."""
        if not component.shared:
            return None
        a, b = self.time[:, None], self.time[None, :]
        walk = np.isinf(component.scale)
        found = np.minimum(a, b) / WALK if walk else np.exp(-np.abs(a - b) / component.scale)
        together = self.recording[:, None] == self.recording[None, :]
        acts = self.channel == (BASE if component.channel is None else component.channel)
        return np.asarray(found * together * np.outer(acts, acts))


def knots_of(measured: Measured, components: Sequence[Component]) -> Knots | None:
    """The knots of all recordings; None where no component is a drift."""
    if not any(component.shared for component in components):
        return None
    rows, channels = [], list(range(len(measured.channels)))
    if any(component.kind == "base_drift" for component in components):
        channels.append(BASE)
    for r, one in enumerate(measured.recordings):
        spacing = max(SPACING, float(one.time[-1]) / MOST)
        count = int(np.ceil(one.time[-1] / spacing)) + 1
        rows += [(spacing * k, r, c, spacing) for c in channels for k in range(count)]
    table = np.array(rows, np.float64)
    return Knots(table[:, 0], table[:, 1].astype(np.int64), table[:, 2].astype(np.int64), table[:, 3])


def columns(knots: Knots, root: FloatArray, measured: Measured, base: FloatArray) -> FloatArray:
    """What independent normal numbers leave in the windows through drifts ``root`` (q, S): columns (W, C, N, S).

    ``base`` (W, C, N, K): what pulses of base noise leave, of unit variance.
    """
    pulses = of_pulses(measured, base)
    found = np.zeros((*measured.values.shape, root.shape[1]))
    samples, units = measured.values.shape[2], measured.units
    for w, window in enumerate(measured.windows):
        at, through = knots.through_base(measured, w, pulses[w])
        found[w] = through @ root[at]
        for c in range(len(measured.channels)):
            at, weights = knots.near(window.recording, np.full(samples, c), measured.times(w))
            found[w, c] += units[w, c] * weights @ root[at]
    return np.where(measured.mask[..., None], found, 0.0)
