"""What an unknown force would leave in every window, without a new model.

The responses G of the windows to small hats of base acceleration (`diagnosis.fit.whitening`) are what any
force leaves: a force f(theta, theta', t) acts like a base acceleration, to the slowly changing
factor cos(alpha - theta). So a law that is in no library is tested by the column G f, with f taken
along the fitted motion; a jump of the velocity at an impact is a narrow hat of unit area.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from diagnosis.fit.linearisation import Linearisation, linearise_about
from diagnosis.fit.solver import Fitted
from diagnosis.fit.whitening import HAT, Responses, responses
from models.base import FloatArray

KINDS = {
    "restitution": "loss of velocity at impacts",
    "viscous_damping": "couple with the angular velocity",
    "coulomb_damping": "couple against the motion",
    "contact": "constant couple on either side",
    "stiffness": "couple with the rotation",
    "lean": "constant couple in one direction",
    "base_motion": "couple with the base acceleration",
}
"""Shapes of forces, named by the parameter that gives such a force."""


@dataclass(frozen=True)
class Forces:
    """The fitted motion of every window, and how to turn a force along it into a column.

    ``rotation``, ``rate``, ``base``, ``time`` (W, N) along the windows; ``weight`` (W, K, N) of a sample in
    a hat; ``jumps``: (window, sample, rate before) of the impacts.
    """

    fitted: Fitted
    screen: Linearisation
    response: Responses
    rotation: FloatArray
    rate: FloatArray
    base: FloatArray
    time: FloatArray
    weight: FloatArray
    jumps: tuple[tuple[int, float, float], ...]

    @cached_property
    def peak(self) -> FloatArray:
        """Largest rotation of each window (W, 1)."""
        mask = self.fitted.measured.mask[:, 0]
        return np.asarray(np.max(np.abs(self.rotation) * mask, axis=1, keepdims=True))

    def along(self, kind: str) -> FloatArray:
        """The force of a kind (W, N), of order one; zero for the one that acts at impacts."""
        scale = float(np.max(self.peak))
        speed = float(np.max(np.abs(self.rate)))
        shapes = {
            "restitution": np.zeros_like(self.rotation),
            "viscous_damping": self.rate / speed,
            "coulomb_damping": np.sign(self.rate),
            "contact": np.sign(self.rotation),
            "stiffness": self.rotation / scale,
            "lean": np.ones_like(self.rotation),
            "base_motion": self.base / max(float(np.max(np.abs(self.base))), 1e-12),
        }
        return np.asarray(shapes[kind])

    def column(self, kind: str, factor: FloatArray | None = None) -> FloatArray:
        """Whitened residual (W, M), off the states, that a force of this kind times ``factor`` (W, N) leaves."""
        modulation = np.ones_like(self.rotation) if factor is None else factor
        if kind == "restitution":
            hats = np.zeros(self.weight.shape[:2])
            for w, sample, rate in self.jumps:
                k = int(sample)  # still on the side it comes from
                share = self.weight[w, :, k]
                hats[w] += rate * modulation[w, k] * share / max(share.sum(), 1e-12) / HAT
        else:
            hats = np.einsum("wkn,wn->wk", self.weight, self.along(kind) * modulation, optimize=True)
        return self.of_hats(hats)

    def of_hats(self, hats: FloatArray) -> FloatArray:
        """Column of base accelerations given hat by hat (W, K)."""
        predicted = np.einsum("wcnk,wk->wcn", self.response.values, hats, optimize=True)
        return self.screen.reduced(self.fitted.misfit.whitening(predicted))[0]


def forces(fitted: Fitted) -> Forces:
    """The force columns about a fit."""
    misfit = fitted.misfit
    predictor, m = misfit.predictor, misfit.measured
    point = fitted.point
    predicted = predictor.predict([point])[0][:, 0]
    response = responses(predictor, point)
    step = np.array([m.recordings[w.recording].time_step for w in m.windows])[:, None]
    since = np.arange(predicted.shape[1])[None] * step
    rate = np.gradient(predicted, axis=1) / step
    hats = np.maximum(0.0, 1.0 - np.abs(since[:, None, :] - response.offset[None, :, None]) / HAT)
    hats = hats * m.mask[:, 0][:, None, :]
    weight = hats / np.maximum(hats.sum(axis=2, keepdims=True), 1.0)
    return Forces(
        fitted=fitted,
        screen=linearise_about(fitted),
        response=response,
        rotation=predicted,
        rate=rate,
        base=m.base,
        time=m.first[:, None] * step + since,
        weight=weight,
        jumps=_impacts(predicted, rate, m.mask[:, 0]),
    )


def _impacts(rotation: FloatArray, rate: FloatArray, mask: NDArray[np.bool_]) -> tuple[tuple[int, float, float], ...]:
    """Where the rotation changes sign: (window, sample, rate just before)."""
    found = []
    for w in range(rotation.shape[0]):
        count = int(mask[w].sum())
        signs = np.sign(rotation[w, :count])
        for k in np.flatnonzero(signs[1:] * signs[:-1] < 0.0).tolist():
            share = rotation[w, k] / (rotation[w, k] - rotation[w, k + 1])
            found.append((w, float(k + share), float(rate[w, max(k - 1, 0)])))
    return tuple(found)
