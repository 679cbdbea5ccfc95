"""Which cells of a grid to compute so that the borders between outcomes are found: asked and told, never run.

The grid is cut into boxes that share their corners. A box whose computed cells differ is cut in two along every axis,
down to the cells themselves; one whose cells agree is closed, and the cells inside are inferred to be like them. A
computed cell that differs from a closed box it touches opens that box again, so a border is followed wherever it leads.
Outcomes need not be monotone along any axis: guard samples, cells drawn at random among the inferred ones, are computed
until one of them finds nothing, and what they find opens its box. A last sample, the audit, opens nothing; from it
alone the share of wrong cells is estimated, so that its interval is that of a plain binomial.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree
from scipy.stats import beta

Cells = NDArray[np.int64]
Labels = NDArray[np.int8]

NOT_COMPUTED = -1
ABSENT, PENDING, CLOSED, SPLIT = range(4)
AT_ONCE = 1 << 20
"""Cells of boxes that are looked at together."""


@dataclass(frozen=True)
class Estimate:
    """Share of all cells that are inferred wrongly, with Clopper and Pearson's interval, from an audit."""

    computed_share: float
    wrong_share: float
    low: float
    high: float
    wrong: int
    audited: int
    complete: bool
    """Whether every border was followed to its end; False where the budget ran out first."""


