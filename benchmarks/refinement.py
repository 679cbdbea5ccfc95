"""Refined maps against whole ones: how many cells, how many wrong, and how often the stated share holds.

    make bench-refine            # 1024 x 1024 overturning map of a Ridgecrest record, a four-axis onset map
    python -m benchmarks.refinement --size 160

Writes ``results/bench/refinement.json``: of the map the curve of wrong against computed share over budgets, of crops of
it (100 seeds) how often the true share lies within the stated interval, of the four-axis map of onset its line.
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path
from typing import Any

import numpy as np
from scipy.stats import binomtest

from grids.plan import parse_plan
from grids.refinement import Labels, Refinement
from study.open import open_study
from study.run import run
from study.store import write_text

OUT = Path("results/bench/refinement.json")
BUDGETS = (0.02, 0.05, 0.1, 0.2, 0.3)
CROP, SEEDS = 96, 100
BLOCKS = """
[study]
name = "{name}"
model = "housner"
[motion]
files = ["ridgecrest_2019_clc"]
vertical = false
[parameters]
mass = "1 t"
{fixed}
[axes]
{axes}
[outputs]
names = {names}
"""
"""A study of single blocks of one tonne under a Ridgecrest record."""
FLAT = """
aspect_ratio = {{ linspace = [0.1, 0.4, {n}] }}
pga = {{ linspace = [0.05, 1.2, {n}], unit = "g" }}
"""
FOUR = """
height = {{ linspace = [1, 4, {n}], unit = "m" }}
aspect_ratio = {{ linspace = [0.1, 0.4, {n}] }}
top_mass = {{ linspace = [0, 1000, {n}], unit = "kg" }}
pga = {{ linspace = [0.05, 0.6, {n}], unit = "g" }}
"""


def whole(name: str, fixed: str, axes: str) -> Labels:
    """Status of every cell of a plan, computed."""
    report = run(parse_plan(BLOCKS.format(name=name, fixed=fixed, axes=axes, names=["overturned"]), Path.cwd()))
    return np.asarray(open_study(report.folder)["status"].values, dtype=np.int8)


def refined(truth: Labels, **options: Any) -> dict[str, Any]:
    """One line of the report: refinement told from the whole map."""
    flat, policy, begun = truth.ravel(), Refinement(truth.shape, **options), time.perf_counter()
    while (cells := policy.ask()).size:
        policy.tell(cells, flat[cells])
    estimate = policy.estimate
    wrong = float(np.mean(policy.labels() != flat))
    return {
        "computed_share": estimate.computed_share,
        "wrong_share": wrong,
        "stated": [estimate.wrong_share, estimate.low, estimate.high],
        "within": bool(estimate.low <= wrong <= estimate.high),
        "complete": estimate.complete,
        "policy_seconds": time.perf_counter() - begun,
    }


def crops(truth: Labels) -> dict[str, Any]:
    """Coverage of the stated interval over random pieces of the map."""
    random = np.random.default_rng(1)
    size = min(CROP, *truth.shape)
    held = []
    for seed in range(SEEDS):
        row, column = (int(random.integers(0, n - size + 1)) for n in truth.shape)
        held.append(
            refined(truth[row : row + size, column : column + size], budget=0.3, guard=250, seed=seed)["within"]
        )
    interval = binomtest(sum(held), SEEDS).proportion_ci(0.95)
    return {"coverage": sum(held) / SEEDS, "interval": [interval.low, interval.high], "seeds": SEEDS, "cells": size**2}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", type=int, default=1024, help="values of an axis of the map")
    parser.add_argument("--four", type=int, default=24, help="values of an axis of the four-axis map")
    asked = parser.parse_args()
    flat = whole(f"bench_refine_{asked.size}", 'height = "2 m"', FLAT.format(n=asked.size))
    onset = np.minimum(whole(f"bench_refine_four_{asked.four}", "", FOUR.format(n=asked.four)), 2).astype(np.int8)
    found = {
        "map": {"shape": flat.shape, "budgets": {str(b): refined(flat, budget=b, guard=3000) for b in BUDGETS}},
        "crops": crops(flat),
        "four_axes": {"shape": onset.shape, "budgets": {str(b): refined(onset, budget=b) for b in BUDGETS}},
    }
    write_text(OUT, json.dumps(found, indent=1) + "\n")
    print(json.dumps(found, indent=1))


if __name__ == "__main__":
    main()
