"""The pieces of the recordings that tell of their errors: here the windows of the motion.

While nothing moves (`diagnosis.errors.stills`) a sensor's noise stands alone; in a window the model's residual lies on
top of it. Both enter one likelihood, so that noise is told from what the model lacks. Values are averages
(`diagnosis.data.averaging`) in units of each channel's noise level.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from diagnosis.data.measured import Measured
from diagnosis.errors.base_drift import SHARE, of_pulses
from diagnosis.errors.components import Component, Diagonal, Kind, LowRank, Part, Stationary
from diagnosis.errors.drifts import knots_of
from diagnosis.errors.likelihood import Piece, Prior
from diagnosis.errors.own import own_error
from diagnosis.fit.misfit import Linear, Misfit
from diagnosis.fit.solver import Fitted
from diagnosis.fit.whitening import Whitening
from models.base import FloatArray

LARGEST_DRIFT = 1.0
"""Variance of a drift over that of the noise; a sensor that is knocked goes further."""
LARGEST: dict[Kind, float] = {"scatter": 0.03**2, "base_drift": (0.0075 / SHARE) ** 2}
"""Variance of the relative change of the rate by an event, and of each shape of a drift of the base accelerometer's
zero; a law that changes goes further, and so does a tilt."""
KEPT = 128
"""Samples of a piece up to which its kernels are kept for the next estimate: .1 MB each."""
FLOOR = 0.02
"""Variance of white noise that is always there, over that of the noise level: solvers and storage are not exact."""


@dataclass(frozen=True)
class Scene:
    """A fit opened up: residuals and derivatives of its windows in units of the channels' noise in each recording.

    ``unit`` (C,): that over all recordings.

    ``linear``: averages (W, M) and so on; ``known``, ``pulses`` and ``kicks`` (W, C, n, K): columns of base noise
    and sensors' memory, of pulses that a drift of the base accelerometer's zero is made of, and of events.
    """

    fitted: Fitted
    unit: FloatArray
    linear: Linear
    known: FloatArray
    pulses: FloatArray
    kicks: FloatArray


def opened(fitted: Fitted, base: FloatArray, past: FloatArray, kicks: FloatArray) -> Scene:
    """``base``, ``past`` and ``kicks`` (W, C, N, K): columns of base noise, of sensors' memory and of events."""
    m = fitted.measured
    whitening = Whitening(m, m.compared / m.units[:, :, None])
    misfit = Misfit(fitted.misfit.predictor, whitening, fitted.misfit.unknowns, fitted.misfit.fixed)

    def scaled(columns: FloatArray) -> FloatArray:
        each = m.averaged(np.moveaxis(columns, -1, 0)) * m.compared / m.units[:, :, None]
        return np.moveaxis(each, 0, -1)

    linear = misfit.linearise(fitted.u, fitted.states)
    known = scaled(np.concatenate([base, past], axis=-1))
    return Scene(fitted, m.unit, linear, known, scaled(of_pulses(m, base)), scaled(kicks))


def prior_of(scene: Scene, components: Sequence[Component]) -> Prior:
    """Of the base parameters and of the drifts."""
    rows, slopes = scene.fitted.misfit.prior_rows(scene.fitted.u)
    knots = knots_of(scene.fitted.measured, components)
    drifts = () if knots is None else tuple(knots.covariance(c) for c in components)
    largest = tuple(LARGEST.get(c.kind, LARGEST_DRIFT if c.shared else np.inf) for c in components)
    return Prior(slopes.T @ slopes, slopes.T @ rows, drifts, largest)


def windows(scene: Scene, components: Sequence[Component]) -> list[Piece]:
    """One piece a window."""
    m = scene.fitted.measured
    found = []
    grown, knots = growth(m, peaks_of(m), m.unit / m.units), knots_of(m, components)
    own_errors = {
        c.scale: own_error(m, c.scale) / scene.unit[:, None, None]
        for c in components
        if c.kind == "inadequacy" and c.channel is None
    }
    for w, window in enumerate(m.windows):
        keep = m.compared[w].ravel()
        channel = np.repeat(np.arange(len(m.channels)), m.compared.shape[2])[keep]
        step = m.recordings[window.recording].time_step * m.strides[w]
        at = np.tile(np.arange(m.compared.shape[2]), len(m.channels))[keep]
        parts: list[Part | Stationary | None] = []
        kicked = scene.kicks[w].reshape(keep.size, -1)[keep]
        near: tuple[()] | tuple[NDArray[np.intp], FloatArray] = ()
        if knots is not None:
            of_sensors = knots.near(window.recording, channel, m.times(w)[0] + at * step)
            of_base = knots.through_base(m, w, scene.pulses[w].reshape(keep.size, -1)[keep])
            near = np.append(of_sensors[0], of_base[0]), np.append(of_sensors[1], of_base[1], axis=1)
        for component in components:
            if component.shared:
                parts.append(None)
                continue
            if component.kind == "scatter":
                parts.append(LowRank(kicked) if kicked.shape[1] else None)
                continue
            if component.scale in own_errors and component.channel is None:
                columns = own_errors[component.scale][w]
                parts.append(LowRank(columns.reshape(keep.size, -1)[keep]))
                continue
            own = np.flatnonzero(channel == component.channel)
            inside = slice(int(own[0]), int(own[-1]) + 1)
            if component.kind == "growing":
                values = np.zeros(channel.size)
                values[inside] = grown[w].ravel()[keep][inside] / m.strides[w]
                parts.append(Diagonal(values))
            else:
                parts.append(stationary(component, at[inside], step, inside, float(m.strides[w])))
        columns = scene.known[w].reshape(keep.size, -1)[keep]
        known = columns @ columns.T + np.diag(np.full(channel.size, FLOOR / m.strides[w]))
        linear = scene.linear
        found.append(
            Piece(
                at * step, channel, linear.residual[w][keep], linear.by_state[w][keep], linear.by_unknown[w][keep],
                known, tuple(parts), *near,
            )
        )  # fmt: skip
    return found


def stationary(component: Component, at: np.ndarray, step: float, inside: slice, stride: float) -> Stationary:
    """A kernel among averages at whole numbers ``at`` of ``step`` s; white noise falls with what is averaged."""
    make = _kernel if at.size <= KEPT else _kernel.__wrapped__
    matrix = make(component.kind, component.scale, at.astype(np.int64).tobytes(), step)
    return Stationary(inside, matrix / stride if component.kind == "white" else matrix)


@lru_cache(maxsize=512)
def _kernel(kind: Kind, scale: float, at: bytes, step: float) -> FloatArray:
    """A kernel (m, m) among the samples ``at``: windows stay what they are while errors are estimated again."""
    numbers = np.frombuffer(at, np.int64)
    found = Component(kind, None, scale).kernel(np.abs(numbers[:, None] - numbers[None, :]) * step)
    found.setflags(write=False)
    return found


def peaks_of(measured: Measured) -> FloatArray:
    """Largest absolute value of each channel (C,) in the windows."""
    size = np.abs(measured.averaged(measured.values)) * measured.compared
    return np.asarray(np.maximum(size.max(axis=(0, 2)), 1e-300))


def growth(measured: Measured, peak: FloatArray, share: FloatArray) -> FloatArray:
    """Squared size of the signal over the ``peak`` (C,) of the recordings that the errors are estimated from.

    Times the squared ``share`` (W, C), their unit over that of each window: such noise has no level of its own in a
    recording.
    """
    size = np.abs(measured.averaged(measured.values)) * measured.compared
    return np.asarray((size / peak[None, :, None] * share[:, :, None]) ** 2, np.float64)