class Refinement:
    """The policy: while `ask` gives cells (flat indices), compute their outcomes (labels from 0 on) and `tell` them."""

    def __init__(
        self, shape: Sequence[int], *, budget: float = 0.1, guard: int = 1000, seed: int = 1, confidence: float = 0.95
    ) -> None:
        """``budget``: largest share of cells to compute (of at least one box and a cell), the audit included;
        ``guard``: cells of a guard sample and of the audit, never more than a tenth of the budget.
        """
        self.shape = tuple(int(n) for n in shape)
        self.size = math.prod(self.shape)
        self.values: Labels = np.full(self.size, NOT_COMPUTED, dtype=np.int8)
        self.confidence = confidence
        self._most = min(max(int(budget * self.size), 2 ** len(self.shape) + 1), self.size)
        self._sample = min(guard, self._most // 10)
        self._random = np.random.default_rng(seed)
        coarse = _coarse(self.shape, self._most)
        self._strides = [coarse >> k for k in range(coarse.bit_length())]
        self._state = [np.full(self._boxes(s), ABSENT, dtype=np.int8) for s in self._strides]
        self._label = [np.zeros(self._boxes(s), dtype=np.int8) for s in self._strides]
        self._state[0][...] = PENDING
        self._phase = "refine"
        self._complete = True
        self._estimate: Estimate | None = None
        self._expected: Labels = np.empty(0, dtype=np.int8)
        self._told: Cells = np.empty(0, dtype=np.int64)

    def ask(self) -> Cells:
        """The cells to compute next, in ascending order; none when all is done."""
        while self._phase == "refine":
            self._settle()
            wanted = self._missing_corners()
            room = self._most - self._sample - self.computed
            if wanted.size > room:
                self._complete = False
                wanted = np.sort(self._random.choice(wanted, max(room, 0), replace=False))
                self._phase = "audit"
            if wanted.size:
                return wanted
            if self._phase == "audit" or self.computed + 2 * self._sample > self._most:
                self._phase = "audit"
                break
            self._phase = "guard"
            return self._drawn()
        if self._phase == "audit":
            self._settle()
            self._phase = "audited"
            return self._drawn()
        return np.empty(0, dtype=np.int64)

    def tell(self, cells: Cells, labels: Labels) -> None:
        """The outcomes of the cells that were asked for."""
        self.values[cells] = labels
        self._told = np.concatenate([self._told, cells])
        if self._phase == "guard":
            found = int(np.count_nonzero(labels != self._expected))
            self._phase = "refine" if found else "audit"
        elif self._phase == "audited":
            self._conclude(int(np.count_nonzero(labels != self._expected)), cells.size)

    @property
    def computed(self) -> int:
        """How many cells are computed."""
        return int(np.count_nonzero(self.values != NOT_COMPUTED))

    @property
    def estimate(self) -> Estimate:
        """After the last `tell`."""
        if self._estimate is None:
            raise RuntimeError("the refinement is not finished: ask and tell until nothing is asked")
        return self._estimate

    def labels(self) -> Labels:
        """The outcome of every cell ``(size,)``: computed where it is, else inferred from its closed box; where the
        budget ran out before the box was judged, from the nearest computed cell, in steps of the grid.
        """
        found: Labels = np.full(self.shape, NOT_COMPUTED, dtype=np.int8)
        for stride, state, label in zip(self._strides, self._state, self._label, strict=True):
            pairs = zip(self.shape, state.shape, strict=True)
            where = np.ix_(*(np.minimum(np.arange(n) // stride, k - 1) for n, k in pairs))
            found = np.where(state[where] == CLOSED, label[where], found)
        flat = np.where(self.values == NOT_COMPUTED, found.ravel(), self.values)
        undecided, known = np.flatnonzero(flat == NOT_COMPUTED), np.flatnonzero(self.values != NOT_COMPUTED)
        if undecided.size:
            nearest = cKDTree(self._places(known)).query(self._places(undecided))[1]
            flat[undecided] = self.values[known[nearest]]
        return flat

    def _places(self, cells: Cells) -> Cells:
        return np.stack(np.unravel_index(cells, self.shape), axis=-1)

    def _drawn(self) -> Cells:
        """A sample of the inferred cells, and what they are expected to be."""
        inferred = np.flatnonzero(self.values == NOT_COMPUTED)
        cells: Cells = np.sort(self._random.choice(inferred, min(self._sample, inferred.size), replace=False))
        self._expected = self.labels()[cells]
        if not cells.size:
            self._conclude(0, 0)
        return cells

    def _conclude(self, wrong: int, audited: int) -> None:
        left = 1.0 - self.computed / self.size
        tail = (1.0 - self.confidence) / 2
        low = float(beta.ppf(tail, wrong, audited - wrong + 1)) if wrong else 0.0
        high = float(beta.ppf(1.0 - tail, wrong + 1, audited - wrong)) if audited > wrong else 1.0
        rate = wrong / audited if audited else 0.0
        share = self.computed / self.size
        self._estimate = Estimate(share, left * rate, left * low, left * high, wrong, audited, self._complete)
        self._phase = "done"

    def _boxes(self, stride: int) -> tuple[int, ...]:
        return tuple(max(-(-(n - 1) // stride), 1) for n in self.shape)

    def _corners(self, boxes: Cells, stride: int) -> Cells:
        """Flat indices ``(m, 2^d)`` of the corners of boxes ``(m, d)``."""
        last = np.array(self.shape) - 1
        offsets = np.array(list(product((0, 1), repeat=len(self.shape))))
        places = np.minimum((boxes[:, None, :] + offsets) * stride, last)
        return np.asarray(np.ravel_multi_index(tuple(np.moveaxis(places, -1, 0)), self.shape), dtype=np.int64)

    def _missing_corners(self) -> Cells:
        parts = []
        for stride, state in zip(self._strides, self._state, strict=True):
            corners = self._corners(np.argwhere(state == PENDING), stride).ravel()
            parts.append(corners[self.values[corners] == NOT_COMPUTED])
        return np.unique(np.concatenate(parts))

    def _settle(self) -> None:
        """Close or cut every pending box whose corners are known, open closed ones that a computed cell contradicts.

        Only cells told since the last time are held against boxes closed before, and all cells against new ones.
        """
        levels, changed = range(len(self._strides)), True
        while changed:
            judged, closed = zip(*(self._judge(level) for level in levels), strict=True)
            told = [self._holding(level, self._told) for level in levels]
            opened = [self._reopened(level, np.concatenate([told[level], closed[level]])) for level in levels]
            self._told, changed = self._told[:0], any(judged) or any(opened)

    def _judge(self, level: int) -> tuple[bool, Cells]:
        """Whether pending boxes could be judged, and those (m, d) that were closed."""
        state, label, stride = self._state[level], self._label[level], self._strides[level]
        boxes = np.argwhere(state == PENDING)
        values = self.values[self._corners(boxes, stride)]
        known = (values != NOT_COMPUTED).all(axis=1)
        boxes, values = boxes[known], values[known]
        label[tuple(boxes.T)] = values[:, 0]
        agree = (values == values[:, :1]).all(axis=1)
        state[tuple(boxes[agree].T)] = CLOSED
        self._cut(level, boxes[~agree])
        return bool(boxes.size), boxes[agree]

    def _cut(self, level: int, boxes: Cells) -> None:
        self._state[level][tuple(boxes.T)] = SPLIT
        if level + 1 == len(self._strides):
            return
        finer = self._state[level + 1]
        for offset in product((0, 1), repeat=len(self.shape)):
            children = 2 * boxes + np.array(offset)
            children = children[(children < np.array(finer.shape)).all(axis=1)]
            finer[tuple(children.T)] = PENDING

    def _reopened(self, level: int, boxes: Cells) -> bool:
        """Cut those of the boxes (m, d) that are closed and hold a cell of another outcome, their faces included."""
        state, label, stride = self._state[level], self._label[level], self._strides[level]
        boxes = np.unique(boxes[state[tuple(boxes.T)] == CLOSED], axis=0)
        offsets, last = np.array(list(product(range(stride + 1), repeat=len(self.shape)))), np.array(self.shape) - 1
        differs = np.zeros(len(boxes), bool)
        for part in range(0, len(boxes), max(AT_ONCE // len(offsets), 1)):
            some = boxes[part : part + max(AT_ONCE // len(offsets), 1)]
            places = np.minimum(some[:, None, :] * stride + offsets, last)
            values = self.values[np.ravel_multi_index(tuple(np.moveaxis(places, -1, 0)), self.shape)]
            other = (values != NOT_COMPUTED) & (values != label[tuple(some.T)][:, None])
            differs[part : part + len(some)] = other.any(axis=1)
        self._cut(level, boxes[differs])
        return bool(differs.any())

    def _holding(self, level: int, cells: Cells) -> Cells:
        """The boxes ``(m, d)`` of a level that hold cells, on their faces too."""
        stride, count = self._strides[level], np.array(self._state[level].shape)
        places = self._places(cells)
        found = []
        for offset in product((0, 1), repeat=len(self.shape)):
            back = np.array(offset)
            boxes = places // stride - back
            inside = ((boxes >= 0) & (boxes < count) & ((back == 0) | (places % stride == 0))).all(axis=1)
            found.append(boxes[inside])
        return np.concatenate(found)


def _coarse(shape: Sequence[int], most: int) -> int:
    """The first boxes' edge, a power of two: about the root of the longest axis, larger where the corners of all boxes
    would take more than a quarter of the cells that may be computed."""
    edge: int = 2 ** max(int(math.log2(max(shape)) / 2), 0)
    while edge < max(shape) and math.prod(-(-(n - 1) // edge) + 1 for n in shape) > most / 4:
        edge *= 2
    return edge
