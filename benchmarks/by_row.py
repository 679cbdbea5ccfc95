"""Tables that take long, a row at a time, kept in a file so that a broken off run goes on where it stopped."""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

Row = dict[str, Any]
"""Counts by column, ``notes`` on what was found, and the row's own name."""


def parser(description: str | None, out: Path) -> argparse.ArgumentParser:
    """What every such table can be asked."""
    found = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    found.add_argument("--only", default="", help="a part of the rows' names")
    found.add_argument("--seconds", type=float, default=float("inf"), help="begin no row after so long")
    found.add_argument("--again", action="store_true", help="make the rows that the file has already")
    found.add_argument("--seed", type=int, default=0)
    found.add_argument("--out", type=Path, default=out)
    return found


def fill(
    given: argparse.Namespace,
    key: str,
    counted: Sequence[str],
    wrong: Sequence[str],
    makers: Mapping[str, Callable[[], Row]],
) -> int:
    """Print the table row by row, each made by its maker or taken from the file; 1 if a row has anything ``wrong``.

    ``key``: what a row is, and the column of its name; ``counted``: the columns that are printed, the first of them
    what was tried; ``wrong``: those of them that should be zero.
    """
    known = json.loads(given.out.read_text()) if given.out.exists() and not given.again else []
    rows: dict[str, Row] = {row[key]: row for row in known}
    widths = [max(map(len, makers)) + 2, *(max(len(column), 8) + 3 for column in counted)]
    sides = "<" + len(counted) * ">"

    def line(cells: Sequence[object]) -> str:
        return "".join(f"{cell!s:{side}{w}}" for cell, side, w in zip(cells, sides, widths, strict=True))

    print(line([key, *(column.replace("_", " ") for column in counted)]))
    begun = time.perf_counter()
    for name, make in makers.items():
        if given.only not in name:
            continue
        if name not in rows and time.perf_counter() - begun < given.seconds:
            rows[name] = make()
            given.out.parent.mkdir(parents=True, exist_ok=True)
            given.out.write_text(json.dumps(list(rows.values()), indent=1) + "\n")
        if name in rows:
            print(line([name, *(rows[name][column] for column in counted)]), flush=True)
    bad = [row for row in rows.values() if any(row[column] for column in wrong)]
    for row in bad:
        print(f"\n{row[key]}:", *row["notes"][:5], sep="\n  ")
    print(f"{sum(row[counted[0]] for row in rows.values())} {counted[0]}, {len(bad)} {key}s with findings")
    return 1 if bad else 0
