"""Where a force, an impulse or an error must be added, without a name for it: a scan over kinds, phases and time.

Every kind of force that the model declares, and errors of the channels (constant, in proportion to the signal, to
its rate, to the base motion), in all phases or in one half of a dependence (one side, large rotations), in all
windows or in successive windows of one recording, is a column d of the linearised problem; the states and base
parameters projected out, (d'r)^2/d'd is chi2 with one degree of freedom where nothing is missing. The level that
the largest of them all stays under with probability 1 - LEVEL comes from noise drawn and scanned in the same way,
so the family of tests is wrong as often as said. A part of the motion is preferred to the whole only where the
whole falls far short of it, for the details of any law differ a little from part to part.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from diagnosis.forces.columns import Forces
from diagnosis.forces.constancy import FLAG, SHORTEST_INTERVAL
from models.base import FloatArray
from models.identification import Motion

DRAWS = 200
LEVEL = 0.05
PART = 0.7
"""Share of its statistic, less FLAG, with which a part of the motion must still beat the whole."""
FEWEST = 1e-3
"""Information of a part of the motion over that of the whole under which it is not tried."""


@dataclass(frozen=True)
class Missing:
    """What must be added: ``kind`` of force (empty: an error of the channels), in the phase ``word`` (empty: all).

    ``windows``: the first and last of a run in one recording; None: all. ``statistic`` beyond ``chance``, the level
    of noise.
    """

    kind: str
    word: str
    windows: tuple[int, int] | None
    statistic: float
    chance: float


@dataclass(frozen=True)
class _Column:
    """A column reduced: scores and information (W,) of each window, and its part along the base parameters (W, k)."""

    kind: str
    word: str
    values: FloatArray
    score: FloatArray
    information: FloatArray
    along: FloatArray


def missing(forces: Forces, seed: int = 0) -> Missing | None:
    """The strongest kind, phase and run of windows, or None where nothing is beyond chance."""
    runs = _runs(forces)
    columns = [_reduced(forces, *named) for named in _columns(forces)]
    columns = [c for c in columns if c.information.sum() > 1e-9]
    if not columns:
        return None
    chance = _chance(forces, columns, runs, seed)
    best: tuple[float, Missing] | None = None
    for column in columns:
        for low, high in runs:
            windows = None if (low, high) == runs[0] else (low, high)
            statistic = _statistic(forces, column, low, high, alone=windows is None)
            weighed = statistic
            for _ in range((column.word != "") + (windows is not None)):
                weighed = PART * weighed - FLAG
            if best is None or weighed > best[0]:
                best = weighed, Missing(column.kind, column.word, windows, statistic, chance)
    return best[1] if best is not None and best[1].statistic > chance else None


def _columns(forces: Forces) -> Iterator[tuple[str, str, FloatArray]]:
    """Kind, phase word and whitened column (W, M) of everything that is tried."""
    m = forces.fitted.measured
    for name, motion in forces.motions.items():
        fast = np.abs(motion.rate) / max(float(np.max(np.abs(motion.rate))), 1e-12)
        for word, factor in _phases(forces, motion):
            for kind in (one for one in forces.kinds if one.port.name == name):
                yield kind.name, word, forces.column(kind, factor)
                if kind.along is None:  # jumps that grow with the rate, and in the course of a recording
                    yield kind.name, word, forces.column(kind, factor * fast)
                    yield kind.name, word, forces.column(kind, factor * forces.time)
    for word, factor in _phases(forces, forces.motion):
        for error in _errors(forces):
            column = np.where(m.mask, error * factor[:, None, :], 0.0)
            yield "", word, forces.screen.reduced(forces.fitted.misfit.whitening(column))


def _phases(forces: Forces, motion: Motion) -> Iterator[tuple[str, FloatArray]]:
    """Everywhere (""), then the halves of what a force may depend on, by their words."""
    yield "", np.ones_like(forces.time)
    for dependence in forces.fitted.measured.identification.dependences:
        factor = np.broadcast_to(dependence.factor(motion), forces.time.shape)
        half = factor - 0.5 * float(np.max(factor)) if dependence.about_mean else factor
        ends = ((half < 0.0).astype(float), (half > 0.0).astype(float))
        yield from ((word, end) for word, end in zip(dependence.phases, ends, strict=True) if word)


def _errors(forces: Forces) -> Iterator[FloatArray]:
    """Errors (W, C, N) of the channels: constant, with the signal, its rate, the base motion; in the noise's size."""
    m = forces.fitted.measured
    signal = forces.fitted.misfit.predictor.predict([forces.fitted.point])[0]
    last = np.array([window.samples - 1 for window in m.windows])  # nothing behind it is a prediction
    inside = np.minimum(np.arange(signal.shape[2]), last[:, None])
    signal = np.take_along_axis(signal, inside[:, None, :], axis=2)
    for error in (np.ones_like(signal), signal, np.gradient(signal, axis=2), m.base[:, None, :] + 0.0 * signal):
        size = np.sqrt(np.mean(error**2, axis=(0, 2), where=m.mask))
        yield error / np.maximum(size, 1e-300)[None, :, None] * m.sigma[..., None]


