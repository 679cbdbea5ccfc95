"""Inject every kind of fault and write the table: ``make faults``.

Kinds that stand in the file already are kept, so that a broken off run goes on where it stopped; ``--again`` begins
anew. Exit code 1 unless every column is zero.
"""

from __future__ import annotations

import argparse
import json
import random
import shutil
import sys
import tempfile
import time
from dataclasses import asdict
from math import ceil
from pathlib import Path

from benchmarks.faults import disk, files, kills, together
from benchmarks.faults.row import Row

KINDS = {**files.KINDS, **disk.KINDS, **together.KINDS, **kills.KINDS}
OUT = Path("results/bench/faults.json")
COLUMNS = ("injections", "blocks_lost", "wrong_cells", "unreadable", "unclear_messages")


def inject(kind: str, share: float, seed: int) -> Row:
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
    return row


def main() -> int:
    """Print the table row by row."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", help="a part of the kinds' names")
    parser.add_argument("--share", type=float, default=1.0, help="of the injections of every kind")
    parser.add_argument("--seconds", type=float, default=float("inf"), help="begin no kind after so long")
    parser.add_argument("--again", action="store_true", help="inject what the file has already")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--out", type=Path, default=OUT)
    given = parser.parse_args()
    known = json.loads(given.out.read_text()) if given.out.exists() and not given.again else []
    rows = {row["kind"]: row for row in known}
    begun = time.perf_counter()
    print(f"{'kind':<48}" + "".join(f"{name.replace('_', ' '):>18}" for name in COLUMNS))
    for kind in KINDS:
        if given.only in kind and kind not in rows and time.perf_counter() - begun < given.seconds:
            rows[kind] = asdict(inject(kind, given.share, given.seed))
            given.out.parent.mkdir(parents=True, exist_ok=True)
            given.out.write_text(json.dumps(list(rows.values()), indent=1) + "\n")
        if kind in rows and given.only in kind:
            print(f"{kind:<48}" + "".join(f"{rows[kind][name]:>18}" for name in COLUMNS), flush=True)
    bad = [row for row in rows.values() if any(row[name] for name in COLUMNS[1:])]
    for row in bad:
        print(f"\n{row['kind']}:", *row["notes"][:5], sep="\n  ")
    print(f"{sum(row['injections'] for row in rows.values())} injections, {len(bad)} kinds with findings")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
