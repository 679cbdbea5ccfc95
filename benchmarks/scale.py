"""How a study scales: time, bytes and memory over the number of cells, workers that are killed, borders only.

    make bench-scale
    python -m benchmarks.scale [--model housner] [--cells 1e4 1e5 1e6 1e7] [--only sizes kills refinement]

Every size runs in a process of its own (peak memory), its kernels loaded before. The model of the cost,

    seconds = a + N (s/r + c)/n,

has the steps of a cell s and the rate of the kernels r (lane-steps a second and core) as the size before the largest
counts them, on n cores; what lies outside the kernels, c a cell, and the start a come from the two sizes before the
largest, of which it foretells the time. Writes ``results/bench/scale.json``, where sizes measured before are kept.
"""

from __future__ import annotations

import argparse
import importlib
import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks import refinement
from benchmarks.faults.commands import Command, cluster
from benchmarks.faults.row import Row
from benchmarks.faults.studies import compare_cubes
from grids.plan import Plan, parse_plan
from study.evaluate import evaluate
from study.keys import Setting, motions_by_name
from study.run import run

OUT = Path("results/bench/scale.json")
BASE = Path(__file__).parent.parent / "studies" / "rubber_interface.toml"
WORKERS = 2
KILL_SECONDS = 5.0
PARTS = ("sizes", "kills", "refinement")
BORDERS = 256
"""Values of an axis of the map of which only the borders are computed."""
AXES = {
    "housner": {
        1_000: (5, 4, 50), 10_000: (10, 10, 100), 100_000: (20, 25, 200), 1_000_000: (50, 50, 400),
        10_000_000: (100, 100, 1000),
    },
    "interface": {
        10_000: (10, 4, 10, 5, 5), 100_000: (10, 5, 20, 5, 20), 1_000_000: (20, 10, 25, 10, 20),
    },
}  # fmt: skip
"""Points of the axes of every size: aspect ratio, height, PGA; aspect ratio, top mass, modulus, damping, PGA."""
BLOCKS = """aspect_ratio = {{ linspace = [0.1, 0.4, {0}] }}
height = {{ linspace = [1, 4, {1}], unit = "m" }}
pga = {{ geomspace = [0.1, 1.0, {2}], unit = "g" }}
"""
OUTPUTS = ["peak_rotation", "uplift_duration", "overturned", "onset_time"]
WALLS = """[axes]
aspect_ratio = {{ linspace = [0.3, 0.75, {0}] }}
top_mass = {{ linspace = [1000, 5000, {1}], unit = "kg" }}
layer_modulus = {{ geomspace = [2.0, 20.0, {2}], unit = "MPa" }}
damping_ratio = {{ linspace = [0.0167, 0.10, {3}] }}
pga = {{ geomspace = [0.0315, 2.0, {4}], unit = "g" }}

"""
Found = dict[str, Any]


def plan_text(model: str, cells: int) -> str:
    """Blocks on rigid ground, or the walls of the rubber study over ranges of the benchmark's own."""
    points = AXES[model][cells]
    if model == "housner":
        axes = BLOCKS.format(*points)
        return refinement.BLOCKS.format(name="scale", fixed="", axes=axes, names=OUTPUTS)
    head, tail = BASE.read_text().partition("[axes]")[::2]
    return head.replace("rubber_interface", "scale") + WALLS.format(*points) + tail[tail.index("[outputs]") :]


def plan(model: str, cells: int) -> Plan:
    return parse_plan(plan_text(model, cells), BASE.parent)


def timed(kernel: Callable[..., int], spent: list[tuple[float, int]]) -> Callable[..., int]:
    """The kernel, with the processor time and the lane-steps of each call noted."""

    def call(*arguments: Any) -> int:
        began = time.thread_time()
        steps = kernel(*arguments)
        spent.append((time.thread_time() - began, int(steps)))
        return steps

    return call


def measure(model: str, cells: int) -> Found:
    """One study from plan to cube in a scratch folder; the kernel is loaded before the clock starts."""
    chosen, spent = plan(model, cells), list[tuple[float, int]]()
    lanes: Any = importlib.import_module(f"models.{model}.lanes.run")
    evaluate(Setting.of(chosen), motions_by_name(chosen), chosen.grid.coordinates(np.zeros(1, int)))
    lanes.advance = timed(lanes.advance, spent)
    load = os.getloadavg()[0]
    with tempfile.TemporaryDirectory() as scratch:
        began = time.process_time()
        report = run(chosen, results=scratch, scheduler="threads", workers=WORKERS)
        cpu = time.process_time() - began
        blocks = sum(path.stat().st_size for path in (report.folder / "blocks").glob("*.nc"))
        cube = report.cube.stat().st_size
    kernels, steps = (float(sum(column)) for column in zip(*spent, strict=True))
    return {
        "cells": report.cells, "blocks": report.blocks, "lane_steps": steps, "seconds": report.seconds,
        "cpu_seconds": cpu, "kernel_cpu_seconds": kernels, "overhead_share": 1.0 - kernels / cpu,
        "bytes": cube + blocks, "cube_bytes": cube, "failed_blocks": report.failed, "load_before": load,
        "peak_memory": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024,
    }  # fmt: skip


