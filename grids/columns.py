"""Text tables with a TOML beside them that states columns, units, signs and sampling.

``record.csv`` and ``record.toml``:

    time_step = "0.005 s"                  # or: time = { column = "t", unit = "s" }
    delimiter = ","                        # default; " " for any white space
    decimal = "."                          # default; "," where the logger writes 0,25
    skip = 0                               # lines before the header
    between_samples = "linear"             # of a simulated recording (see `grids.recordings.base.Recording`)
    header = true                          # one line with the columns' names; false: columns by number
    [columns]
    base_acceleration_x = { column = "acc_x", unit = "g", sign = -1 }
    base_acceleration_z = { column = 3, unit = "cm/s2" }       # number, from 1

A cell that is empty or says ``nan``, ``#N/A``, ``-`` and the like (`MISSING`) is a sample without a value.
"""

from __future__ import annotations

import csv
import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
from pydantic import Field

from grids.files import Schema, check, parse_toml, read_text
from grids.sampling import FloatArray, check_step, uniform_step
from grids.units import factor_to_si, to_si
from models.errors import InputError, nearest

MISSING = frozenset({"", "nan", "#n/a", "n/a", "#na", "na", "null", "none", "-", "--", "---"})
"""What loggers and spreadsheets write, in any case, where nothing was measured."""


DELIMITERS = ";\t,"
"""What parts the cells of tables, beside white space."""


class Column(Schema):
    """Where a channel stands in the table, in which unit, and whether its sign is turned."""

    column: str | int
    unit: str
    sign: Literal[1, -1] = 1


class Layout(Schema):
    """What the TOML beside a table states; exactly one of ``time_step`` and ``time``.

    ``channels``: what columns of a recording measure (see `grids.recordings.placed`); ``between_samples``: how its base
    moves between them, "band_limited" where nothing is said.
    """

    columns: dict[str, Column] = Field(min_length=1)
    channels: dict[str, dict[str, Any]] = Field(default_factory=dict)
    time_step: str | float | None = None
    time: Column | None = None
    delimiter: str = Field(default=",", min_length=1, max_length=1)
    decimal: Literal[".", ","] = "."
    skip: int = Field(default=0, ge=0)
    header: bool = True
    between_samples: Literal["linear", "band_limited"] | None = None
    title: str = ""
    source: str = ""
    licence: str = ""


@dataclass(frozen=True)
class Channels:
    """Channels (n,) in SI by name, at ``time_step`` (s) from ``start`` (s)."""

    time_step: float
    start: float
    values: Mapping[str, FloatArray]


def read_layout(path: Path, statement: Mapping[str, Any]) -> Layout:
    """What ``statement`` says about the table at ``path``, or the TOML beside it where that is empty."""
    beside = path.with_suffix(".toml")
    where = path.name if statement else beside.name
    try:
        table = dict(statement) or parse_toml(read_text(beside, "the description of the columns"))
        layout = check(Layout, table)
    except InputError as error:
        raise InputError(f"{where}: {error}") from None
    if (layout.time_step is None) == (layout.time is None):
        held = "neither is given" if layout.time is None else "both are given"
        raise InputError(f"{where}: give exactly one of time_step and time; {held}")
    if layout.decimal == layout.delimiter:
        raise InputError(
            f"{where}: decimal and delimiter are both ','; state the delimiter of the columns, ';' for instance."
        )
    return layout


def read_columns(path: Path, layout: Layout, factor: Callable[[str, str, str], float]) -> Channels:
    """The channels of a table, as ``layout`` states them, nan where a cell holds no value; raises InputError.

    ``factor(channel, unit, where)`` gives SI units per unit.
    """
    header, rows = _rows(path, layout)
    values = {
        name: _values(path, name, column, header, rows, layout)
        * (column.sign * factor(name, column.unit, f"{path.name}: {name}"))
        for name, column in layout.columns.items()
    }
    if layout.time is None:
        where = f"{path.with_suffix('.toml').name}: time_step"
        return Channels(check_step(to_si(layout.time_step, "s", where), path.name), 0.0, values)
    times = _values(path, "time", layout.time, header, rows, layout)
    if np.isnan(times).any():
        line = rows[int(np.flatnonzero(np.isnan(times))[0])][0]
        raise InputError(f"{path.name}: line {line} has no time; complete it, or state time_step instead of time.")
    times = times * factor_to_si(layout.time.unit, "s", f"{path.name}: time")
    cure = "resample to one step, or state time_step instead of time where the times are only rounded"
    return Channels(uniform_step(times, path.name, cure), float(times[0]), values)


