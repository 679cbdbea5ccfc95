"""Speed of stacked blocks, walls on rubber by law, and buildings on rubber, both sides of every ratio in one run."""

from __future__ import annotations

import json
import os
import platform
import tempfile
import time
from functools import partial
from importlib import import_module
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

import models
from benchmarks import speed
from benchmarks.peak import multiply_add_peak
from benchmarks.two_blocks import opensees_strip
from benchmarks.two_blocks.cases import Case, cases
from grids.motions import read_motion
from models.runs import Request
from models.shaking import Shaking

TAIL = 10.0
SECONDS = 0.7
"""Wall time of one timed run."""
WINDOW = 4.0
"""s of the record's strongest part, on which the plain references run."""
ACCURACY = 1e-6
"""Relative tolerance of the references: the lanes' own error in the peaks is some 1e-4."""
OUT = Path("results/bench/two_blocks.json")


def timed_lanes(case: Case, shaking: Shaking, tail: float, n: int) -> speed.Took:
    """n walls under the shaking and ``tail`` seconds more."""
    walls, pga = case.walls(n, shaking.vertical is not None)
    request = Request(shaking, pga / shaking.pga, tail=tail)
    return speed.clocked(lambda: models.get(case.model).run_lanes(walls, request).steps)


def strongest(shaking: Shaking) -> Shaking:
    """``WINDOW`` seconds about the peak."""
    half = round(0.5 * WINDOW / shaking.time_step)
    peak = int(np.argmax(np.abs(shaking.horizontal)))
    first = max(0, peak - half)
    span = slice(first, first + 2 * half)
    return Shaking(
        shaking.time_step, shaking.horizontal[span], shaking.vertical[span] if shaking.vertical is not None else None
    )


def solve_ivp_seconds(case: Case, shaking: Shaking, walls: int = 3) -> float:
    """Processor time of the plain reference (scipy's DOP853 with events) a wall, the median."""
    there = import_module(f"models.{case.model}.reference")
    drawn, pga = case.walls(walls, shaking.vertical is not None)
    took = []
    for k in range(walls):
        one = drawn.take(slice(k, k + 1))
        began = time.thread_time()
        if case.model == "stacked":
            import_module("models.stacked.reference.run").run(one, Request(shaking, pga[[k]] / shaking.pga), ACCURACY)
        else:
            there.run(one, shaking, float(pga[k] / shaking.pga), tail=0.0, rtol=ACCURACY)
        took.append(time.thread_time() - began)
    return median(took)


def measure(case: Case, shaking: Shaking, peak: float) -> dict[str, Any]:
    """One entry of the report: the keys of one block's; None where there is no such rival or count."""
    timed = partial(timed_lanes, case, shaking, TAIL)
    lanes = speed.fitting(timed, SECONDS)
    rate, per_lane = speed.rate(timed, lanes)
    window = strongest(shaking)
    brief = partial(timed_lanes, case, window, 0.0)
    few = speed.fitting(brief, 0.3 * SECONDS)
    slow, fast = solve_ivp_seconds(case, window), speed.rate(brief, few, 3)[1]
    found: dict[str, Any] = {
        "lane_steps_per_second_core": rate,
        "peak_share": rate * case.operations / peak if case.operations else None,
        "ratio_solve_ivp": slow / fast,
        "ratio_opensees_block": None,
        "ratio_opensees_strip": None,
        "two_thread_speedup": speed.two_threads(timed, lanes),
        "growth_exponent": speed.growth(timed, [max(16, lanes // 16 * part) for part in (2, 4, 8, 16)]),
        "operations_per_step": case.operations,
        "step_seconds": few * window.duration / brief(few).steps,
        "seconds_per_run": per_lane,
        "solve_ivp_seconds_per_run": slow,
        "opensees_steps_per_second": None,
    }
    with tempfile.TemporaryDirectory() as scratch:
        found["overhead_share"] = speed.overhead(Path(scratch), case.plan)
        found["two_process_speedup"] = speed.two_processes(Path(scratch), case.plan)
    if case.name == "interface.linear":
        found |= opensees_strip.ratios(rate)
    return found


def main() -> None:
    shaking = read_motion("ridgecrest_2019_clc").shaking()
    peak = median(multiply_add_peak() for _ in range(3))
    report: dict[str, Any] = {
        "multiply_add_peak_256": peak, "cores": os.cpu_count(), "machine": platform.machine(),
        "load_before": os.getloadavg()[0],
    }  # fmt: skip
    OUT.parent.mkdir(parents=True, exist_ok=True)
    for case in cases():
        report[case.name] = found = measure(case, shaking, peak)
        linear = report.get("interface.linear")
        if case.model == "interface" and linear is not None:
            found["cost_over_linear"] = linear["lane_steps_per_second_core"] / found["lane_steps_per_second_core"]
        print(f"\n{case.name}")
        for key, value in found.items():
            print(f"  {key:34s} {value if not isinstance(value, float) else f'{value:.4g}'}", flush=True)
        OUT.write_text(json.dumps(report, indent=2) + "\n")
    print(f"\nwritten: {OUT}")


if __name__ == "__main__":
    main()
