"""One block as a task: all that a worker on another machine needs, and what it sends back."""

from __future__ import annotations

import time
import traceback
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from grids.axes import Axis
from grids.grid import Grid, Rectangle
from grids.motions import Motion
from grids.plan import Plan
from grids.targets import MOTION
from study.evaluate import evaluate
from study.keys import Setting, motions_by_name
from study.store import BlockStore
from study.workers import Needs


@dataclass(frozen=True)
class Task:
    """A block to compute: its own axes and the motions it uses; ``needs`` say where its file goes."""

    needs: Needs
    key: str
    setting: Setting
    axes: tuple[Axis, ...]
    motions: Mapping[str, Motion]

    @property
    def grid(self) -> Grid:
        return Grid(self.axes)


@dataclass(frozen=True)
class Outcome:
    """What a task returns: small, for the data lie in the block's file. ``storing`` is the share of
    ``seconds`` spent on the file."""

    key: str
    cells: int
    seconds: float
    storing: float
    failure: str | None = None


def run_task(task: Task) -> Outcome:
    """Compute and store one block; an exception becomes ``failed/<key>.txt`` and a failed outcome.

    Raises UnfitWorker, and OSError for what the disk refuses: no later block would fare better.
    """
    task.needs.check()
    started = time.perf_counter()
    store, grid = BlockStore(task.needs.folder), task.grid
    try:
        results = evaluate(task.setting, task.motions, grid.coordinates(np.arange(grid.size)))
        computed = time.perf_counter()
        store.write(
            task.key,
            {axis.name: axis.values for axis in task.axes},
            {name: column.reshape(grid.shape) for name, column in results.items()},
            {"seconds": computed - started},
        )
    except OSError:
        raise
    except Exception as error:
        store.fail(task.key, traceback.format_exc())
        sentence = f"{type(error).__name__}: {error}"
        return Outcome(task.key, grid.size, time.perf_counter() - started, 0.0, sentence)
    ended = time.perf_counter()
    return Outcome(task.key, grid.size, ended - started, ended - computed)


def take(axis: Axis, positions: NDArray[np.int64]) -> Axis:
    """The axis with some of its points only."""
    points = None if axis.points is None else {k: v[positions] for k, v in axis.points.items()}
    return replace(axis, values=axis.values[positions], points=points)


def make_task(plan: Plan, setting: Setting, needs: Needs, key: str, block: Rectangle) -> Task:
    """The task that computes a block of the plan's grid, with the motions it uses and no others."""
    where = zip(plan.axes, plan.grid.positions(block), strict=True)
    axes = tuple(take(axis, positions) for axis, positions in where)
    motions = motions_by_name(plan)
    used = next((axis.sets[MOTION].tolist() for axis in axes if MOTION in axis.sets), motions)
    return Task(needs, key, setting, axes, {name: motions[name] for name in used})
