"""The loss of a parameter point, and its derivatives with the windows' states eliminated.

    loss = sum_w nu n_w log(1 + chi2_w/(nu n_w)) + sum_i ((x_i - mean_i)/sd_i)^2 + |z|^2,   nu = 10

chi2_w is the squared whitened residual of window w, n_w its number of samples, the second sum runs over the priors,
among which is what the records of the base tell of their zeros (`grids.recordings.zero`), z is the level of the errors
that windows share (`diagnosis.fit.whitening`). One wrong event must not decide: a window far
off counts with its logarithm. The states of a window appear in its own residuals only; projecting these off the states'
derivatives (Schur complement) leaves a least-squares problem in the shared parameters alone.
"""

from __future__ import annotations

from collections.abc import Generator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from diagnosis.data.measured import Measured
from diagnosis.fit.prediction import Point, Predictor
from diagnosis.fit.unknowns import Unknown, values_of
from diagnosis.fit.whitening import Whitening
from grids.instruments.accelerometer_offset import MECHANISM as ZERO
from models.base import FloatArray
from models.errors import InputError

NU = 10.0
STEP = 0.05
"""Difference step of a coordinate."""
STATE_STEP = 2e-3
"""Difference step of a state over its scatter among the windows."""
ZERO_READING = f"{ZERO.name}.{ZERO.parameters[0].name}"

Found = TypeVar("Found")
Asking = Generator[Sequence[Point], FloatArray, Found]
"""What asks for predictions (P, W, C, N) of points, time and again, and ends with what it finds."""


@dataclass(frozen=True)
class Linear:
    """A point's residuals (W, M) and derivatives (W, M, k), (W, M, S) by differences.

    The errors that windows share come after the unknowns among the k.
    """

    residual: FloatArray
    by_unknown: FloatArray
    by_state: FloatArray


@dataclass(frozen=True)
class Reduced:
    """The same, projected off the states."""

    residual: FloatArray
    by_unknown: FloatArray
    basis: FloatArray
    """Orthonormal (W, M, S) directions that the states can reach."""

    def at(self, residual: FloatArray) -> Reduced:
        """Where the residual is another and the derivatives are the same."""
        return replace(self, residual=project(self.basis, residual[..., None])[..., 0])


