"""GeoNet ``.V2A``: corrected acceleration, velocity and displacement of three components, mm/s2.

A component is 16 lines of text, 4 of whole numbers, 6 of numbers, then acceleration, velocity and
displacement in columns of 8 characters, ten a line. Line 20 has their counts (fields 4 to 6),
field 6 of line 23 the step in s. Source: GeoNet, Strong Motion Data file formats, volume 2.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from grids.motions.readers.base import (
    FloatArray,
    Reader,
    Record,
    assemble,
    check_samples,
    fixed_width,
    read_text,
)
from grids.sampling import check_step, parse_numbers
from models.errors import InputError

_TEXT, _HEADER, _WIDTH, _A_LINE = 16, 26, 8, 10
LARGEST_COUNT = 1e8
_COMPONENT = re.compile(r"Component\s+(\S+)", re.I)
_PEAK = re.compile(r"Acceleration:\s+peak\s+([-+.\d]+)\s*mm/s/s", re.I)


def _lines_of(count: int) -> int:
    return -(-count // _A_LINE)


def _read_component(lines: list[str], path: Path, number: int) -> tuple[str, float, FloatArray, int]:
    """Name, step, samples and the number of lines used by the component that ``lines`` begin with."""
    where = f"{path.name}: component {number}"
    if len(lines) < _HEADER:
        raise InputError(f"{where}: header has {len(lines)} of {_HEADER} lines: the file is cut short")
    text = "\n".join(lines[:_TEXT])
    name, peak = _COMPONENT.search(text), _PEAK.search(text)
    if name is None or peak is None:
        raise InputError(f"{where}: no line 'Component' or no peak in mm/s/s: it is no GeoNet V2A header")
    where = f"{where} ({name[1]})"
    integers = fixed_width(lines[_TEXT : _TEXT + 4], _WIDTH, where)
    reals = fixed_width(lines[_TEXT + 4 : _HEADER], _WIDTH, where)
    if integers.size != 40 or reals.size != 60:
        raise InputError(f"{where}: header has {integers.size} and {reals.size} numbers, not 40 and 60: damaged")
    if not np.all((integers[33:36] >= 1.0) & (integers[33:36] <= LARGEST_COUNT)):
        raise InputError(f"{where}: header counts {integers[33:36].tolist()} samples: the file is damaged")
    counts = [int(c) for c in integers[33:36]]
    block = lines[_HEADER : _HEADER + _lines_of(counts[0])]
    values = fixed_width(block, _WIDTH, where)
    used = _HEADER + sum(_lines_of(count) for count in counts)
    if values.size != counts[0] or len(lines) < used:
        raise InputError(
            f"{where}: header says {counts[0]} samples, the file has {min(values.size, counts[0])} and "
            f"{len(lines)} of {used} lines: it is cut short or damaged"
        )
    measured, said = float(np.max(np.abs(values))), abs(float(parse_numbers([peak[1]], where)[0]))
    if abs(measured - said) > 0.11 + 1e-4 * said:
        raise InputError(
            f"{where}: header says a peak of {said:g} mm/s2, the samples reach {measured:g}: the file is damaged"
        )
    samples = check_samples(values * 1e-3, where)
    return name[1], check_step(float(reals[25]), where), samples, used


def _read(path: Path, key: str | None, statement: Mapping[str, Any]) -> Record:
    lines = read_text(path)
    components: list[tuple[str, float, FloatArray]] = []
    start = 0
    while any(line.strip() for line in lines[start:]):
        name, step, samples, used = _read_component(lines[start:], path, len(components) + 1)
        components.append((name, step, samples))
        start += used
    few = (f"holds {len(components)} components, such a file has 3: is it cut short?",) if len(components) < 3 else ()
    source = {
        "format": GEONET_V2A.name,
        "files": (path.name,),
        "station": lines[2].strip(),
        "record": lines[0].strip(),
    }
    return assemble(path.stem, components, source, where=path.name, notes=few)


GEONET_V2A = Reader("GeoNet V2A", (".v2a",), _read)
