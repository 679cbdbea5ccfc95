"""The sensors' errors as a whitening of windows: those they were estimated from, or others of the same channels."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from diagnosis.data.measured import Measured
from diagnosis.errors.components import Component
from diagnosis.errors.pieces import FLOOR, growth
from diagnosis.fit.whitening import Whitening
from models.base import FloatArray


def of_sensors(
    components: Sequence[Component],
    theta: FloatArray,
    unit: FloatArray,
    names: Sequence[str],
    peaks: FloatArray,
    measured: Measured,
) -> Whitening:
    """By the inverse Cholesky factor of each channel's errors in each window.

    ``unit`` (C,) and ``peaks`` (C,) that growing noise is given over, and the components' channels are those of
    ``names``; the errors of other channels are white.
    """
    m = measured
    n = m.compared.shape[2]
    index = np.arange(n)
    factor = np.zeros((*m.compared.shape, n))
    places = [names.index(name) if name in names else -1 for name in m.channels]
    known = np.append(unit, 1.0)[places]
    units = m.units if m.stretches is None else np.broadcast_to(known, m.sigma.shape)
    grown, stationary = growth(m, np.append(peaks, 1.0)[places], known / units), {}
    for w, window in enumerate(m.windows):
        stride = int(m.strides[w])
        step = m.recordings[window.recording].time_step * stride
        for c, name in enumerate(m.channels):
            inside = np.flatnonzero(m.compared[w, c])
            if name not in names:
                factor[w, c][inside, inside] = np.sqrt(stride) / m.sigma[w, c]
                continue
            own = names.index(name)
            acting = [(k, float(t)) for k, t in zip(components, theta, strict=True) if k.channel == own and t > 0.0]
            if (c, step, stride) not in stationary:
                lag = np.abs(index[:, None] - index[None, :]) * step
                found = FLOOR / stride * np.eye(n)
                for component, value in acting:
                    if not component.moving and not component.shared:
                        found += value * component.kernel(lag) / (stride if component.kind == "white" else 1.0)
                stationary[c, step, stride] = found
            covariance = stationary[c, step, stride][np.ix_(inside, inside)].copy()
            growing = sum(value for component, value in acting if component.kind == "growing")
            covariance[range(inside.size), range(inside.size)] += growing * grown[w, c, inside] / stride
            factor[w, c][np.ix_(inside, inside)] = np.linalg.inv(np.linalg.cholesky(covariance)) / units[w, c]
    return Whitening(m, factor)