@dataclass(frozen=True)
class Misfit:
    """The loss over ``unknowns`` with everything else at ``fixed``."""

    predictor: Predictor
    whitening: Whitening
    unknowns: tuple[Unknown, ...]
    fixed: Mapping[str, float]
    smooth: FloatArray | None = None
    """Rows (p, k) of a prior smooth u ~ N(0, 1) on the coordinates, such as the bends of a curve."""

    @property
    def measured(self) -> Measured:
        return self.predictor.measured

    def point(self, u: FloatArray, states: FloatArray) -> Point:
        values = {**self.fixed, **values_of(self.unknowns, u)}
        return Point(values, states, self.predictor.coordinates, self.predictor.rung)

    def residuals(self, points: Sequence[Point], only: NDArray[np.bool_] | None = None) -> FloatArray:
        """Whitened residuals (P, W, M), predicted minus measured, at the level of the shared errors.

        Meaningless but in windows ``only``.
        """
        return self.whitened(self.predictor.predict(points, only=only))

    def whitened(self, predicted: FloatArray) -> FloatArray:
        """Residuals (P, W, M) of predictions (P, W, C, N)."""
        difference = predicted - self.measured.values
        known = np.isfinite(difference)
        if not known.all():
            difference[~known] = 1e3
        found = self.whitening(difference)
        shared = self.whitening.shared
        return found if shared is None else found + shared @ self.level

    @property
    def level(self) -> FloatArray:
        """Of the errors that windows share (S,), in their standard deviations."""
        return np.zeros(0) if self.whitening.level is None else self.whitening.level

    @property
    def undisturbed(self) -> Misfit:
        """The same with events taken to be as the law has them."""
        return replace(self, predictor=replace(self.predictor, measured=self.measured.undisturbed))

    def of_windows(self, windows: NDArray[np.intp]) -> Misfit:
        """The loss of some of the windows alone; one may be among them more than once."""
        predictor = replace(self.predictor, measured=self.measured.of_windows(windows))
        return replace(self, predictor=predictor, whitening=self.whitening.of_windows(windows))

    def at_level(self, level: FloatArray) -> Misfit:
        return replace(self, whitening=replace(self.whitening, level=level)) if level.size else self

    def losses(self, residuals: FloatArray) -> FloatArray:
        """Loss of every window (..., W), without the priors."""
        n = self.measured.count
        return np.asarray(NU * n * np.log1p(np.sum(residuals**2, axis=-1) / (NU * n)))

    @property
    def of_noise(self) -> float:
        """Loss of all windows if the misfit is that of noise."""
        return float(NU * np.log1p(1.0 / NU) * np.sum(self.measured.count))

    def prior(self, u: FloatArray) -> float:
        """Of the unknowns and of the errors that windows share."""
        return self.prior_of_unknowns(u) + float(self.level @ self.level)

    def prior_of_unknowns(self, u: FloatArray) -> float:
        """Of the unknowns alone: the likelihood of the errors has a price for those that windows share."""
        r, _ = self.prior_rows(u)
        return float(r @ r)

    def prior_normal(self, u: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Precision (k, k) and gradient (k,) of half the priors, those of the shared errors last."""
        rows, slopes = self.prior_rows(u)
        own = len(self.unknowns)
        k = own + self.level.size
        precision, gradient = np.eye(k), np.concatenate([slopes.T @ rows, self.level])
        precision[:own, :own] = slopes.T @ slopes
        return precision, gradient

    def prior_rows(self, u: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Residual (p,) and derivative (p, k) of the unknowns' priors."""
        rows, slopes = [], []
        for i, unknown in enumerate(self.unknowns):
            if unknown.prior is not None:
                mean, sd = unknown.prior
                rows.append((unknown.value(float(u[i])) - mean) / sd)
                slope = np.zeros(len(self.unknowns))
                slope[i] = unknown.scale / sd
                slopes.append(slope)
        found = [(np.array(rows), np.array(slopes).reshape(len(rows), len(self.unknowns))), self._zero_rows(u)]
        if self.smooth is not None:
            found.append((self.smooth @ u, self.smooth))
        residuals, derivatives = zip(*found, strict=True)
        return np.concatenate(residuals), np.concatenate(derivatives)

    def _zero_rows(self, u: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The same of the records of the base, one a recording: what their accelerometer reads at rest."""
        acting = self.predictor.shares(ZERO.name)
        values = {**self.fixed, **values_of(self.unknowns, u)}
        residual, slope = self.measured.zeros.rows(values.get(ZERO_READING, 0.0) * acting)
        scales = [x.scale if x.name == ZERO_READING else 0.0 for x in self.unknowns]
        return residual, np.outer(slope * acting, scales)

    def loss(self, u: FloatArray, states: FloatArray) -> float:
        return float(self.losses(self.residuals([self.point(u, states)])).sum()) + self.prior(u)

    def linearise(self, u: FloatArray, states: FloatArray) -> Linear:
        """Residuals and derivatives at a point."""
        return answered(self.linearising(u, states), self.predictor)

    def linearising(self, u: FloatArray, states: FloatArray, one_sided: bool = False) -> Asking[Linear]:
        """The same, which asks for its predictions; ``one_sided`` by unknowns for the steps of a fit."""
        here = self.point(u, states)
        ends, widths = [], []
        for i, unknown in enumerate(self.unknowns):
            low, high = unknown.bounds
            down, up = u.copy(), u.copy()
            up[i] = min(u[i] + STEP, high)
            down[i] = u[i] if one_sided and up[i] > u[i] else max(u[i] - STEP, low)
            ends.append([here if x[i] == u[i] else self.point(x, states) for x in (down, up)])
            widths.append(up[i] - down[i])
        for s, size in enumerate(STATE_STEP * self.measured.state_size):
            down, up = states.copy(), states.copy()
            down[:, s] -= size
            up[:, s] += size
            ends.append([self.point(u, down), self.point(u, up)])
            widths.append(2.0 * size)
        moved = [point for pair in ends for point in pair if point is not here]
        predicted = yield [here, *moved]
        r = dict(zip(map(id, [here, *moved]), self.whitened(predicted), strict=True))
        differences = [(r[id(up)] - r[id(down)]) / width for (down, up), width in zip(ends, widths, strict=True)]
        residual = r[id(here)]
        columns = np.stack(differences, axis=-1) if differences else np.empty((*residual.shape, 0))
        k = len(self.unknowns)
        by_unknown = columns[..., :k]
        if self.whitening.shared is not None:
            by_unknown = np.concatenate([by_unknown, self.whitening.shared], axis=-1)
        return Linear(residual, by_unknown, columns[..., k:])

    def weights(self, residual: FloatArray) -> FloatArray:
        """Weight of each window (W,) in the least squares that has the loss's gradient."""
        n = self.measured.count
        return np.asarray(1.0 / (1.0 + np.sum(residual**2, axis=-1) / (NU * n)))


def answered(asking: Asking[Found], predictor: Predictor) -> Found:
    """What it finds, its predictions run as it asks for them; it is told where the model refuses its parameters."""
    try:
        points = next(asking)
        while True:
            try:
                predicted = predictor.predict(points)
            except InputError as refusal:
                points = asking.throw(refusal)
            else:
                points = asking.send(predicted)
    except StopIteration as end:
        found: Found = end.value
        return found


def reduce(linear: Linear) -> Reduced:
    """Project residuals and derivatives off the states, window by window."""
    if not linear.by_state.shape[-1]:
        return Reduced(linear.residual, linear.by_unknown, linear.by_state)
    q = np.linalg.qr(linear.by_state)[0]
    return Reduced(linear.residual, project(q, linear.by_unknown), q).at(linear.residual)


def project(basis: FloatArray, columns: FloatArray) -> FloatArray:
    """Columns (W, M, k) without their part along ``basis`` (W, M, S)."""
    return columns - basis @ (np.swapaxes(basis, 1, 2) @ columns)
