"""A law in a table as a file: CSV with the columns term, at, value.

Each term has 12 rows: from the reach below zero to zero, then from zero to the reach above it, evenly spaced, in SI.
Zero stands twice, since a law may jump there. Terms of the same variable share its reach; a term that is left out
does nothing. Terms and units: the tables that the model declares (`models.tables`).
"""

from __future__ import annotations

import csv
import math
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from grids.files import read_text
from models.errors import InputError, nearest
from models.tables import KNOTS, SIDES, Tables, row

LAW_FILE = "law.csv"
"""Name of the file beside a specimen that is written."""
COLUMNS = ("term", "at", "value")
EVEN = 1e-6
"""Share of the reach by which a row may be off its even spacing."""


def law_text(parameters: Mapping[str, float], tables: Tables) -> str:
    """The file of a law given by the mechanism's parameters."""
    lines = [",".join(COLUMNS)]
    for term in tables.terms:
        reach = parameters[tables.variable(term).reach]
        below, above = ([parameters[row(term, side, k)] for k in range(KNOTS)] for side in SIDES)
        if any(below) or any(above):
            at = np.linspace(0.0, reach, KNOTS)
            pairs = zip([*-at[::-1], *at], [*below[::-1], *above], strict=True)
            lines += [f"{term},{float(x)!r},{float(value)!r}" for x, value in pairs]
    return "\n".join(lines) + "\n"


def read_law(path: Path, tables: Tables) -> dict[str, float]:
    """The mechanism's parameters from such a file. Raises InputError."""
    entries = list(csv.reader(read_text(path, "law").splitlines()))
    if not entries or tuple(entries[0][:3]) != COLUMNS:
        raise InputError(f"{path.name}: the first line must be {','.join(COLUMNS)}.")
    rows: dict[str, list[tuple[float, float]]] = {}
    for number, entry in enumerate(entries[1:], start=2):
        where = f"{path.name}, line {number}"
        if len(entry) < len(COLUMNS):
            raise InputError(f"{where}: {len(entry)} columns; give {', '.join(COLUMNS)}.")
        if entry[0] not in tables.terms:
            raise InputError(f"{where}: term '{entry[0]}'; {nearest(entry[0], tables.terms)}")
        rows.setdefault(entry[0], []).append((_number(entry[1], where), _number(entry[2], where)))
    found = {name: 0.0 for name, _ in tables.rows} | {v.reach: 1.0 for v in tables.variables.values()}
    reaches: dict[str, float] = {}
    for term, pairs in rows.items():
        name = tables.variable(term).reach
        reach = _reach(pairs, f"{path.name}, {term}")
        if not math.isclose(reaches.setdefault(name, reach), reach, rel_tol=EVEN):
            raise InputError(
                f"{path.name}, {term}: its rows end at {reach:g}, those of another term at {reaches[name]:g}."
            )
        values = [value for _, value in pairs]
        for k in range(KNOTS):
            found[row(term, SIDES[0], k)] = values[KNOTS - 1 - k]
            found[row(term, SIDES[1], k)] = values[KNOTS + k]
    return {**found, **reaches}


def _number(text: str, where: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise InputError(f"{where}: '{text}' is no finite number.")
    return value


def _reach(pairs: list[tuple[float, float]], where: str) -> float:
    at = np.array([x for x, _ in pairs])
    reach = float(at[-1])
    even = np.linspace(0.0, reach, KNOTS)
    if at.size != 2 * KNOTS or reach <= 0.0 or np.any(np.abs(at - [*-even[::-1], *even]) > EVEN * reach):
        raise InputError(
            f"{where}: give {2 * KNOTS} rows, evenly from -{reach:g} to 0 and from 0 to {reach:g}, zero twice."
        )
    return reach
