"""Restricted likelihood of variance components, and its maximum under theta >= 0.

A piece's residual is r = J b + X x + e, e ~ N(0, C(theta)): x its own states without a prior, b what pieces share.
These are the base parameters, with their priors, and the values of slow drifts at knots, linear in between, with the
covariance D(theta) = sum theta_k D_k. With Q the precision of b about b0,
P = C^-1 - C^-1 X (X' C^-1 X)^-1 X' C^-1 and H = sum J'PJ + Q,

    -2 log L = sum [log|C| + log|X'C^-1 X| + w r'P r] + log|H| + log|D| - g' H^-1 g + const,

g = sum w J'P r + Q (b - b0)
(Patterson and Thompson, Biometrika 58, 1971). The slope along theta_k is tr(P V_k) - w a'V_k a with a = P (r - J d),
the average information a'V_k P V_l a (Gilmour, Thompson and Cullis, Biometrics 51, 1995). Multiplicative steps
theta_k <- theta_k sqrt(w a'V_k a/tr(P V_k)) never fail and end slowly; then Newton steps with the average information,
bounds kept by non-negative least squares. ``w`` are the weights of pieces: those of a t-distribution, so that one wrong
event does not pass for noise.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lapack
from scipy.optimize import nnls

from diagnosis.errors.components import Kernels, Part, Stationary
from models.base import FloatArray

NU = 10.0
NEWTON, HALVINGS = 8, 4
RIDGE = 1e-6
"""Added to the information of every variance, in its own unit: kernels are alike."""
SLACK = 1e-10
"""Of the largest information, added to all: a shape whose effect is off changes nothing."""
CLOSE = 0.1
"""Fall of -2 log L that ends the iteration."""


@dataclass(frozen=True)
class Piece:
    """n samples: residual r (n,), states' derivatives X (n, S), base parameters' J (n, k), known covariance B (n, n).

    ``time`` (n,) in s and ``channel`` (n,) of the samples; ``parts``: what each component does here, None where it does
    not act on this piece alone. ``at_knots`` (n, q): weights of the ``knots`` (q,) of drifts in the samples.
    """

    time: FloatArray
    channel: NDArray[np.int64]

    residual: FloatArray
    by_state: FloatArray
    by_unknown: FloatArray
    known: FloatArray
    parts: tuple[Part | Stationary | None, ...]
    knots: NDArray[np.intp] = field(default_factory=lambda: np.zeros(0, np.intp))
    at_knots: FloatArray | None = None

    @property
    def common(self) -> FloatArray:
        """Derivatives (n, k + q) by the base parameters and the drifts at this piece's knots."""
        return self.by_unknown if self.at_knots is None else np.concatenate([self.by_unknown, self.at_knots], axis=1)

    @cached_property
    def kernels(self) -> tuple[Kernels, ...]:
        """The stationary ones of the parts."""
        return Kernels.among(self.parts)

    @cached_property
    def others(self) -> tuple[tuple[int, Part], ...]:
        """The parts that are not stationary, with the numbers of their components."""
        return tuple((i, p) for i, p in enumerate(self.parts) if p is not None and not isinstance(p, Stationary))

    def holding(self, held: NDArray[np.bool_], value: float) -> Piece:
        """The same with the ``held`` components (K,) no longer unknown: each has the variance ``value``."""
        fixed = np.where(held, value, 0.0)
        parts = tuple(part for part, gone in zip(self.parts, held, strict=True) if not gone)
        return replace(self, known=self.covariance(fixed), parts=parts)

    def covariance(self, theta: FloatArray) -> FloatArray:
        found = self.known.copy()
        for kernels in self.kernels:
            kernels.add_to(found, theta)
        for i, part in self.others:
            if theta[i] > 0.0:
                part.add_to(found, float(theta[i]))
        return found


@dataclass(frozen=True)
class Prior:
    """Precision Q (k, k) and slope Q (b - b0) (k,) of the base parameters at the point of the residuals.

    ``drifts``: by component, the covariance D_k (q, q) of a drift of variance one at all knots, None for others;
    ``largest``: the largest variance of each: what goes further is no error but something to be named.
    """

    precision: FloatArray
    slope: FloatArray
    drifts: tuple[FloatArray | None, ...] = ()
    largest: tuple[float, ...] = ()

    @property
    def count(self) -> int:
        """Of the knots."""
        return max((d.shape[0] for d in self.drifts if d is not None), default=0)

    def most(self, count: int) -> FloatArray:
        """Largest variances (count,)."""
        return np.array(self.largest or [np.inf] * count)

    def root(self, theta: FloatArray) -> FloatArray:
        """R (q, q) with R R' = D(theta)."""
        found = np.zeros((self.count, self.count))
        for drift, value in zip(self.drifts, theta, strict=False):
            if drift is not None:
                found += value * drift
        values, vectors = np.linalg.eigh(found)
        return np.asarray(vectors * np.sqrt(np.maximum(values, 0.0)))

    def without(self, held: NDArray[np.bool_]) -> Prior:
        """The same with some components gone."""
        drifts = tuple(d for d, gone in zip(self.drifts, held, strict=False) if not gone)
        largest = tuple(x for x, gone in zip(self.largest, held, strict=False) if not gone)
        return replace(self, drifts=drifts, largest=largest)


