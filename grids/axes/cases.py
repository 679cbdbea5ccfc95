"""Listed cases, each setting several names at once: points, not a product.

``{ cases = [ { label = "A", width = "0.3 m", mass = 500 }, ... ] }`` or ``{ cases = "walls.csv" }``,
whose header names the columns, with a unit in brackets where it is not SI: ``label, width [mm]``.
"""

from __future__ import annotations

import csv
import io
from collections import Counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from grids.axes.base import Axis, AxisKind, Request
from grids.columns import DELIMITERS, another_delimiter
from grids.files import read_text
from grids.targets import MOTION
from grids.units import factor_to_si
from models.errors import InputError

LABEL = "label"


def _read(request: Request) -> Axis:
    entry = request.table["cases"]
    if isinstance(entry, str):
        rows = _from_csv(request, entry)
    elif isinstance(entry, list) and all(isinstance(row, dict) for row in entry):
        rows = [request.targets.flatten(row) for row in entry]
    else:
        raise InputError(f"{request.where}: cases = {entry!r}; give a list of tables or the name of a CSV file.")
    if not rows or not set(rows[0]) - {LABEL}:
        raise InputError(f"{request.where}: no cases are listed; give at least one with at least one value.")
    names = [name for name in rows[0] if name != LABEL]
    for number, row in enumerate(rows, 1):
        if set(row) != set(rows[0]):
            odd = sorted(set(row) ^ set(rows[0]))[0]
            raise InputError(
                f"{request.where}: case {number} and case 1 differ in '{odd}'; give each case the same names."
            )
    labels = np.empty(len(rows), dtype=object)
    labels[:] = [str(row.get(LABEL, number)) for number, row in enumerate(rows, 1)]
    label, times = Counter(labels).most_common(1)[0]
    if times > 1:
        raise InputError(f"{request.where}: the label '{label}' is given twice; give each case its own.")
    points = {name: _column(request, name, rows, labels) for name in names}
    return Axis(request.own_name(), labels, "1", "case", points)


def _column(request: Request, name: str, rows: list[dict[str, Any]], labels: NDArray[Any]) -> NDArray[Any]:
    places = [f"{request.where} '{label}' {name}" for label in labels]
    if name != MOTION:
        target = request.targets.find(name, places[0])
        if not target.words:
            pairs = zip(rows, places, strict=True)
            return np.array([target.number(row[name], place) for row, place in pairs])
    words = np.empty(len(rows), dtype=object)
    words[:] = [
        row[name] if name == MOTION else target.word(row[name], place) for row, place in zip(rows, places, strict=True)
    ]
    return words


def _from_csv(request: Request, file: str) -> list[dict[str, Any]]:
    text = read_text(request.folder / file, f"{request.where}: the list of cases")
    reader = csv.reader(io.StringIO(text), skipinitialspace=True)
    lines = [(reader.line_num, cells) for cells in reader if cells]
    if not lines:
        raise InputError(f"{request.where}: {file} is empty; give a header and one line for each case.")
    if another_delimiter(lines[0][1], ",", DELIMITERS):
        raise InputError(f"{request.where}: the header of {file} is one cell; part its cells by commas.")
    columns = [_heading(request, heading, file) for heading in lines[0][1]]
    if len({name for name, _ in columns}) < len(columns):
        raise InputError(f"{request.where}: {file} has two columns of one name; leave one out.")
    rows = []
    for number, cells in lines[1:]:
        if len(cells) != len(columns):
            raise InputError(
                f"{request.where}: line {number} of {file} has {len(cells)} fields, the header "
                f"{len(columns)}; correct that line."
            )
        pairs = zip(columns, cells, strict=True)
        rows.append({name: _cell(name, text.strip(), factor) for (name, factor), text in pairs})
    return rows


def _heading(request: Request, heading: str, file: str) -> tuple[str, float | None]:
    name, bracket, unit = heading.strip().partition("[")
    name = name.strip()
    if not bracket:
        return name, None
    where = f"{request.where}: column '{heading.strip()}' of {file}"
    return name, factor_to_si(unit.rstrip("] "), request.targets.find(name, where).unit, where)


def _cell(name: str, text: str, factor: float | None) -> object:
    if name in (LABEL, MOTION):
        return text
    try:
        return float(text) * (1.0 if factor is None else factor)
    except ValueError:
        return text


KIND = AxisKind("cases", (), _read)
