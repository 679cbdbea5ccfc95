"""A cube that shall not pass through memory, made, read and exported in a process of its own (test_large_cube.py).

    python -m tests.study.large_cube FOLDER POINTS

Prints as JSON the bytes of its outputs and by how much every step raised the peak of the memory.
"""

from __future__ import annotations

import json
import resource
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np

from grids.plan import Plan
from study.cube import write_cube
from study.export import export
from study.keys import Setting
from study.manifest import Manifest
from study.open import open_study
from study.store import BlockStore
from study.tally import tally
from study.timing import output_bytes
from tests.study.plans import small_plan

MOST_CELLS = 200_000
"""Cells of a block."""


def made_up(plan: Plan, setting: Setting, folder: Path) -> Manifest:
    """Finished blocks with numbers that nobody computed: rocking, and rising with the position in the block."""
    manifest, store = Manifest.start(plan, MOST_CELLS, ""), BlockStore(folder)
    manifest.save(folder)
    for key, block in manifest.blocks.items():
        shape = [len(values) for values in block.coordinates.values()]
        numbers = np.arange(block.size, dtype=float).reshape(shape)
        kinds = {"status": np.int8, "overturned": np.int8, "impacts": np.int32}
        outputs = {name: numbers.astype(kinds.get(name, np.float64)) for name in setting.outputs}
        outputs["status"] = np.full(shape, 2, np.int8)
        store.write(key, {name: np.asarray(v) for name, v in block.coordinates.items()}, outputs, {})
    return manifest


def peak() -> int:
    """Bytes of memory that this process has held at most."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024


def main(folder: Path, points: int) -> None:
    plan = small_plan(aspect=f"linspace = [0.1, 0.4, {points}]", pga="linspace = [0.1, 0.8, 2000], unit = 'g'")
    setting, folder = Setting.of(plan), folder / plan.name
    folder.mkdir(parents=True)
    grown: dict[str, float] = {}

    def step(name: str, do: Callable[[], object]) -> None:
        before = peak()
        do()
        grown[name] = peak() - before

    manifest = made_up(plan, setting, folder)
    store = BlockStore(folder)
    step("assembled", lambda: write_cube(plan, setting, manifest, store, started="", scheduler="threads"))
    step("counted", lambda: tally(folder / "cube.nc"))
    cube = open_study(folder, lazy=True)
    at = {"aspect_ratio": float(cube["aspect_ratio"][0])}
    step("mapped", lambda: cube.rocking.overturning_map(x="top_mass", y="pga", **at))
    step("exported", lambda: export(cube, folder / "part.nc"))
    print(json.dumps({"cells": plan.grid.size, "bytes": output_bytes(setting) * plan.grid.size, "grown": grown}))


if __name__ == "__main__":
    main(Path(sys.argv[1]), int(sys.argv[2]))
