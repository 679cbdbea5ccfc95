"""Rigid blocks in MuJoCo, walls on no-tension layers in OpenSeesPy: the same numbers by another program.

    python -m benchmarks.independent

Needs the extra ``proof``; what is not installed is left out, and said. docs/proof.md explains the differences.
"""

from __future__ import annotations

import json
import platform
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path
from typing import Any

from benchmarks import opensees
from benchmarks.independent import mujoco_blocks, rigid, strips
from benchmarks.independent.table import Row, show

OUT = Path("results/bench/independent.json")
PROGRAMS: dict[str, tuple[Callable[[], bool], str, tuple[tuple[str, Callable[[], list[Row]]], ...]]] = {
    "mujoco": (
        mujoco_blocks.available,
        "mujoco",
        (
            ("One block, free rocking", rigid.free_rocking),
            ("One block, impacts", rigid.impacts),
            ("Two stacked blocks, which pattern starts and how fast", rigid.patterns),
            ("Two stacked blocks, thresholds", rigid.thresholds),
            ("A pulse", rigid.pulses),
        ),
    ),
    "opensees": (
        opensees.available,
        "openseespy",
        (
            ("One strip, static uplift", strips.uplift_curve),
            ("The short wall at rest, natural frequencies", strips.frequencies),
            ("A block on a strip, free rocking", strips.free_rocking),
            ("The short wall under a record", strips.shaken),
        ),
    ),
}


def main() -> None:
    found: dict[str, Any] = {"machine": platform.machine()}
    for program, (available, distribution, tables) in PROGRAMS.items():
        if not available():
            print(f"{distribution} is not installed: pip install -e '.[proof]'")
            found[program] = None
            continue
        found[program] = {"version": version(distribution)}
        for title, table in tables:
            rows = table()
            show(title, rows)
            found[program][table.__name__] = [row.as_dict() for row in rows]
    OUT.parent.mkdir(parents=True, exist_ok=True)
    OUT.write_text(json.dumps(found, indent=2) + "\n")
    print(f"\nwritten: {OUT}")


if __name__ == "__main__":
    main()
