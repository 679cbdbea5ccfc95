"""Outcomes of shake-table runs: a table that says which motion overturned the specimen.

``outcomes.toml``:

    table = "tests.csv"                                 # beside this file or in the data folder; a line a run
    delimiter = ","                                     # of its cells; this is the default
    run = "test"                                        # column that names a run
    motion = "table_acceleration.npz:test_{test:0>3}"   # a source of motion, columns in braces
    overturned = "rock_1_overturned"                    # column of 0 and 1, yes and no; absent: to be predicted
    group = "ground_motion"                             # column; left out together in cross-validation
    [statement]                                         # what the motion's file does not say itself
    time_step = "0.005 s"
    unit = "1e-4 g"

Without ``group`` every run is a group of its own.
"""

from __future__ import annotations

import csv
import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from string import Formatter
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from grids.columns import DELIMITERS, another_delimiter
from grids.data_folder import data_folder
from grids.files import Schema, check, parse_toml, read_text
from grids.motions import Motion, read_motion
from models.errors import InputError, nearest

YES, NO = ("1", "yes", "y", "true", "overturned"), ("0", "no", "n", "false", "standing")
LAYOUT = re.compile(r"(?:[^{}]?[<>^])?[0-9]{0,2}")
"""Fill, alignment and width of a cell in the name of a motion."""


class OutcomeFile(Schema):
    table: str
    delimiter: str = Field(default=",", min_length=1, max_length=1)
    run: str
    motion: str
    overturned: str | None = None
    group: str | None = None
    component: str | None = None
    statement: dict[str, Any] = Field(default_factory=dict)


@dataclass(frozen=True)
class Outcomes:
    """Runs (n,) by name: the motion of each, its group, and whether it overturned (None: not known).

    ``column``: the one that says so, to speak of it.
    """

    name: str
    runs: tuple[str, ...]
    motions: tuple[Motion, ...]
    groups: tuple[str, ...]
    overturned: NDArray[np.bool_] | None
    column: str = "overturned"

    @property
    def size(self) -> int:
        return len(self.runs)


def read_outcomes(path: str | Path) -> Outcomes:
    """The runs that a TOML describes, with their motions, vertical components where there are any.

    Raises InputError with file, line, value and cure.
    """
    path = Path(path)
    try:
        file = check(OutcomeFile, parse_toml(read_text(path, "description of outcomes")))
    except InputError as error:
        raise InputError(f"{path.name}: {error}") from None
    folder = path.resolve().parent
    columns, numbered = _lines(_beside(folder, file.table), file.delimiter)
    lines = list(numbered.values())
    for column in (file.run, file.overturned, file.group):
        if column is not None and column not in columns:
            raise InputError(f"{path.name}: {file.table} has no column {column!r}; {nearest(column, columns)}")
    runs = _filled(numbered, file.run, file.table)
    if twice := [run for run, count in Counter(runs).items() if count > 1]:
        raise InputError(f"{file.table}: run {twice[0]!r} stands there twice in column {file.run!r}; rename one")
    flags = None if file.overturned is None else np.array([_flag(line, file) for line in lines])
    groups = runs if file.group is None else _filled(numbered, file.group, file.table)
    motions = tuple(_motion(file, line, folder, run) for line, run in zip(lines, runs, strict=True))
    return Outcomes(path.stem, runs, motions, groups, flags, file.overturned or "overturned")


def _beside(folder: Path, table: str) -> Path:
    """Beside the description, else in the data folder."""
    data = data_folder()
    if not (folder / table).is_file() and data is not None and (data / table).is_file():
        return data / table
    return folder / table


def _lines(path: Path, delimiter: str) -> tuple[Sequence[str], Mapping[int, Mapping[str, str]]]:
    """The names of the columns, and the rows by the number of their line."""
    text = read_text(path, "table of outcomes")
    try:
        reader = csv.DictReader(text.splitlines(), restkey="", strict=True, delimiter=delimiter)
        columns = reader.fieldnames or ()
        if other := another_delimiter(columns, delimiter, DELIMITERS):
            raise InputError(f"{path.name}: its header is one cell by the delimiter {delimiter!r}; {other}")
        _check_header(path, columns)
        lines = {}
        for line in reader:
            lines[reader.line_num] = line
    except csv.Error as error:
        raise InputError(f"{path.name}: is no table ({error}); save it as CSV with one line of names") from None
    if not lines:
        raise InputError(f"{path.name}: has no line below its header; give a line a run")
    for number, line in lines.items():
        if "" in line or None in line.values():
            raise InputError(f"{path.name}: line {number} has not as many cells as the header; complete it")
    return columns, lines


def _check_header(path: Path, columns: Sequence[str]) -> None:
    for number, column in enumerate(columns, 1):
        if not column.strip():
            raise InputError(
                f"{path.name}: column {number} has no name; give it one in the header, or save the table without its "
                "index (pandas: to_csv(index=False))"
            )
    if twice := [column for column, count in Counter(columns).items() if count > 1]:
        raise InputError(f"{path.name}: two columns are called {twice[0]!r}; rename one")


def _filled(lines: Mapping[int, Mapping[str, str]], column: str, table: str) -> tuple[str, ...]:
    """The cells of a column, none of them empty."""
    cells = {number: line[column].strip() for number, line in lines.items()}
    if empty := [number for number, cell in cells.items() if not cell]:
        raise InputError(f"{table}: line {empty[0]} has an empty cell in column {column!r}; fill it in")
    return tuple(cells.values())


def _flag(line: Mapping[str, str], file: OutcomeFile) -> bool:
    word = line[file.overturned or ""].strip().lower()
    if word not in (*YES, *NO):
        raise InputError(f"{file.table}: run {line[file.run]!r} has {word!r} in {file.overturned}; write 1 or 0")
    return word in YES


def _completed(template: str, line: Mapping[str, str], run: str) -> Iterator[str]:
    """The parts of a template with the cells of ``line`` in the place of ``{column}`` or ``{column:0>3}``."""
    try:
        parts = list(Formatter().parse(template))
    except ValueError as error:
        raise InputError(f"motion = {template!r} is no template ({error}); write columns as {{name}}") from None
    if all(column is None for _, column, _, _ in parts):
        raise InputError(
            f"motion = {template!r} has no column in braces, so that all runs would have one motion; write the "
            "column that tells them apart, {name}"
        )
    for text, column, layout, conversion in parts:
        yield text
        if column is None:
            continue
        if column not in line:
            raise InputError(f"motion = {template!r} names {{{column}}}, which is no column; {nearest(column, line)}")
        if conversion or not LAYOUT.fullmatch(layout or ""):
            raise InputError(f"motion = {template!r}: {layout or conversion!r} is no layout; write {{{column}:0>3}}")
        if not (cell := line[column].strip()):
            raise InputError(f"run {run!r} has an empty cell in column {column!r}, which names its motion; fill it in")
        yield format(cell, layout or "")


def _motion(file: OutcomeFile, line: Mapping[str, str], folder: Path, run: str) -> Motion:
    source = "".join(_completed(file.motion, line, run))
    given = {"file": source, **file.statement} if file.statement else source
    try:
        return read_motion(given, component=file.component, near=folder)
    except InputError as error:
        raise InputError(f"run {run!r}: {error}") from None
