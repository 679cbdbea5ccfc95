"""Speed of one block, both sides of every ratio in one run: ``make bench``."""

from __future__ import annotations

import json
import os
import platform
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

from benchmarks.one_block.rivals import opensees_steps_per_second, solve_ivp_seconds
from benchmarks.operations import count_operations
from benchmarks.peak import multiply_add_peak
from grids.motions import read_motion
from models.housner.block import Block, build
from models.housner.lanes import run as lanes
from models.housner.lanes.advance import step_all
from models.shaking import Shaking
from study.run import Report, run

TAIL = 10.0
OUT = Path("results/bench/one_block.json")


def blocks(n: int) -> tuple[Block, np.ndarray[Any, np.dtype[np.float64]]]:
    """n blocks 2 m high, width/height .1 to .5, and scales of the record from .3 to 1.6."""
    rng = np.random.default_rng(0)
    block = build({"height": 2.0, "aspect_ratio": rng.uniform(0.1, 0.5, n), "mass": 1000.0}, True, n)
    return block, rng.uniform(0.3, 1.6, n)


def seconds(shaking: Shaking, n: int) -> tuple[float, int]:
    """Wall time and lane-steps of n blocks."""
    block, scale = blocks(n)
    began = time.perf_counter()
    found = lanes.run(block, shaking, scale, tail=TAIL)
    return time.perf_counter() - began, found.steps


def plan(name: str, points: int) -> str:
    return f"""
[study]
name = "{name}"
model = "housner"
[motion]
files = ["ridgecrest_2019_clc"]
[parameters]
height = "2 m"
mass = "1000 kg"
[axes]
aspect_ratio = {{ linspace = [0.1, 0.5, 100] }}
pga = {{ linspace = [0.1, 0.8, {points}], unit = "g" }}
"""


def study(folder: Path, name: str, points: int, scheduler: str, workers: int | None) -> Report:
    """A run whose partition is known and whose kernel is loaded: computing, storing and scheduling alone."""
    path = folder / f"{name}.toml"
    path.write_text(plan(name, points))
    first = run(path, results=folder / "results", scheduler=scheduler, workers=workers)
    for block in (first.folder / "blocks").glob("*.nc"):
        block.unlink()
    return run(path, results=folder / "results", scheduler=scheduler, workers=workers)


def two_processes(folder: Path, points: int) -> tuple[float, float]:
    """Seconds of the same study on one and on two processes of a local cluster."""
    from distributed import Client, LocalCluster

    took = []
    for n in (1, 2):
        with LocalCluster(n_workers=n, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as c:
            c.run(warm)
            took.append(study(folder, f"processes_{n}", points, cluster.scheduler_address, None).seconds)
    return took[0], took[1]


def warm() -> None:
    """Compile or load the kernel, so that only computing is measured."""
    seconds(read_motion("ridgecrest_2019_clc").shaking(), 16)


def main() -> None:
    shaking = read_motion("ridgecrest_2019_clc").shaking()
    warm()
    peak = multiply_add_peak()
    operations = count_operations(step_all, ("general", "linear"))
    timed = [seconds(shaking, 20_000) for _ in range(5)]
    rate = median(steps / took for took, steps in timed)
    per_lane = median(took for took, _ in timed) / 20_000
    peak = median((peak, multiply_add_peak(), multiply_add_peak()))

    block, scale = blocks(6)
    step = shaking.time_step / int(lanes.substeps(block, shaking.time_step)[0])
    slow = median(
        solve_ivp_seconds(block.take(slice(k, k + 1)), shaking, float(scale[k]), step, TAIL) for k in range(6)
    )
    opensees = opensees_steps_per_second(block.take(slice(5, 6)), shaking, 0.5, step, 20_000)
    sizes = (2_000, 8_000, 32_000, 128_000)
    growth = np.polyfit(np.log(sizes), np.log([seconds(shaking, n)[0] for n in sizes]), 1)[0]
    with ThreadPoolExecutor(2) as pool:
        ratios = []
        for _ in range(3):
            one = seconds(shaking, 40_000)[0] + seconds(shaking, 40_000)[0]
            began = time.perf_counter()
            list(pool.map(lambda n: seconds(shaking, n), (40_000, 40_000)))
            ratios.append(one / (time.perf_counter() - began))
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        one_core = study(folder, "overhead", 4_000, "synchronous", None)
        first, second = two_processes(folder, 4_000)

    found = {
        "lane_steps_per_second_core": rate,
        "peak_share": rate * operations / peak,
        "ratio_solve_ivp": slow / per_lane,
        "ratio_opensees_block": rate / opensees if opensees else None,
        "overhead_share": 1.0 - one_core.compute_seconds / one_core.seconds,
        "two_thread_speedup": median(ratios),
        "two_process_speedup": first / second,
        "growth_exponent": float(growth),
        "operations_per_step": operations,
        "multiply_add_peak_256": peak,
        "step_seconds": step,
        "seconds_per_run": per_lane,
        "solve_ivp_seconds_per_run": slow,
        "opensees_steps_per_second": opensees,
        "cores": os.cpu_count(),
        "machine": platform.machine(),
    }
    OUT.parent.mkdir(parents=True, exist_ok=True)
    OUT.write_text(json.dumps(found, indent=2) + "\n")
    for key, value in found.items():
        print(f"{key:30s} {value if not isinstance(value, float) else f'{value:.4g}'}")
    print(f"written: {OUT}")


if __name__ == "__main__":
    main()
