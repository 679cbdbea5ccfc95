"""Residuals in units of what is expected: sensor noise, and noise of the measured base motion.

The base noise disturbs the model, so what it leaves in a window is correlated. With responses G to
small base accelerations (triangular pulses of half width D over the window) the covariance of a window is

    C = sigma^2 I + G S G',        S = (sigma_a^2 dt/D + floor^2) I,

and C^-1/2 = sigma^-1 [I - U diag(1 - 1/sqrt(1 + s^2)) U'] by the singular values s of G S^1/2/sigma.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from diagnosis.data.measured import Measured
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
    """Averages of ``measured`` in units of what is expected.

    ``sensor``: one over the deviation (W, C, n) of independent errors, 0 where nothing is compared, or (W, C, n, n),
    the inverse of the lower Cholesky factor of their covariance; ``basis`` (W, M, K) and ``shrink`` (W, K) as above, M
    = C n. Errors that windows share, such as a drift, are ``shared`` (W, M, S), whitened columns of independent normal
    numbers; a fit finds these as its ``level`` (S,).
    """

    measured: Measured
    sensor: FloatArray
    basis: FloatArray | None = None
    shrink: FloatArray | None = None
    shared: FloatArray | None = None
    level: FloatArray | None = None

    def __call__(self, difference: FloatArray) -> FloatArray:
        """Whitened residuals (..., W, M) of differences (..., W, C, N)."""
        return self.of_averages(self.measured.averaged(difference))

    def of_averages(self, averages: FloatArray) -> FloatArray:
        """Whitened residuals (..., W, M) of averages (..., W, C, n)."""
        flat = self.of_sensors(averages)
        if self.basis is None or self.shrink is None:
            return flat
        rows = np.moveaxis(flat.reshape(-1, *flat.shape[-2:]), 0, -1)
        inside = np.swapaxes(self.basis, 1, 2) @ rows
        rows = rows - self.basis @ (self.shrink[:, :, None] * inside)
        return np.ascontiguousarray(np.moveaxis(rows, -1, 0)).reshape(flat.shape)

    def averages(self, rows: FloatArray) -> FloatArray:
        """Averages (..., W, C, n) whose residuals are ``rows`` (..., W, M); 0 where nothing is compared."""
        if self.basis is not None and self.shrink is not None:
            inside = np.einsum("wmk,...wm->...wk", self.basis, rows, optimize=True)
            more = self.shrink / (1.0 - self.shrink)
            rows = rows + np.einsum("wmk,...wk->...wm", self.basis, more * inside, optimize=True)
        each = rows.reshape(*rows.shape[:-1], *self.sensor.shape[1:3])
        compared = self.measured.compared
        if self.sensor.ndim == 3:
            return np.asarray(np.where(compared, each / np.where(compared, self.sensor, 1.0), 0.0))
        factor = np.linalg.inv(self.sensor + np.eye(compared.shape[2]) * ~compared[..., None])
        found = np.einsum("wcij,...wcj->...wci", factor, np.where(compared, each, 0.0), optimize=True)
        return np.asarray(found)

    def of_windows(self, windows: NDArray[np.int64]) -> Whitening:
        """The whitening of some of the windows."""
        parts = (self.basis, self.shrink, self.shared)
        basis, shrink, shared = (None if each is None else each[windows] for each in parts)
        return Whitening(self.measured.of_windows(windows), self.sensor[windows], basis, shrink, shared, self.level)

    def of_sensors(self, averages: FloatArray) -> FloatArray:
        """Averages (..., W, C, n) in units of the sensors' errors, flat (..., W, M)."""
        if self.sensor.ndim == 3:
            found = averages * self.sensor
        else:
            rows = np.moveaxis(averages.reshape(-1, *averages.shape[-3:]), 0, -1)
            found = np.moveaxis(self.sensor @ rows, -1, 0)
        return np.ascontiguousarray(found).reshape(*averages.shape[:-2], -1)

    def without(self, channel: int) -> Whitening:
        """The whitening of all channels but one, of which nothing is compared; without errors that windows share."""
        sensor = self.sensor.copy()
        sensor[:, channel] = 0.0
        others = replace(self, sensor=sensor, shared=None, level=None)
        if self.basis is None or self.shrink is None:
            return others
        kept = np.repeat(np.arange(sensor.shape[1]) != channel, sensor.shape[2])
        size = np.sqrt(1.0 / (1.0 - self.shrink) ** 2 - 1.0)
        return others._beside(self.basis * size[:, None, :] * kept[:, None])

    def with_columns(self, columns: FloatArray) -> Whitening:
        """The whitening of the sensors' errors and of independent normal numbers times ``columns`` (W, C, N, K)."""
        if not columns.shape[-1]:
            return self
        each = self.of_sensors(self.measured.averaged(np.moveaxis(columns, -1, 0)))
        return self._beside(np.moveaxis(each, 0, -1))

    def _beside(self, each: FloatArray) -> Whitening:
        """With ``each`` (W, M, K), columns in units of the sensors' errors, beside these."""
        u, s, _ = np.linalg.svd(each, full_matrices=False)
        return replace(self, basis=u, shrink=1.0 - 1.0 / np.sqrt(1.0 + s**2))

    def with_shared(self, columns: FloatArray) -> Whitening:
        """The same with errors that windows share: independent normal numbers times columns (W, C, N, S)."""
        each = np.moveaxis(self(np.moveaxis(columns, -1, 0)), 0, -1)
        return replace(self, shared=each, level=np.zeros(each.shape[-1]))


def sensor_noise_only(predictor: Predictor) -> Whitening:
    m = predictor.measured
    return Whitening(m, m.compared * np.sqrt(m.strides)[:, None, None] / m.first_errors[:, :, None])


@dataclass(frozen=True)
class Responses:
    """Responses (W, C, N, K) to pulses of base acceleration (per m s-2) centred at ``offset`` (K,) s from the start."""

    offset: FloatArray
    values: FloatArray


def responses(predictor: Predictor, point: Point) -> Responses:
    """What small base accelerations would do to every window, by one run a pulse."""
    m = predictor.measured
    duration = max(w.samples * step for w, step in zip(m.windows, m.time_steps, strict=True))
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
    return sensor_noise_only(predictor).with_columns(base_columns(predictor, response))


def base_columns(predictor: Predictor, response: Responses) -> FloatArray:
    """What the noise of the base motion leaves: columns (W, C, N, K) of unit variance."""
    m = predictor.measured
    deviation = pulse_deviation(m)[m.recording_of]
    return np.asarray(response.values * m.mask[..., None] * deviation[:, None, None, None])


def pulse_deviation(measured: Measured) -> FloatArray:
    """Standard deviation of the pulses of base noise (m s-2) by recording."""
    m, variance = measured, []
    for r, recording in enumerate(m.recordings):
        floor = DISTURBANCE * float(np.max(np.abs(m.shakings[r].horizontal)))
        variance.append((m.base_noise[r] ** 2 * recording.time_step + floor**2 * DISTURBANCE_STEP) / HALF_WIDTH)
    return np.sqrt(np.array(variance, np.float64))
