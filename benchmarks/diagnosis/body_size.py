"""How large an effect of two bodies is: what it changes, over the noise, and what is left of that by a refit.

Windows start from the true rotations; what the layers carry is carried along them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import lsq_linear

from benchmarks.diagnosis import instruments
from benchmarks.diagnosis.bodies import HELD, ROTATIONS, Truth
from benchmarks.diagnosis.scene import FloatArray
from models.runs import Prescribed
from models.shaking import Shaking

NOISE = 0.01
"""Of a rotation, over its peak."""
SEEN = 8.0
"""Times the noise that the lower body turns in a window that counts."""
ROUNDS, GAINED, CHANGE = 6, 0.02, 0.01
"""Of a refit: steps at most, the share of the misfit under which it ends, the change of a parameter for differences."""
SHARES, SLACK = (1.0, 0.4, 0.1), 1e-9
UNABLE = 1e3
"""Residual, over the noise, of what the model cannot do."""


@dataclass(frozen=True)
class Windows:
    """Windows of one recording that start from the true rotations, under refitted parameters true exp(u).

    ``seen`` (2, k): the rotations in them over the noise (2,).
    """

    truth: Truth
    channels: dict[str, FloatArray]
    measured: Shaking
    first: NDArray[np.int64]
    samples: int
    noise: FloatArray
    seen: FloatArray

    @classmethod
    def of(cls, truth: Truth, sensors: instruments.Sensors, shaking: Shaking, peak: float, coarse: bool) -> Windows:
        channels, step = truth.rotations(shaking, coarse), shaking.time_step
        base = instruments.base(shaking.horizontal, step, sensors)
        seen = np.stack([instruments.response(channels[c], shaking.horizontal, step, sensors, peak) for c in ROTATIONS])
        noise = NOISE * np.max(np.abs(seen), axis=1)
        samples = round(truth.of.window(truth.values) / step)
        first = np.arange(0, shaking.horizontal.size - samples, samples)
        first = first[[bool(np.max(np.abs(seen[0, k : k + samples])) > SEEN * noise[0]) for k in first]]
        index = first[:, None] + np.arange(samples)
        inside = np.stack([x[index].ravel() / s for x, s in zip(seen, noise, strict=True)])
        return cls(truth, channels, Shaking(step, base), first, samples, noise, inside)

    def rms(self, residuals: FloatArray) -> list[float]:
        """Of residuals (n, k or more: priors are left out), over the noise."""
        return [float(np.sqrt(np.mean(one[: self.seen.size] ** 2))) for one in residuals]

    def residuals(self, u: FloatArray) -> FloatArray:
        """Seen less predicted (n, k) of n sets of u (n, p)."""
        of, true, lanes = self.truth.of, self.truth.values, len(u)
        varied: dict[str, float | FloatArray] = {**true}
        varied |= {name: true[name] * np.exp(u[:, k]) for k, name in enumerate(of.refitted)}
        motion = {name: self.channels[name][None] for name in HELD}
        along = Prescribed(motion, self.first, np.zeros(lanes, np.int64))
        carried = of.model.carry(varied, self.measured, along)
        initial = {name: np.tile(self.channels[name][self.first], lanes) for name in HELD}
        initial |= {name: x.reshape(-1, *x.shape[2:]) for name, x in carried.items()}
        each = {name: x if isinstance(x, float) else np.repeat(x, self.first.size) for name, x in varied.items()}
        ran = of.model.trajectories(
            each, self.measured, first=np.tile(self.first, lanes), samples=self.samples, initial=initial
        )
        predicted = [ran[c].reshape(lanes, -1) / s for c, s in zip(ROTATIONS, self.noise, strict=True)]
        found = (self.seen - np.stack(predicted, axis=1)).reshape(lanes, -1)
        return np.where(np.isfinite(found), found, UNABLE)

    def linearised(self, u: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Residuals (k,) at u (p,), priors on u last, and their derivatives (k, p)."""
        each = CHANGE * np.eye(u.size)
        plain, *moved = self.residuals(np.concatenate([u[None], u + each, u - each]))
        columns = (np.array(moved[: u.size]) - np.array(moved[u.size :])).T / (2.0 * CHANGE)
        tolerances = np.array(list(self.truth.of.refitted.values()))
        return np.concatenate([plain, u / tolerances]), np.vstack([columns, np.diag(1.0 / tolerances)])

    @property
    def bounds(self) -> tuple[FloatArray, FloatArray]:
        """Of u (p,), low and high."""
        of, true = self.truth.of, self.truth.values
        low, high = np.array([of.bounds(name, true[name]) for name in of.refitted]).T
        return low, high


def strength(truth: Truth, sensors: instruments.Sensors, shaking: Shaking, peak: float, coarse: bool = False) -> float:
    """Rms over the noise of what an effect changes in one recording, less what a linear refit takes up."""
    windows = Windows.of(truth, sensors, shaking, peak, coarse)
    if not windows.first.size:
        return 0.0
    wanted, columns = windows.linearised(np.zeros(len(truth.of.refitted)))
    change = np.linalg.lstsq(columns, -wanted, rcond=None)[0]
    return windows.rms((wanted + columns @ change)[None])[0]


def left(truth: Truth, sensors: instruments.Sensors, shaking: Shaking, peak: float) -> float:
    """The same, less what the best refit found takes up: Gauss and Newton's steps within the ranges."""
    windows = Windows.of(truth, sensors, shaking, peak, coarse=False)
    if not windows.first.size:
        return 0.0
    u, (low, high) = np.zeros(len(truth.of.refitted)), windows.bounds
    least = windows.rms(windows.residuals(u[None]))[0]
    for _ in range(ROUNDS):
        wanted, columns = windows.linearised(u)
        change = lsq_linear(columns, -wanted, (low - u - SLACK, high - u + SLACK)).x
        steps = np.clip(u + np.outer(SHARES, change), low, high)
        found = windows.rms(windows.residuals(steps))
        best = int(np.argmin(found))
        if not found[best] < (1.0 - GAINED) * least:
            break
        u, least = steps[best], found[best]
    return least
