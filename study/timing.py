"""How long a study takes, from a timed sample; it chooses the size of blocks, never a result."""

from __future__ import annotations

import time
import tracemalloc
import zlib
from dataclasses import dataclass
from math import ceil

import numpy as np

import models
from grids.alike import taken_once
from grids.plan import Plan
from study.evaluate import evaluate
from study.keys import Setting, motions_by_name

SAMPLE_SECONDS = 0.2
FIRST_SAMPLE = 64
LARGEST_SAMPLE = 4096
GROUPS = 3
BLOCKS_PER_WORKER = 8
SHORTEST_BLOCK = 1.0
"""s: a block's file costs some 20 ms."""


@dataclass(frozen=True)
class Sample:
    """``cells`` computed in ``seconds`` on one core, after compilation took ``compile_seconds``; a cell takes
    ``stored_bytes_per_cell`` in a compressed file."""

    cells: int
    seconds: float
    compile_seconds: float
    stored_bytes_per_cell: float

    @property
    def seconds_per_cell(self) -> float:
        return self.seconds / self.cells


def time_sample(plan: Plan, setting: Setting) -> Sample:
    """Compute random cells of a few motions and option words, twice as many until the time is long enough."""
    grid, motions = plan.grid, motions_by_name(plan)

    outputs: dict[str, np.ndarray] = {}

    def seconds(cells: int) -> float:
        chosen = grid.coordinates(_choose(plan, grid.shape, cells))
        begun = time.perf_counter()
        outputs.update(evaluate(setting, motions, chosen))
        return time.perf_counter() - begun

    first = seconds(cells := FIRST_SAMPLE)
    spent = seconds(cells)
    compile_seconds = max(0.0, first - spent)
    while spent < SAMPLE_SECONDS and cells < min(LARGEST_SAMPLE, grid.size):
        cells *= 2
        spent = seconds(cells)
    stored = sum(len(zlib.compress(np.ascontiguousarray(values).data, 1)) for values in outputs.values())
    return Sample(cells, spent, compile_seconds, stored / cells)


def bytes_per_cell(plan: Plan, setting: Setting, cells: int = 512) -> float:
    """Memory that a task needs for each of its cells, measured on a sample."""
    chosen = plan.grid.coordinates(_choose(plan, plan.grid.shape, cells))
    motions = motions_by_name(plan)
    tracemalloc.start()
    try:
        evaluate(setting, motions, chosen)
        return tracemalloc.get_traced_memory()[1] / cells
    finally:
        tracemalloc.stop()


def output_bytes(setting: Setting) -> int:
    """Bytes of a cell in the cube before compression."""
    declared = {quantity.name: quantity.dtype for quantity in models.get(setting.model).outputs}
    return sum(np.dtype(declared[name]).itemsize for name in setting.outputs)


def _choose(plan: Plan, shape: tuple[int, ...], cells: int) -> np.ndarray:
    """Flat indices of random cells (repeats allowed) that share few values of what a call takes once."""
    random = np.random.default_rng(0)
    groups = random.integers(0, np.maximum(shape, 1), size=(GROUPS, len(shape)))
    index = random.integers(0, np.maximum(shape, 1), size=(cells, len(shape)))
    group = random.integers(0, GROUPS, cells)
    model = models.get(plan.model)
    for k, axis in enumerate(plan.axes):
        if any(taken_once(model, name) for name in axis.sets):
            index[:, k] = groups[group, k]
    if not shape:
        return np.zeros(cells, dtype=np.intp)
    return np.asarray(np.ravel_multi_index(tuple(index.T), shape))


def cells_per_block(plan: Plan, sample: Sample | None, workers: int) -> int:
    """Cells that take about ``block_seconds``; fewer in a short study, so that every worker has some
    blocks and progress shows, but none under a second. Without a sample only the workers count."""
    size = plan.grid.size
    if sample is None:
        return ceil(size / (BLOCKS_PER_WORKER * workers))
    total = sample.seconds_per_cell * size
    blocks = max(total / plan.block_seconds, min(total / SHORTEST_BLOCK, BLOCKS_PER_WORKER * workers), 1.0)
    return ceil(size / blocks)
