"""Residuals in units of what is expected: sensor noise, and noise of the measured base motion.

The base noise disturbs the model, so what it leaves in a window is correlated. With responses G to
small base accelerations (triangular pulses of half width D over the window) the covariance of a window is

    C = sigma^2 I + G S G',        S = (sigma_a^2 dt/D + floor^2) I,

and C^-1/2 = sigma^-1 [I - U diag(1 - 1/sqrt(1 + s^2)) U'] by the singular values s of G S^1/2/sigma.
The same responses G show what an unknown force would do (`diagnosis.forces.columns`).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from diagnosis.fit.prediction import Point, Predictor
from models.base import FloatArray

HALF_WIDTH = 0.02
"""s, of a triangular pulse."""
PROBE = 0.01
"""Height of a probing pulse over the peak base acceleration."""
DISTURBANCE = 0.002
"""Share of the peak base acceleration that stands for details no model has, as a white disturbance at 5 ms."""
DISTURBANCE_STEP = 0.005


@dataclass(frozen=True)
class Whitening:
    """``scale`` (W, C, N) is mask over sigma; ``basis`` (W, M, K) and ``shrink`` (W, K) as above, M = C N."""

    scale: FloatArray
    basis: FloatArray | None = None
    shrink: FloatArray | None = None

    def __call__(self, difference: FloatArray) -> FloatArray:
        """Whitened residuals (..., W, M) of differences (..., W, C, N)."""
        scaled = difference * self.scale
        flat = scaled.reshape(*scaled.shape[:-2], -1)
        if self.basis is None or self.shrink is None:
            return flat
        inside = np.einsum("wmk,...wm->...wk", self.basis, flat, optimize=True)
        return np.asarray(flat - np.einsum("wmk,...wk->...wm", self.basis, inside * self.shrink, optimize=True))

    def draw(self, rng: np.random.Generator) -> FloatArray:
        """Noise (W, C, N) of the covariance C, in units of sigma."""
        white = rng.normal(size=self.scale.shape)
        if self.basis is None or self.shrink is None:
            return white
        s = np.sqrt(np.maximum((1.0 - self.shrink) ** -2 - 1.0, 0.0))
        inside = s * rng.normal(size=s.shape)
        return np.asarray(white + np.einsum("wmk,wk->wm", self.basis, inside).reshape(white.shape))


def sensor_noise_only(predictor: Predictor) -> Whitening:
    m = predictor.measured
    return Whitening(m.mask / m.sigma[:, :, None])


@dataclass(frozen=True)
class Responses:
    """Responses (W, C, N, K) to pulses of base acceleration (per m s-2) centred at ``offset`` (K,) s from the start."""

    offset: FloatArray
    values: FloatArray


def responses(predictor: Predictor, point: Point) -> Responses:
    """What small base accelerations would do to every window, by one run a pulse."""
    m = predictor.measured
    duration = max(w.samples * m.recordings[w.recording].time_step for w in m.windows)
    offset = np.arange(0.0, duration, HALF_WIDTH)
    height = [PROBE * max(float(np.max(np.abs(s.horizontal))), 1e-3) for s in m.shakings]
    plain = predictor.predict([point])[0]
    found = np.zeros((*plain.shape, offset.size))
    per_height = 1.0 / np.array(height)[m.recording_of][:, None, None]
    for k, centre in enumerate(offset):
        probing = []
        for r, shaking in enumerate(m.shakings):
            more = np.zeros(shaking.horizontal.size)
            for window in m.windows:
                if window.recording == r:
                    inside = slice(window.first, window.first + window.samples)
                    time = np.arange(window.samples) * shaking.time_step
                    more[inside] += np.maximum(0.0, 1.0 - np.abs(time - centre) / HALF_WIDTH)
            probing.append(replace(shaking, horizontal=shaking.horizontal + height[r] * more))
        found[..., k] = (predictor.predict([point], probing)[0] - plain) * per_height
    return Responses(offset, found)


def with_base_noise(predictor: Predictor, response: Responses) -> Whitening:
    """The whitening of sensor noise and base noise together."""
    m = predictor.measured
    plain = sensor_noise_only(predictor)
    variance = []
    for r, recording in enumerate(m.recordings):
        floor = DISTURBANCE * float(np.max(np.abs(m.shakings[r].horizontal)))
        variance.append((m.base_noise[r] ** 2 * recording.time_step + floor**2 * DISTURBANCE_STEP) / HALF_WIDTH)
    deviation = np.sqrt(np.array(variance))[m.recording_of]
    spread = response.values * plain.scale[..., None] * deviation[:, None, None, None]
    flat = spread.reshape(spread.shape[0], -1, spread.shape[-1])
    u, s, _ = np.linalg.svd(flat, full_matrices=False)
    return replace(plain, basis=u, shrink=1.0 - 1.0 / np.sqrt(1.0 + s**2))
