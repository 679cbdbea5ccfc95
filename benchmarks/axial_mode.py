"""The stiff axial mode does not dictate the step: accuracy and cost over the range of the rubber study.

    python -m benchmarks.axial_mode

Random cells of studies/rubber_interface.toml, grouped by the bound that the overdamped axial mode sets to an
explicit fourth-order step, 2.8/rate with rate = 2 (c_b b1 + c_t bt)/m1. Cost: evaluations of the equations
per second of motion, four a step at that bound against one a step of the lanes. Errors: against a
sixteenth of the step, relative, of the cells that do not overturn. Writes results/bench/axial_mode.json.
"""

from __future__ import annotations

import json
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from grids.plan import read_plan
from models.interface import modes
from models.interface.lanes import run as lanes
from models.interface.model import MODEL
from models.runs import Request

OUT = Path("results/bench/axial_mode.json")
PLAN = Path(__file__).parent.parent / "studies" / "rubber_interface.toml"
CELLS, FINE = 512, 16
EXPLICIT_LIMIT, EXPLICIT_EVALUATIONS = 2.8, 4.0
BOUNDS = (0.0, 0.3e-3, 1e-3, 3e-3, np.inf)
"""s: borders of the groups."""
OUTPUTS = ("peak_rotation", "uplift_duration", "minimum_contact", "dissipated_energy")


def measure() -> list[dict[str, Any]]:
    """A group of walls a row."""
    plan = read_plan(PLAN)
    index = np.random.default_rng(0).integers(0, plan.grid.size, CELLS)
    cells = plan.grid.coordinates(index)
    (motion,) = plan.motions
    shaking, scale = motion.shaking(), cells.pop("pga") / motion.pga
    wall = MODEL.build({**plan.fixed, **cells}, vertical=True, size=CELLS)
    rate = 2.0 * (wall.base_damping * wall.base_half_width + wall.top_damping * wall.top_half_width) / wall.mass_1
    bound, step = (
        EXPLICIT_LIMIT / rate,
        motion.time_step / lanes.substeps(wall, modes.at_rest(wall).squares, motion.time_step),
    )
    coarse, fine = (lanes.run(wall, Request(shaking, scale, tail=plan.tail), n).outputs for n in (1, FINE))
    stands = ~(coarse["overturned"] | fine["overturned"])
    rows = []
    for low, high in pairwise(BOUNDS):
        here = (bound >= low) & (bound < high)
        if not here.any():
            continue
        row: dict[str, Any] = {
            "explicit_bound_ms": [1e3 * float(bound[here].min()), 1e3 * float(bound[here].max())],
            "cells": int(here.sum()),
            "step_ms": [1e3 * float(v) for v in np.quantile(step[here], [0.0, 0.5, 1.0])],
            "evaluations_explicit_over_lanes": float(
                np.mean(EXPLICIT_EVALUATIONS / bound[here]) / np.mean(1 / step[here])
            ),
            "other_outcome": float(np.mean(coarse["overturned"][here] != fine["overturned"][here])),
        }
        for name in OUTPUTS:
            kept = here & stands & (fine[name] > 0.0)
            error = np.abs(coarse[name][kept] / fine[name][kept] - 1.0)
            row[name] = [float(v) for v in np.quantile(error, [0.5, 0.9])]
        rows.append(row)
    return rows


def main() -> None:
    rows = measure()
    OUT.parent.mkdir(parents=True, exist_ok=True)
    OUT.write_text(json.dumps(rows, indent=2) + "\n")
    head = ("explicit bound, ms", "cells", "step, ms", "explicit over lanes", *OUTPUTS)
    print(f"| {' | '.join(head)} |\n|{'---|' * len(head)}")
    for row in rows:
        low, high = row["explicit_bound_ms"]
        least, middle, most = row["step_ms"]
        errors = " | ".join(f"{row[name][0]:.0e} ({row[name][1]:.0e})" for name in OUTPUTS)
        print(
            f"| {low:.2g} to {high:.2g} | {row['cells']} | {least:.2g} to {most:.2g} (median {middle:.2g}) | "
            f"{row['evaluations_explicit_over_lanes']:.1f} | {errors} |"
        )
    print(f"written: {OUT}")


if __name__ == "__main__":
    main()
