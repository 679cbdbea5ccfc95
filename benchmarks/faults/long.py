"""Five million cells, a worker killed every minute, memory watched: ``make long``.

    python -m benchmarks.faults.long [--cells 5e6] [--minute 60]

The cells are those of a block over aspect ratio, top mass and PGA, on a cluster of two dask workers. At the end random
cells are computed again and compared bit for bit; the memory of the run, its workers and the scheduler is drawn over
time into ``results/bench/long.png``, its numbers into ``long.json``. Exit code 1 if a cell is wrong or memory grows.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

import matplotlib.pyplot as plt
import numpy as np
import psutil

from benchmarks.faults.commands import Command, cluster, run
from benchmarks.faults.row import Row
from benchmarks.faults.studies import NAME, plan_text
from study.store import BlockStore

CELLS_PER_POINT = 30 * 37
"""Of the second axis of the study."""
BLOCK_SECONDS = 2.0
STEADY = 1.25
"""What the memory of the last third of the run may be of that of the second third."""
OUT = Path("results/bench")


def watch(command: Command, found: object, draw: np.random.Generator, minute: float) -> dict[str, list[float]]:
    """Memory in MB of the run and of its largest worker, until the run ends; a worker is killed every ``minute``."""
    seen: dict[str, list[float]] = {"time": [], "run": [], "worker": [], "killed": []}
    begun = killed = time.monotonic()
    while command.running:
        now = time.monotonic()
        seen["time"].append(now - begun)
        seen["run"].append(psutil.Process(command.process.pid).memory_info().rss / 1e6)
        seen["worker"].append(max(psutil.Process(w.pid).memory_info().rss for w in found.workers) / 1e6)
        if now - killed > minute:
            found.kill_worker(int(draw.integers(2)))
            killed = time.monotonic()
            seen["killed"].append(killed - begun)
        time.sleep(1.0)
    return seen


def draw_memory(seen: dict[str, list[float]], path: Path) -> None:
    figure, axes = plt.subplots(figsize=(7, 3.2), layout="constrained")
    axes.plot(seen["time"], seen["run"], label="the run")
    axes.plot(seen["time"], seen["worker"], label="its largest worker")
    for k, moment in enumerate(seen["killed"]):
        axes.axvline(moment, color="0.8", linewidth=0.8, label="" if k else "a worker is killed")
    axes.set(xlabel="time (s)", ylabel="memory (MB)", ylim=(0.0, None))
    axes.legend(frameon=False)
    figure.savefig(path, dpi=150)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cells", type=float, default=5e6)
    parser.add_argument("--minute", type=float, default=60.0, help="s between two kills")
    given = parser.parse_args()
    OUT.mkdir(parents=True, exist_ok=True)
    row, draw = Row("long run"), np.random.default_rng(0)
    with TemporaryDirectory() as work, cluster() as found:
        plan, results = Path(work) / "long.toml", Path(work) / "results"
        plan.write_text(plan_text("housner", round(given.cells / CELLS_PER_POINT), block_seconds=BLOCK_SECONDS))
        begun = time.monotonic()
        command = Command("run", plan, "--results", results, "--scheduler", found.address)
        seen = watch(command, found, draw, given.minute)
        row.finished(*command.end())
        row.seconds = time.monotonic() - begun
        blocks = len(BlockStore(results / NAME).finished())
        row.finished(*run("check", results / NAME, "--cells", "2000", "--seed", "0"))
    thirds = [float(np.median(part)) for part in np.array_split(seen["run"], 3)]
    grows = thirds[2] > STEADY * thirds[1]
    row.notes += [f"memory grows: {thirds} MB"] if grows else []
    draw_memory(seen, OUT / "long.png")
    numbers = {
        "cells": round(given.cells / CELLS_PER_POINT) * CELLS_PER_POINT, "blocks": blocks, "kills": len(seen["killed"]),
        "seconds": round(row.seconds), "memory_of_the_run_by_thirds_MB": thirds,
        "largest_worker_MB": max(seen["worker"]), "notes": row.notes,
    }  # fmt: skip
    (OUT / "long.json").write_text(json.dumps(numbers, indent=1) + "\n")
    print(json.dumps(numbers, indent=1))
    return 0 if row.clean and not grows else 1


if __name__ == "__main__":
    sys.exit(main())
