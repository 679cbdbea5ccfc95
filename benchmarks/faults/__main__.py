"""Inject every kind of fault and write the table: ``make faults``.

Kinds that stand in the file already are kept, so that a broken off run goes on where it stopped; ``--again`` begins
anew. Exit code 1 unless every column is zero.
"""

from __future__ import annotations

import random
import shutil
import sys
import tempfile
import time
from dataclasses import asdict
from functools import partial
from math import ceil
from pathlib import Path
from typing import Any

from benchmarks.by_row import fill, parser
from benchmarks.faults import disk, files, kills, together
from benchmarks.faults.row import Row

KINDS = {**files.KINDS, **disk.KINDS, **together.KINDS, **kills.KINDS}
OUT = Path("results/bench/faults.json")
COLUMNS = ("injections", "blocks_lost", "wrong_cells", "unreadable", "unclear_messages")


def inject(kind: str, share: float, seed: int) -> dict[str, Any]:
    """One row: ``share`` of the kind's injections, at least one."""
    injections, make = KINDS[kind]
    row, begun = Row(kind), time.perf_counter()
    work = Path(tempfile.mkdtemp(prefix="faults-"))
    work.chmod(0o755)
    try:
        make(work, ceil(share * injections), random.Random(f"{seed} {kind}"), row)
    finally:
        shutil.rmtree(work, ignore_errors=True)
    row.seconds = round(time.perf_counter() - begun, 1)
    return asdict(row)


def main() -> int:
    """Print the table row by row."""
    asked = parser(__doc__, OUT)
    asked.add_argument("--share", type=float, default=1.0, help="of the injections of every kind")
    given = asked.parse_args()
    makers = {kind: partial(inject, kind, given.share, given.seed) for kind in KINDS}
    return fill(given, "kind", COLUMNS, COLUMNS[1:], makers)


if __name__ == "__main__":
    sys.exit(main())