def _rows(path: Path, layout: Layout) -> tuple[list[str], list[tuple[int, list[str]]]]:
    """The names of the columns (empty without a header), and the rows with their line numbers."""
    lines = read_text(path, "the table").splitlines()
    numbered = [(i, line) for i, line in enumerate(lines, 1) if i > layout.skip and line.strip()]
    if layout.delimiter.isspace() and layout.delimiter != "\t":
        split = [line.split() for _, line in numbered]
    else:
        split = _split(path, [line for _, line in numbered], layout.delimiter)
    rows = [(i, [cell.strip() for cell in cells]) for (i, _), cells in zip(numbered, split, strict=True)]
    while rows and not any(rows[-1][1]):
        rows.pop()
    if not rows:
        after = f" after the {layout.skip} that are skipped" if layout.skip else ""
        raise InputError(f"{path.name}: holds no lines of numbers{after}; was it written to its end?")
    line, cells = rows[len(rows) // 2]  # neither of the lines above the table nor one below it
    if other := another_delimiter(cells, layout.delimiter, f"{DELIMITERS} ".replace(layout.decimal, "")):
        raise InputError(f"{path.name}: line {line} is one cell by the delimiter {layout.delimiter!r}; {other}.")
    if layout.delimiter.isspace() and layout.delimiter != "\t":
        _check_cells(path, rows)
    if not layout.header:
        return [], rows
    line, names = rows[0]
    by_name = {column.column for column in (*layout.columns.values(), *([layout.time] if layout.time else []))}
    if all(_number(name, layout.decimal) is not None for name in names) and not by_name & set(names):
        raise InputError(
            f"{path.name}: line {line} holds numbers where the names of the columns are expected; state "
            "header = false (columns by number), or skip the lines above the names"
        )
    if len(rows) > 1 and all(_number(cell, mark) is None for cell in rows[1][1] for mark in ".,"):
        raise InputError(
            f"{path.name}: line {rows[1][0]} holds no number ({', '.join(rows[1][1])}); if it states units, state them "
            f"in [columns], and skip = {rows[1][0]} with header = false (columns by number)"
        )
    for number, cells in rows[1:]:
        if any(cells[len(names) :]):
            raise InputError(
                f"{path.name}: line {number} has {len(cells)} cells, the header {len(names)}; {_cure(layout)}."
            )
    return names, rows[1:]


def another_delimiter(cells: Sequence[str], stated: str, among: str) -> str:
    """What to state where a line is one cell by the ``stated`` delimiter and several by another; else nothing."""
    found = next((mark for mark in among if mark != stated and len(cells) == 1 and mark in cells[0].strip()), None)
    return "" if found is None else f"state delimiter = {json.dumps(found)}"


def _check_cells(path: Path, rows: list[tuple[int, list[str]]]) -> None:
    """Between white space an empty cell is not seen: the cells after it would move to the left."""
    first, cells = rows[0]
    for line, own in rows:
        if len(own) != len(cells):
            raise InputError(
                f"{path.name}: line {line} has {len(own)} cells, line {first} {len(cells)}; write nan where "
                "nothing was measured, or name the delimiter"
            )


def _cure(layout: Layout) -> str:
    """Of rows with more cells than there are columns: a decimal comma that delimits splits every number in two."""
    if layout.delimiter == "," and layout.decimal == ".":
        return "state decimal = ',' and the delimiter if its numbers have a decimal comma, else complete the header"
    return "name every column in the header, or correct the delimiter"


def _split(path: Path, lines: list[str], delimiter: str) -> list[list[str]]:
    """The cells of each line; a quote that is left open would take the lines after it into one cell."""
    try:
        split = list(csv.reader(lines, delimiter=delimiter, strict=True))
    except csv.Error as error:
        raise InputError(f"{path.name}: is no table ({error}); is a quote left open?") from None
    if len(split) != len(lines):
        raise InputError(f"{path.name}: a quote is left open or holds a line break; every row needs a line of its own.")
    return split


def _values(
    path: Path,
    name: str,
    column: Column,
    header: list[str],
    rows: list[tuple[int, list[str]]],
    layout: Layout,
) -> FloatArray:
    if isinstance(column.column, int):
        index = column.column - 1
        if index < 0:
            raise InputError(f"{path.name}: column {column.column} of {name}: columns are numbered from 1")
    elif header.count(column.column) > 1:
        raise InputError(
            f"{path.name}: has {header.count(column.column)} columns {column.column!r}, {name} wants one; "
            "name it by its number, from 1"
        )
    elif column.column in header:
        index = header.index(column.column)
    else:
        cure = nearest(column.column, header) if layout.header else "name it by its number, from 1"
        raise InputError(f"{path.name}: has no column {column.column!r} for {name}; {cure}")
    found = np.empty(len(rows))
    for i, (line, cells) in enumerate(rows):
        if index >= len(cells):
            raise InputError(
                f"{path.name}: line {line} has {len(cells)} column(s), {name} wants number {index + 1}: "
                "the file is damaged or the delimiter is another"
            )
        number = _number(cells[index], layout.decimal)
        if number is None:
            other = {".": ",", ",": "."}[layout.decimal]
            cure = (
                f'state decimal = "{other}" if the file writes its numbers so'
                if _number(cells[index], other) is not None
                else "correct it, or leave the cell empty where nothing was measured"
            )
            raise InputError(f"{path.name}: line {line}: {name} is {cells[index]!r}, not a number; {cure}.")
        found[i] = number
    return found


def _number(cell: str, decimal: str) -> float | None:
    """The number in a cell, nan where it holds no value, None where it is no number."""
    if cell.lower() in MISSING:
        return float("nan")
    if decimal == "," and "." in cell:
        return None
    try:
        return float(cell.replace(decimal, ".")) if "_" not in cell else None
    except ValueError:
        return None