@dataclass(frozen=True)
class Solved:
    """One piece at one theta: P (n, n), P r, P times `Piece.common`, log|C| + log|X'C^-1 X|, log|C|, r'P r."""

    projector: FloatArray
    on_residual: FloatArray
    on_common: FloatArray
    determinants: float
    volume: float
    square: float


@dataclass(frozen=True)
class State:
    """The restricted likelihood at one theta: -2 log L, and its slope and average information (K,), (K, K).

    By piece ``chi2`` of what base parameters and drifts leave, log ``determinants`` and, of them, log ``volumes`` |C|;
    ``price`` of the drifts, |D^-1/2 d|^2 + log|I + D A|; ``estimate`` (k + q,) of base parameters and drifts with its
    ``covariance``.
    """

    deviance: float
    slope: FloatArray
    information: FloatArray
    quadratic: FloatArray
    trace: FloatArray
    chi2: FloatArray
    determinants: FloatArray
    volumes: FloatArray
    price: float
    estimate: FloatArray
    covariance: FloatArray


def solve(piece: Piece, theta: FloatArray) -> Solved:
    """One piece at theta (K,)."""
    factor, failed = lapack.dpotrf(piece.covariance(theta).T, lower=1, clean=1, overwrite_a=1)
    if failed:
        raise np.linalg.LinAlgError("the covariance of a piece is not positive definite")
    diagonal = np.log(np.diagonal(factor)).sum()
    inverse, _ = lapack.dpotri(factor, lower=1, overwrite_c=1)
    inverse = inverse + inverse.T
    inverse.flat[:: inverse.shape[0] + 1] *= 0.5
    x = inverse @ piece.by_state
    gram = piece.by_state.T @ x
    gram += SLACK * np.max(np.diagonal(gram), initial=0.0) * np.eye(gram.shape[0])
    projector = inverse - x @ np.linalg.solve(gram, x.T)
    on_residual = projector @ piece.residual
    volume = 2.0 * float(diagonal)
    return Solved(
        projector,
        on_residual,
        projector @ piece.common,
        volume + float(np.linalg.slogdet(gram)[1]),
        volume,
        float(piece.residual @ on_residual),
    )


def whitened(piece: Piece, theta: FloatArray) -> FloatArray:
    """The residual (n,) in units of its errors, its own states projected out."""
    lower = np.linalg.cholesky(piece.covariance(theta))
    return np.asarray(lower.T @ solve(piece, theta).on_residual)


def evaluate(
    pieces: Sequence[Piece], prior: Prior, theta: FloatArray, weights: FloatArray, slopes: bool = True
) -> State:
    """The restricted likelihood at theta (K,) with weights (pieces,)."""
    solved = [solve(piece, theta) for piece in pieces]
    k, q, n = prior.slope.size, prior.count, theta.size
    where = [np.concatenate([np.arange(k), k + piece.knots]) for piece in pieces]
    data, gradient = np.zeros((k + q, k + q)), np.zeros(k + q)
    for piece, one, w, at in zip(pieces, solved, weights, where, strict=True):
        data[np.ix_(at, at)] += w * piece.common.T @ one.on_common
        gradient[at] += w * piece.common.T @ one.on_residual
    gradient[:k] += prior.slope
    turn = np.eye(k + q)  # to drifts of covariance one
    turn[k:, k:] = prior.root(theta)
    hessian = turn.T @ data @ turn
    hessian[:k, :k] += prior.precision
    hessian[range(k), range(k)] += SLACK * (np.max(np.diagonal(hessian)[:k], initial=0.0) + SLACK)
    hessian[range(k, k + q), range(k, k + q)] += 1.0
    spread = turn @ np.linalg.inv(hessian) @ turn.T
    shift = spread @ gradient
    a = [one.on_residual - one.on_common @ shift[at] for one, at in zip(solved, where, strict=True)]
    chi2 = np.array(
        [(p.residual - p.common @ shift[at]) @ x for p, x, at in zip(pieces, a, where, strict=True)], np.float64
    )
    squares = np.array([one.square for one in solved])
    determinants, volumes = np.array([[one.determinants, one.volume] for one in solved]).T
    logdet = float(np.linalg.slogdet(hessian)[1])
    deviance = float(determinants.sum()) + float(weights @ squares) + float(-gradient @ shift) + logdet
    scaled = np.linalg.solve(hessian, turn.T @ gradient)[k:]
    price = float(scaled @ scaled) + logdet - float(np.linalg.slogdet(hessian[:k, :k])[1])
    quadratic, trace, information = np.zeros(n), np.zeros(n), np.zeros((n, n))
    if slopes:
        drifts = {i: drift for i, drift in enumerate(prior.drifts) if drift is not None}
        slope = gradient[k:] - (data @ shift)[k:]  # sum w Z'a
        left = data[k:, k:] - data[k:] @ spread @ data[:, k:]
        pulled = {i: drift @ slope for i, drift in drifts.items()}
        for i, drift in drifts.items():
            quadratic[i], trace[i] = slope @ pulled[i], float(np.sum(left * drift))
        along = np.zeros((n, k + q))
        for piece, one, w, at, own in zip(pieces, solved, weights, where, a, strict=True):
            turned = np.zeros((own.size, n))
            for kernels in piece.kernels:
                turned[kernels.inside, kernels.of] = kernels.times(own)
            for i, part in piece.others:
                turned[:, i] = part.times(own)
            quadratic += w * (own @ turned)
            if piece.at_knots is not None:
                for i in drifts:
                    turned[:, i] = piece.at_knots @ pulled[i][piece.knots]
            information += w * (turned.T @ one.projector @ turned)
            along[:, at] += w * turned.T @ one.on_common
            left_over = one.projector - w * (one.on_common @ spread[np.ix_(at, at)] @ one.on_common.T)
            for kernels in piece.kernels:
                trace[kernels.of] += kernels.trace(left_over)
            for i, part in piece.others:
                trace[i] += part.trace(left_over)
        information -= along @ spread @ along.T
    return State(
        deviance, trace - quadratic, information, quadratic, trace, chi2, determinants, volumes, price, shift, spread
    )


