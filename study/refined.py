"""A study of which only the borders of onset and overturning are computed, the other cells inferred.

The policy (`grids.refinement`) asks for cells; they are computed in blocks like those of any study, kept under keys of
all that their numbers depend on, so that a run that was killed asks the same and finds what is finished.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from grids.axes import Axis
from grids.grid import Rectangle
from grids.plan import Plan
from grids.refinement import Estimate, Refinement
from models.base import Quantity
from study.keys import Setting, block_key
from study.status import FAILED, OVERTURNED, REST, ROCKING
from study.store import BlockStore, write_text
from study.task import Task, make_task
from study.workers import Needs

CELL = "cell"
"""Name of the axis of a block of scattered cells: their flat indices in the grid."""
COMPUTED = Quantity(
    "computed",
    "",
    "1",
    "whether the cell was computed or inferred",
    "inferred cells lie among computed ones of one outcome: they hold status and overturned alone",
    dtype="bool",
)


@dataclass(frozen=True)
class Refined:
    """Outputs ``(n,)`` of the computed ``cells`` ``(n,)``, the status of every cell ``(size,)``, and how many may be
    wrong.
    """

    cells: NDArray[np.int64]
    outputs: dict[str, NDArray[Any]]
    status: NDArray[np.int8]
    estimate: Estimate

    def __str__(self) -> str:
        e = self.estimate
        ending = "" if e.complete else "; the budget ran out before every border was followed: raise [refine] budget"
        return (
            f"refined: {e.computed_share:.2%} of the cells computed, {e.wrong_share:.3%} of all inferred wrongly "
            f"(95 % interval {e.low:.3%} to {e.high:.3%}; {e.wrong} of {e.audited} audited){ending}"
        )

    def values(self, quantity: Quantity, missing: Any, dtype: np.dtype[Any]) -> NDArray[Any]:
        """An output over all cells ``(size,)``: inferred ones have a status, and whether they overturned."""
        if quantity.name == "status":
            return self.status
        found = np.full(self.status.size, missing, dtype)
        if quantity.name == COMPUTED.name:
            found[:] = 0
            found[self.cells] = 1
            return found
        if quantity.name == "overturned":
            found[np.isin(self.status, (REST, ROCKING, OVERTURNED))] = 0
            found[self.status == OVERTURNED] = 1
        own = self.outputs[quantity.name]  # nan in blocks that failed
        found[self.cells] = np.where(np.isnan(own), missing, own)
        return found

    def record(self) -> dict[str, Any]:
        """What the cube keeps of the estimate."""
        return asdict(self.estimate)


def cells_of_a_block(folder: Path, measured: Callable[[], int]) -> int:
    """The size of blocks, fixed at the first start so that a run that goes on asks for the same blocks."""
    path = folder / "refinement.json"
    with suppress(OSError, ValueError, KeyError, TypeError):  # missing, or damaged: other sizes only compute anew
        kept = int(json.loads(path.read_text("utf-8"))["cells_per_block"])
        if kept > 0:
            return kept
    size = measured()
    write_text(path, json.dumps({"cells_per_block": size}) + "\n")
    return size


def refine(
    plan: Plan,
    setting: Setting,
    store: BlockStore,
    needs: Needs,
    most_cells: int,
    compute: Callable[[list[Task]], None],
) -> Refined:
    """Ask, compute what is not on the disk yet, and tell, until the policy asks no more."""
    if plan.refine is None:
        raise TypeError("the plan has no [refine]")
    policy = Refinement(plan.grid.shape, budget=plan.refine.budget, guard=plan.refine.guard, seed=plan.refine.seed)
    parts: list[tuple[NDArray[np.int64], dict[str, NDArray[Any]]]] = []
    while (asked := policy.ask()).size:
        tasks = list(_tasks(plan, setting, needs, asked, most_cells))
        compute(tasks)
        told = [(np.asarray(task.axes[0].values), _outcome(task, store, setting)) for task in tasks]
        parts += told
        cells = np.concatenate([flat for flat, _ in told])
        policy.tell(cells, np.concatenate([outputs["status"] for _, outputs in told]).astype(np.int8))
    names = (name for name in setting.outputs if name != "status")
    outputs = {name: np.concatenate([part[name] for _, part in parts]) for name in names}
    return Refined(np.concatenate([cells for cells, _ in parts]), outputs, policy.labels(), policy.estimate)


def _tasks(plan: Plan, setting: Setting, needs: Needs, cells: NDArray[np.int64], most_cells: int) -> Iterator[Task]:
    for part in np.array_split(cells, -(-cells.size // most_cells)):
        scattered = replace(plan, axes=(Axis(CELL, part, "1", "cell of the grid", plan.grid.coordinates(part)),))
        block = Rectangle({CELL: tuple(part.tolist())})
        yield make_task(scattered, setting, needs, block_key(scattered, setting, block), block)


def _outcome(task: Task, store: BlockStore, setting: Setting) -> dict[str, NDArray[Any]]:
    """The outputs of a block; those of a failed one hold no numbers."""
    if store.is_intact(task.key):
        return store.read(task.key)[1]
    size = task.axes[0].size
    nothing = {name: np.full(size, np.nan) for name in setting.outputs}
    return nothing | {"status": np.full(size, FAILED, dtype=np.int8)}