def _reduced(forces: Forces, kind: str, word: str, values: FloatArray) -> _Column:
    screen = forces.screen
    weighted = screen.weights[:, None] * values
    return _Column(
        kind, word, values,
        np.einsum("wm,wm->w", weighted, screen.residual),
        np.einsum("wm,wm->w", weighted, values),
        np.einsum("wmi,wm->wi", screen.by_unknown, weighted, optimize=True),
    )  # fmt: skip


def _runs(forces: Forces) -> list[tuple[int, int]]:
    """First and last window of everything that is tried: all of them, then every run within one recording."""
    records = forces.fitted.measured.recording_of
    found = [(0, records.size - 1)]
    for r in np.unique(records):
        own = np.flatnonzero(records == r).tolist()
        for a in range(len(own)):
            found += [(own[a], own[b]) for b in range(a + SHORTEST_INTERVAL - 1, len(own))]
    return list(dict.fromkeys(found))


def _statistic(forces: Forces, column: _Column, low: int, high: int, alone: bool) -> float:
    """Of a run of windows; unless one may decide ``alone``, without the one that adds most."""
    screen = forces.screen
    inside = slice(low, high + 1)
    score, information, along = column.score[inside], column.information[inside], column.along[inside]
    keep = np.ones(score.size, bool)
    keep[int(np.argmax(score * np.sign(score.sum())))] = alone
    path = along[keep].sum(axis=0)
    free = float(information[keep].sum() - path @ screen.inverse @ path)
    if free < FEWEST * float(column.information.sum()):
        return 0.0
    return float((score[keep].sum() - path @ screen.inverse @ screen.gradient) ** 2 / free)


def _chance(forces: Forces, columns: list[_Column], runs: list[tuple[int, int]], seed: int) -> float:
    """The level under which the largest statistic of noise alone stays with probability 1 - LEVEL."""
    screen = forces.screen
    noise = np.random.default_rng(seed).normal(size=(DRAWS, *screen.residual.shape))
    root = np.sqrt(screen.weights)
    gradient = np.einsum("w,wmi,swm->si", root, screen.by_unknown, noise, optimize=True)
    ends = np.array(runs)
    largest = np.zeros(DRAWS)
    for column in columns:
        each = np.einsum("w,wm,swm->sw", root, column.values, noise, optimize=True)
        score = _sums(each, ends)
        along, information = _sums(column.along.T, ends).T, _sums(column.information[None], ends)[0]
        free = information - np.einsum("ri,ij,rj->r", along, screen.inverse, along)
        usable = free > FEWEST * information[0]
        off = (score - (gradient @ screen.inverse @ along.T))[:, usable]
        if usable.any():
            largest = np.maximum(largest, (off**2 / free[usable]).max(axis=1))
    return float(np.quantile(largest, 1.0 - LEVEL))


def _sums(values: FloatArray, ends: np.ndarray) -> FloatArray:
    """Sums of values (s, W) over runs of windows (r, 2): (s, r)."""
    total = np.pad(np.cumsum(values, axis=1), ((0, 0), (1, 0)))
    return np.asarray(total[:, ends[:, 1] + 1] - total[:, ends[:, 0]])
