"""Speed of one block, both sides of every ratio in one run: ``make bench``."""

from __future__ import annotations

import json
import os
import platform
import tempfile
from functools import partial
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

from benchmarks import speed
from benchmarks.one_block.rivals import opensees_steps_per_second, solve_ivp_seconds
from benchmarks.operations import count_operations
from benchmarks.peak import multiply_add_peak
from grids.motions import read_motion
from models.housner.block import Block
from models.housner.lanes import run as lanes
from models.housner.lanes.advance import step_all
from models.housner.model import MODEL
from models.runs import Request
from models.shaking import Shaking

TAIL = 10.0
OUT = Path("results/bench/one_block.json")


def blocks(n: int) -> tuple[Block, np.ndarray[Any, np.dtype[np.float64]]]:
    """n blocks 2 m high, width/height .1 to .5, and scales of the record from .3 to 1.6."""
    rng = np.random.default_rng(0)
    block = MODEL.build(
        {"height": 2.0, "aspect_ratio": rng.uniform(0.1, 0.5, n), "mass": 1000.0}, vertical=True, size=n
    )
    return block, rng.uniform(0.3, 1.6, n)


def timed_lanes(shaking: Shaking, n: int) -> speed.Took:
    """n blocks under the whole record."""
    block, scale = blocks(n)
    return speed.clocked(lambda: lanes.run(block, Request(shaking, scale, tail=TAIL)).steps)


PLAN = """
model = "housner"
[motion]
files = ["ridgecrest_2019_clc"]
[parameters]
height = "2 m"
mass = "1000 kg"
[axes]
aspect_ratio = { linspace = [0.1, 0.5, 100] }
pga = { linspace = [0.1, 0.8, 4000], unit = "g" }
"""


def main() -> None:
    shaking = read_motion("ridgecrest_2019_clc").shaking()
    timed = partial(timed_lanes, shaking)
    timed(16)
    peak = multiply_add_peak()
    operations = count_operations(step_all, ("general", "linear"))
    rate, per_lane = speed.rate(timed, 20_000)
    peak = median((peak, multiply_add_peak(), multiply_add_peak()))

    block, scale = blocks(6)
    step = shaking.time_step / int(lanes.substeps(block, shaking.time_step)[0])
    slow = median(
        solve_ivp_seconds(block.take(slice(k, k + 1)), shaking, float(scale[k]), step, TAIL) for k in range(6)
    )
    opensees = opensees_steps_per_second(block.take(slice(5, 6)), shaking, 0.5, step, 20_000)
    with tempfile.TemporaryDirectory() as scratch:
        overhead = speed.overhead(Path(scratch), PLAN)
        processes = speed.two_processes(Path(scratch), PLAN)

    found = {
        "lane_steps_per_second_core": rate,
        "peak_share": rate * operations / peak,
        "ratio_solve_ivp": slow / per_lane,
        "ratio_opensees_block": rate / opensees if opensees else None,
        "overhead_share": overhead,
        "two_thread_speedup": speed.two_threads(timed, 40_000),
        "two_process_speedup": processes,
        "growth_exponent": speed.growth(timed, (2_000, 8_000, 32_000, 128_000)),
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