def cost(small: Found, large: Found) -> Found:
    """a, s, r and c of the model, processor time, from two sizes."""
    outside = [one["cpu_seconds"] - one["kernel_cpu_seconds"] for one in (small, large)]
    each = (outside[1] - outside[0]) / (large["cells"] - small["cells"])
    return {
        "start_seconds": outside[0] - each * small["cells"],
        "steps_per_cell": large["lane_steps"] / large["cells"],
        "steps_per_second_and_core": large["lane_steps"] / large["kernel_cpu_seconds"],
        "seconds_per_cell_outside": each,
        "bytes_per_cell": (large["bytes"] - small["bytes"]) / (large["cells"] - small["cells"]),
    }


def cpu_seconds(of: Found, cells: float) -> float:
    """Processor time of so many cells."""
    kernels = of["steps_per_cell"] / of["steps_per_second_and_core"]
    return float(of["start_seconds"] + cells * (kernels + of["seconds_per_cell_outside"]))


def summary(sizes: dict[str, Found]) -> Found:
    """Growth over the sizes of one model, and what the model of the cost foretells of the largest."""
    measured = sorted(sizes.values(), key=lambda one: one["cells"])
    cells, cpu = (np.log([one[name] for one in measured]) for name in ("cells", "cpu_seconds"))
    found: Found = {"growth_exponent": float(np.polyfit(cells, cpu, 1)[0]), "largest": measured[-1]["cells"]}
    found |= {name: measured[-1][name] for name in ("seconds", "bytes", "peak_memory", "overhead_share")}
    if len(measured) > 2:
        found["cost"] = cost(*measured[-3:-1])
        found["foretold_over_measured"] = (
            cpu_seconds(found["cost"], measured[-1]["cells"]) / measured[-1]["cpu_seconds"]
        )
    return found


def kills(cells: int, seconds: float = KILL_SECONDS) -> Found:
    """Blocks on a cluster of two workers, of which one is killed every so many seconds, against an undisturbed run."""
    row, killed = Row("a worker killed"), 0
    with tempfile.TemporaryDirectory() as scratch, cluster() as found:
        path = Path(scratch) / "plan.toml"
        path.write_text(plan_text("housner", cells) + "[run]\nblock_seconds = 0.5\n")
        reference = run(path, results=Path(scratch) / "alone", workers=WORKERS).folder
        results, began = Path(scratch) / "killed", time.monotonic()
        command = Command("run", path, "--results", results, "--scheduler", found.address)
        while command.running:
            command.process.join(seconds)
            if command.running:
                found.kill_worker(killed % WORKERS)
                killed += 1
        row.finished(*command.end())
        took = time.monotonic() - began
        compare_cubes(reference, results / reference.name, row)
    return {"cells": cells, "kills": killed, "seconds": took, "wrong_cells": row.wrong_cells, "notes": row.notes}


def borders(size: int = BORDERS) -> Found:
    """Shares computed and wrong of a map of which only the borders are computed, and how often the interval holds."""
    truth = refinement.whole(f"bench_refine_{size}", 'height = "2 m"', refinement.FLAT.format(n=size))
    found = refinement.refined(truth, budget=0.2, guard=1000)
    return {
        "shape": truth.shape, "computed_share": found["computed_share"], "wrong_share": found["wrong_share"],
        "coverage": refinement.crops(truth)["coverage"],
    }  # fmt: skip


def show(stages: Found) -> None:
    """The table of what was measured."""
    print("".join(f"{word:>16}" for word in ("model", "cells", "wall s", "cpu s", "outside", "MB", "peak MB")))
    for model, sizes in stages["sizes"].items():
        for one in sorted(sizes.values(), key=lambda one: one["cells"]):
            numbers = (one["seconds"], one["cpu_seconds"])
            row = [model, str(one["cells"]), *(f"{x:.1f}" for x in numbers), f"{100 * one['overhead_share']:.1f} %"]
            print("".join(f"{x:>16}" for x in (*row, *(f"{one[x] / 1e6:.4g}" for x in ("bytes", "peak_memory")))))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--model", choices=AXES, default="housner")
    parser.add_argument("--cells", type=float, nargs="+", default=[1e4, 1e5, 1e6], help="sizes, up to 1e7 of housner")
    parser.add_argument("--only", choices=PARTS, nargs="+", default=list(PARTS))
    parser.add_argument("--one", type=int, help=argparse.SUPPRESS)
    chosen = parser.parse_args()
    if chosen.one:
        print(json.dumps(measure(chosen.model, chosen.one)))
        return
    if unknown := [n for n in chosen.cells if int(n) not in AXES[chosen.model]]:
        parser.error(f"sizes are {', '.join(map(str, AXES[chosen.model]))}, not {unknown[0]:g}")
    stages: Found = json.loads(OUT.read_text()) if OUT.exists() else {"sizes": {}}
    OUT.parent.mkdir(parents=True, exist_ok=True)

    def keep() -> None:
        OUT.write_text(json.dumps(stages, indent=1) + "\n")

    for cells in sorted(int(n) for n in chosen.cells) if "sizes" in chosen.only else ():
        command = [sys.executable, "-m", "benchmarks.scale", "--model", chosen.model, "--one", str(cells)]
        one = json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout)
        stages["sizes"].setdefault(chosen.model, {})[str(cells)] = one
        stages[chosen.model] = summary(stages["sizes"][chosen.model])
        keep()
    if "kills" in chosen.only:
        stages["kills"] = kills(100_000)
        keep()
    if "refinement" in chosen.only:
        stages["refinement"] = borders()
        keep()
    show(stages)
    print(f"written: {OUT}")


if __name__ == "__main__":
    main()
