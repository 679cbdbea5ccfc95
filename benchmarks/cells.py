"""What a study of ten thousand, a hundred thousand and a million cells costs: the rubber study, denser.

    python -m benchmarks.cells [--cells 1e4 1e5 1e6]

Each size runs in a process of its own (peak memory), its kernels loaded before. Processor time is
split into that of the lane kernels and the rest. A model of the cost, fitted to the two smaller sizes,
predicts the largest: processor and wall time a + b S, S the lane-steps of the whole grid counted from its
walls without running them; bytes and memory a + b N. Sizes measured before are kept in
results/bench/cells.json, so that they can be run at different times.
"""

from __future__ import annotations

import argparse
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

from grids.plan import Plan, parse_plan
from models.interface import modes
from models.interface.lanes import run as lanes
from models.interface.model import MODEL
from study.run import run

OUT = Path("results/bench/cells.json")
BASE = Path(__file__).parent.parent / "studies" / "rubber_interface.toml"
AXES = {10_000: (10, 4, 10, 5, 5), 100_000: (10, 5, 20, 5, 20), 1_000_000: (20, 10, 25, 10, 20)}
"""Points of aspect ratio, top mass, modulus, damping ratio and PGA."""
WALLS = 4096
"""Random cells from which the steps of a grid are counted."""
WORKERS = 2
COUNTED = ("cpu_seconds", "seconds", "cube_bytes", "block_bytes", "peak_memory_bytes")
Found = dict[str, Any]


def plan(cells: int) -> Plan:
    """The rubber study over the same ranges with other numbers of points."""
    aspect, mass, modulus, damping, pga = AXES[cells]
    head, tail = BASE.read_text().partition("[axes]")[::2]
    outputs = tail[tail.index("[outputs]") :]
    axes = f"""
aspect_ratio = {{ linspace = [0.4, 1.2, {aspect}] }}
top_mass = {{ linspace = [1000, 5000, {mass}], unit = "kg" }}
layer_modulus = {{ geomspace = [1.0, 20.0, {modulus}], unit = "MPa" }}
damping_ratio = {{ linspace = [0.0167, 0.10, {damping}] }}
pga = {{ linspace = [0.05, 0.77, {pga}], unit = "g" }}
"""
    return parse_plan(f"{head}[axes]{axes}{outputs}".replace("rubber_interface", f"cells_{cells}"), BASE.parent)


def lane_steps(chosen: Plan) -> float:
    """Steps of all cells if every run lasts the record: from the step rule of random walls of the grid."""
    index = np.random.default_rng(0).integers(0, chosen.grid.size, WALLS)
    varied = {name: v for name, v in chosen.grid.coordinates(index).items() if name != "pga"}
    walls = MODEL.build({**chosen.fixed, **varied}, vertical=True, size=WALLS)
    (motion,) = chosen.motions
    return (
        float(lanes.substeps(walls, modes.at_rest(walls).squares, motion.time_step).mean())
        * motion.horizontal.size
        * chosen.grid.size
    )


def timed(kernel: Callable[..., int], spent: list[float]) -> Callable[..., int]:
    """The kernel, with the processor time of each call noted."""

    def call(*arguments: Any) -> int:
        began = time.thread_time()
        steps = kernel(*arguments)
        spent.append(time.thread_time() - began)
        return steps

    return call


def measure(cells: int) -> Found:
    """One study from plan to cube in a scratch folder; the kernel is loaded before the clock starts."""
    chosen, spent = plan(cells), []
    MODEL.evaluate(
        {name: float(axis[0]) for name, axis in chosen.grid.coordinates(np.zeros(1, int)).items() if name != "pga"}
        | dict(chosen.fixed),
        chosen.motions[0].cut(0.0, 0.1).shaking(), np.ones(1), outputs=chosen.outputs, tail=0.0,
    )  # fmt: skip
    lanes.advance = timed(lanes.advance, spent)  # type: ignore[assignment]
    load = os.getloadavg()[0]
    with tempfile.TemporaryDirectory() as scratch:
        began = time.process_time()
        report = run(chosen, results=scratch, scheduler="threads", workers=WORKERS)
        cpu = time.process_time() - began
        blocks = sum(path.stat().st_size for path in (report.folder / "blocks").glob("*.nc"))
        cube = report.cube.stat().st_size
    return {
        "cells": report.cells,
        "blocks": report.blocks,
        "lane_steps": lane_steps(chosen),
        "seconds": report.seconds,
        "cpu_seconds": cpu,
        "kernel_cpu_seconds": sum(spent),
        "share_outside_kernels": 1.0 - sum(spent) / cpu,
        "cube_bytes": cube,
        "block_bytes": blocks,
        "peak_memory_bytes": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024,
        "failed_blocks": report.failed,
        "load_before": load,
    }


def predict(small: Found, large: Found, cells: int) -> Found:
    """The cost of ``cells`` from two sizes: times grow with the lane-steps, sizes with the cells."""
    steps = lane_steps(plan(cells))
    found: Found = {"cells": cells, "lane_steps": steps}
    for name in COUNTED:
        by, at = ("lane_steps", steps) if name.endswith("seconds") else ("cells", float(cells))
        slope = (large[name] - small[name]) / (large[by] - small[by])
        found[name] = small[name] + slope * (at - small[by])
    return found


def show(stages: dict[str, Found]) -> None:
    """The table of what was measured, and of what was foretold for the largest size."""
    head = ("cells", "wall s", "cpu s", "outside kernels", "cube MB", "blocks MB", "peak MB")
    print("".join(f"{word:>17}" for word in head))
    for _, found in sorted(stages.items(), key=lambda item: (item[1]["cells"], item[0])):
        share = f"{100 * found['share_outside_kernels']:.1f} %" if "share_outside_kernels" in found else "predicted"
        sizes = (found[f"{name}_bytes"] / 1e6 for name in ("cube", "block", "peak_memory"))
        row = (f"{found['cells']}", f"{found['seconds']:.1f}", f"{found['cpu_seconds']:.1f}", share)
        print("".join(f"{text:>17}" for text in (*row, *(f"{size:.4g}" for size in sizes))))


def main() -> None:
    """Run the chosen sizes, keep what was measured before, predict the largest."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cells", type=float, nargs="+", default=list(AXES), help="1e4, 1e5, 1e6 (default: all)")
    parser.add_argument("--one", type=int, help=argparse.SUPPRESS)
    chosen = parser.parse_args()
    if chosen.one:
        print(json.dumps(measure(chosen.one)))
        return
    unknown = [n for n in chosen.cells if int(n) not in AXES]
    if unknown:
        parser.error(f"sizes are {', '.join(map(str, AXES))}, not {unknown[0]:g}")
    stages: dict[str, Found] = json.loads(OUT.read_text()) if OUT.exists() else {}
    for cells in sorted(int(n) for n in chosen.cells):
        command = [sys.executable, "-m", "benchmarks.cells", "--one", str(cells)]
        stages[str(cells)] = json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout)
        small, large, most = (str(n) for n in AXES)
        if small in stages and large in stages:
            stages[f"{most}_predicted"] = predict(stages[small], stages[large], int(most))
        OUT.parent.mkdir(parents=True, exist_ok=True)
        OUT.write_text(json.dumps(stages, indent=2) + "\n")
    show(stages)
    print(f"written: {OUT}")


if __name__ == "__main__":
    main()
