"""Compiled lanes against the plain reference on random blocks and motions: how often they differ.

    python -m benchmarks.agreement [CASES]

A case is *near the separatrix* when the peak rotation reaches .8 alpha or the outcome changes with .1 %
of PGA; there neighbouring trajectories part, whoever integrates them. Writes
results/bench/agreement.json.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np

import models
from tests.models.strategies import random_block, random_motion

TOLERANCE = 1e-5


def compare(seed: int) -> dict[str, float | bool] | None:
    """One case; None where the block does not rock."""
    model = models.get("housner")
    rng = np.random.default_rng(seed)
    values, shaking = random_block(rng), random_motion(rng)
    if model.check(values):
        return None
    onset = float(model.derive(values)["onset_acceleration"][0])
    near = onset * float(rng.uniform(1.0, 6.0)) * np.array([1.0, 0.999, 1.001])
    names = ["peak_rotation", "peak_rotation_ratio", "overturned", "impacts"]
    fast = model.evaluate(values, shaking, near, outputs=names, tail=10.0)
    slow = model.evaluate(values, shaking, near[:1], outputs=names, tail=10.0, integrator="reference")
    away = bool(slow["peak_rotation_ratio"][0] < 0.8 and np.all(fast["overturned"] == slow["overturned"][0]))
    return {
        "away": away,
        "error": float(abs(fast["peak_rotation"][0] / slow["peak_rotation"][0] - 1.0)),
        "outcome": bool(fast["overturned"][0] != slow["overturned"][0]),
        "overturned": bool(slow["overturned"][0]),
        "impacts": bool(fast["impacts"][0] != slow["impacts"][0]),
    }


def main(count: int) -> None:
    found = [case for case in map(compare, range(count)) if case is not None]
    away = np.array([case["away"] for case in found], bool)
    error = np.array([case["error"] for case in found], float)
    table = {
        "cases": len(found),
        "overturned": int(sum(case["overturned"] for case in found)),
        "away_from_separatrix": int(away.sum()),
        "away_largest_difference": float(error[away].max()),
        "away_share_over_1e-5": float(np.mean(error[away] > TOLERANCE)),
        "all_share_over_1e-5": float(np.mean(error > TOLERANCE)),
        "all_share_other_outcome": float(np.mean([case["outcome"] for case in found])),
        "all_share_other_impact_count": float(np.mean([case["impacts"] for case in found])),
        "median_difference": float(np.median(error)),
    }
    for name, value in table.items():
        print(f"{name:30s} {value:.3g}" if isinstance(value, float) else f"{name:30s} {value}")
    folder = Path("results/bench")
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "agreement.json").write_text(json.dumps(table, indent=2) + "\n")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 300)
