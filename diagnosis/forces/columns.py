"""What an unknown force would leave in every window, without a new model.

The responses G of the windows to short pulses of base acceleration (`diagnosis.fit.whitening`) are what any
force on the leading coordinate leaves: it acts like a base acceleration, to a slowly changing factor. So a law
that is in no library is tested by the column G f, with f taken along the fitted motion for the kinds that the
model declares (`models.identification.Force`); a jump of the rate at an event is one pulse of unit area.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from diagnosis.fit.linearisation import Linearisation, linearise_about
from diagnosis.fit.solver import Fitted
from diagnosis.fit.whitening import HALF_WIDTH, Responses, responses
from diagnosis.forces.action import states_along
from models.base import FloatArray
from models.identification import Force, Motion


@dataclass(frozen=True)
class Forces:
    """The fitted motion of every window, and how to turn a force along it into a column.

    ``motion`` and ``time`` (W, N) along the windows; ``peak`` (W, 1), largest coordinate of each; ``weight``
    (W, K, N) of a sample in a pulse; ``jumps``: (window, sample, rate before) of the events that separate phases.
    """

    fitted: Fitted
    screen: Linearisation
    response: Responses
    motion: Motion
    time: FloatArray
    peak: FloatArray
    weight: FloatArray
    jumps: tuple[tuple[int, float, float], ...]

    @property
    def kinds(self) -> tuple[Force, ...]:
        """The kinds of force that the model declares."""
        return self.fitted.measured.identification.forces

    def column(self, kind: Force, factor: FloatArray | None = None) -> FloatArray:
        """Whitened residual (W, M), off the states, that a force of this kind times ``factor`` (W, N) leaves."""
        return self.screen.reduced(self.fitted.misfit.whitening(self.predicted(kind, factor)))[0]

    def predicted(self, kind: Force, factor: FloatArray | None = None) -> FloatArray:
        """Change (W, C, N) of the channels by a force of this kind times ``factor`` (W, N)."""
        modulation = np.ones_like(self.time) if factor is None else factor
        if kind.along is None:
            pulses = np.zeros(self.weight.shape[:2])
            for w, sample, rate in self.jumps:
                k = int(sample)  # still on the side it comes from
                share = self.weight[w, :, k]
                pulses[w] += rate * modulation[w, k] * share / max(share.sum(), 1e-12) / HALF_WIDTH
        else:
            pulses = np.einsum("wkn,wn->wk", self.weight, kind.along(self.motion) * modulation, optimize=True)
        return np.asarray(np.einsum("wcnk,wk->wcn", self.response.values, pulses, optimize=True))


def motion_of(fitted: Fitted) -> Motion:
    """The leading coordinate along the windows of a fit."""
    m = fitted.measured
    lead, name = m.lead, m.identification.leads[0].channel
    if any(name in r.estimated for r in m.recordings):
        coordinate = states_along(fitted.misfit.predictor, fitted.point)[name]
    else:
        coordinate = fitted.misfit.predictor.predict([fitted.point])[0][:, lead]
    step = np.array([m.recordings[w.recording].time_step for w in m.windows])[:, None]
    reach = float(np.max(np.abs(coordinate) * m.mask[:, lead]))
    return Motion(coordinate, np.gradient(coordinate, axis=1) / step, m.base, reach)


def forces(fitted: Fitted) -> Forces:
    """The force columns about a fit."""
    predictor, m = fitted.misfit.predictor, fitted.measured
    mask = m.mask[:, m.lead]
    motion = motion_of(fitted)
    response = responses(predictor, fitted.point)
    step = np.array([m.recordings[w.recording].time_step for w in m.windows])[:, None]
    since = np.arange(motion.coordinate.shape[1])[None] * step
    peak = np.asarray(np.max(np.abs(motion.coordinate) * mask, axis=1, keepdims=True))
    pulses = np.maximum(0.0, 1.0 - np.abs(since[:, None, :] - response.offset[None, :, None]) / HALF_WIDTH)
    pulses = pulses * mask[:, None, :]
    separation = m.identification.separation
    return Forces(
        fitted=fitted,
        screen=linearise_about(fitted),
        response=response,
        motion=motion,
        time=m.first[:, None] * step + since,
        peak=peak,
        weight=pulses / np.maximum(pulses.sum(axis=2, keepdims=True), 1.0),
        jumps=_sign_changes(separation.signal(motion), motion.rate, mask) if separation else (),
    )


def _sign_changes(
    signal: FloatArray, rate: FloatArray, mask: NDArray[np.bool_]
) -> tuple[tuple[int, float, float], ...]:
    """Where the signal (W, N) changes sign: (window, sample, rate just before)."""
    found = []
    for w in range(signal.shape[0]):
        count = int(mask[w].sum())
        signs = np.sign(signal[w, :count])
        for k in np.flatnonzero(signs[1:] * signs[:-1] < 0.0).tolist():
            share = signal[w, k] / (signal[w, k] - signal[w, k + 1])
            found.append((w, float(k + share), float(rate[w, max(k - 1, 0)])))
    return tuple(found)
