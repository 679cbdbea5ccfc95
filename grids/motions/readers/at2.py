"""PEER ``.AT2``: one component a file, in g; the other components of the record lie beside it.

Four header lines (the second ends with the component, the fourth has NPTS and DT), then samples.
Files of one record share the RSN number, or the name without its component, and the second line.
Source: PEER Ground Motion Database, file format of NGA-West2 time series.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from grids.motions.readers.base import (
    FloatArray,
    Reader,
    Record,
    assemble,
    check_samples,
    read_text,
    vertical_sign,
)
from grids.sampling import check_step, parse_numbers
from grids.units import STANDARD_GRAVITY
from models.errors import InputError

_NUMBER = r"([-+]?(?:\d+\.?\d*|\.\d+)(?:[eEdD][-+]?\d+)?)"
_NPTS = (re.compile(r"NPTS\s*=\s*(\d{1,9})\b", re.I), re.compile(rf"^\s*(\d{{1,9}})\s+{_NUMBER}\s*,?\s*NPTS", re.I))
_DT = (re.compile(rf"DT\s*=\s*{_NUMBER}", re.I), re.compile(rf"^\s*\d+\s+{_NUMBER}\s*,?\s*NPTS", re.I))
_RSN = re.compile(r"RSN\d+_", re.I)
_NAMED_VERTICAL = re.compile(r"(UP|DWN|DN|VER|VRT|UD|-V|-Z)$", re.I)


def _heading(line: str) -> tuple[str, str]:
    """Event and station, and the component, of the second line."""
    event, _, component = line.strip().rpartition(",")
    return event.strip(), component.strip()


def _read_one(path: Path) -> tuple[str, float, FloatArray]:
    lines = read_text(path)
    if len(lines) < 5:
        raise InputError(f"{path.name}: has {len(lines)} lines, an AT2 file has 4 before its samples: fetch it again")
    quantity = lines[2].upper()
    if "ACCELERATION" not in quantity:
        raise InputError(f"{path.name}: line 3 reads {lines[2].strip()!r}, not acceleration: give the .AT2 file")
    if not re.search(r"UNITS OF G\b", quantity):
        raise InputError(f"{path.name}: line 3 does not say 'UNITS OF G' ({lines[2].strip()!r}): state the unit there")
    count = next((m for pattern in _NPTS if (m := pattern.search(lines[3]))), None)
    step = next((m for pattern in _DT if (m := pattern.search(lines[3]))), None)
    if count is None or step is None:
        raise InputError(f"{path.name}: line 4 has no NPTS and DT ({lines[3].strip()!r}): the header is damaged")
    values = parse_numbers(" ".join(lines[4:]).split(), path.name)
    if values.size != int(count[1]):
        raise InputError(f"{path.name}: NPTS says {count[1]} samples, the file has {values.size}: cut short or damaged")
    component = _heading(lines[1])[1]
    if not component:
        raise InputError(f"{path.name}: line 2 does not end with the component: write it after the last comma")
    samples = check_samples(values * STANDARD_GRAVITY, path.name)
    return component, check_step(float(re.sub("[dD]", "e", step[1])), path.name), samples


def heading_of(path: Path) -> tuple[str, str]:
    """Event with station, and component, of a file; empty where the file has no such line."""
    try:
        with path.open(encoding="latin-1") as file:
            file.readline()
            return _heading(file.readline())
    except OSError:
        return "", ""


def is_vertical(path: Path) -> bool:
    """Whether a file holds the vertical component, by its second line; where that is lost by its name."""
    component = heading_of(path)[1]
    return vertical_sign(component) != 0 if component else _NAMED_VERTICAL.search(path.stem) is not None


def _siblings(path: Path) -> list[Path]:
    """The files of the record that ``path`` belongs to, itself included, by name.

    One whose heading is lost belongs to it by its number alone: it is damaged, which is for the caller to say.
    """
    event, component = heading_of(path)
    number = _RSN.match(path.name)
    if number:
        prefix = number[0]
    elif component and path.stem.upper().endswith(component.upper()):
        prefix = path.stem[: -len(component)]
    else:
        prefix = ""
    beside = (p for p in path.parent.iterdir() if p.suffix.lower() == ".at2")
    named = [p for p in beside if p.name.upper().startswith(prefix.upper())] if event else []
    headings = {p: heading_of(p) for p in named}
    found = [p for p, (other, end) in headings.items() if other == event or (number and not (other and end))]
    return sorted({path, *found})


def _read(path: Path, key: str | None, statement: Mapping[str, Any]) -> Record:
    components, notes = {path: _read_one(path)}, []
    for file in _siblings(path):
        try:
            components[file] = _read_one(file)
        except InputError as error:
            if is_vertical(file):  # left out, it would change what acts on the wall
                raise
            notes.append(f"left out, another component of the record: {error}")
    own = components[path][0]
    files = sorted(components)
    source = {"format": AT2.name, "files": tuple(f.name for f in files), "record": heading_of(path)[0]}
    return assemble(
        path.stem,
        [components[file] for file in files],
        source,
        where=path.name,
        notes=tuple(notes),
        preferred=None if vertical_sign(own) else own,
    )


AT2 = Reader("PEER AT2", (".at2",), _read)
