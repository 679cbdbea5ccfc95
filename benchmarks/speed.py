"""What the speed benchmarks share: rate, growth, threads, processes, and what a study adds to its kernels.

Rates count the processor time of the thread that computes, so that other programs on the machine hardly
change them; what two threads, two processes or a whole study take is wall time.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from statistics import median

import numpy as np

from study.run import Report, run


@dataclass(frozen=True)
class Took:
    """Wall and processor time in s of one run, and its lane-steps."""

    wall: float
    processor: float
    steps: int


Timed = Callable[[int], Took]
"""Runs n lanes."""


def clocked(kernel: Callable[[], int]) -> Took:
    """Time ``kernel``, which returns its lane-steps."""
    wall, processor = time.perf_counter(), time.thread_time()
    steps = kernel()
    return Took(time.perf_counter() - wall, time.thread_time() - processor, steps)


def fitting(timed: Timed, wanted: float, least: int = 64) -> int:
    """Lanes (a multiple of ``least``) that take about ``wanted`` seconds; kernels are loaded by this."""
    timed(least)
    return max(1, round(wanted / timed(least).processor)) * least


def rate(timed: Timed, lanes: int, times: int = 5) -> tuple[float, float]:
    """Lane-steps a second of processor time, and such seconds a lane: medians."""
    found = [timed(lanes) for _ in range(times)]
    return median(one.steps / one.processor for one in found), median(one.processor for one in found) / lanes


def growth(timed: Timed, sizes: Sequence[int]) -> float:
    """Exponent with which processor time grows with the number of lanes."""
    return float(np.polyfit(np.log(sizes), np.log([timed(n).processor for n in sizes]), 1)[0])


def two_threads(timed: Timed, lanes: int, times: int = 3) -> float:
    """How much faster two threads of one process do twice the work."""
    ratios = []
    with ThreadPoolExecutor(2) as pool:
        for _ in range(times):
            one = timed(lanes).wall + timed(lanes).wall
            began = time.perf_counter()
            list(pool.map(timed, (lanes, lanes)))
            ratios.append(one / (time.perf_counter() - began))
    return median(ratios)


def study(folder: Path, plan: str, name: str, scheduler: str, workers: int | None = None) -> Report:
    """A run whose partition is known and whose kernel is loaded: computing, storing and scheduling alone."""
    path = folder / f"{name}.toml"
    path.write_text(f'[study]\nname = "{name}"\n{plan}')
    first = run(path, results=folder / "results", scheduler=scheduler, workers=workers)
    for block in (first.folder / "blocks").glob("*.nc"):
        block.unlink()
    return run(path, results=folder / "results", scheduler=scheduler, workers=workers)


def overhead(folder: Path, plan: str) -> float:
    """Share of a study's time on one core that is not computing."""
    found = study(folder, plan, "overhead", "synchronous")
    return 1.0 - found.compute_seconds / found.seconds


def two_processes(folder: Path, plan: str) -> float:
    """How much faster the study is on two processes of a local cluster than on one."""
    from distributed import Client, LocalCluster

    took = []
    for n in (1, 2):
        with LocalCluster(n_workers=n, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster):  # type: ignore[no-untyped-call]
            took.append(study(folder, plan, f"processes_{n}", cluster.scheduler_address).seconds)
    return took[0] / took[1]