def climbed(
    pieces: Sequence[Piece], prior: Prior, theta: FloatArray, weights: FloatArray, moving: int, steps: int
) -> tuple[FloatArray, FloatArray]:
    """Variances (K,) and weights (pieces,) after multiplicative steps; the first ``moving`` pieces are weighed anew."""
    count = np.array([piece.residual.size for piece in pieces[:moving]], np.float64)
    weights = weights.copy()
    for _ in range(steps):
        state = evaluate(pieces, prior, theta, weights)
        ratio = np.sqrt(np.maximum(state.quadratic, 0.0) / np.maximum(state.trace, 1e-300))
        theta = np.minimum(theta * np.clip(ratio, 0.05, 20.0), prior.most(theta.size))
        weights[:moving] = robust_weights(state.chi2[:moving], count)
    return theta, weights


def maximise(pieces: Sequence[Piece], prior: Prior, theta: FloatArray, weights: FloatArray) -> tuple[FloatArray, State]:
    """The theta >= 0 of largest restricted likelihood with given weights, and the likelihood there."""
    state = evaluate(pieces, prior, theta, weights)
    for _ in range(NEWTON):
        step = _newton(theta, state)
        moved, ahead = theta, state
        for halving in range(HALVINGS):
            moved = np.minimum(theta + 0.5**halving * step, prior.most(theta.size))
            ahead = evaluate(pieces, prior, moved, weights)
            if ahead.deviance < state.deviance:
                break
        fall = state.deviance - ahead.deviance
        if fall <= 0.0:
            break
        theta, state = moved, ahead
        if fall < CLOSE:
            break
    return theta, state


def _newton(theta: FloatArray, state: State) -> FloatArray:
    """The step to the minimum over theta >= 0 of the quadratic that slope and average information give."""
    unit = 1.0 / np.sqrt(np.maximum(np.diagonal(state.information), 1e-300))
    scaled = state.information * np.outer(unit, unit) + RIDGE * np.eye(unit.size)
    root = np.linalg.cholesky(scaled)
    aim = scaled @ (theta / unit) - unit * state.slope
    found, _ = nnls(root.T, np.linalg.solve(root, aim))
    return np.asarray(unit * found - theta)


def by_piece(state: State, pieces: Sequence[Piece], moving: int) -> FloatArray:
    """-2 log L by piece (pieces,), states and base parameters at their estimate, by which models are compared.

    With the t-distribution that the weights of the ``moving`` windows belong to, and without log|X'C^-1 X|: that
    depends on how many states a model has, on their units, and on how much of them the recordings show. By it a
    low-pass, behind which the states that a window starts from show less, is likelier than the delay that there is.
    """
    count = np.array([piece.residual.size for piece in pieces], np.float64)
    windows = (NU + 1.0) * count * np.log1p(state.chi2 / (NU * count))
    return np.asarray(state.volumes + np.where(np.arange(count.size) < moving, windows, state.chi2), np.float64)


def robust_weights(chi2: FloatArray, count: FloatArray) -> FloatArray:
    """Weights (pieces,) of a t-distribution with NU n degrees of freedom, at most 1."""
    return np.minimum(1.0, (1.0 + 1.0 / NU) / (1.0 + chi2 / (NU * np.maximum(count, 1.0))))
