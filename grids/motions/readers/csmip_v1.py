"""CSMIP (California) volume 1, ``.V1``: uncorrected acceleration, one or more channels a file.

A channel is a header, a line "N Accelerogram points at R pts/sec in units of U. Format: (8f9.6)",
the samples in that format, and a line "/& --- End of Data".
Source: California Geological Survey, Strong-Motion Data Format, COSMOS/CSMIP volume 1.
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
    fixed_width,
    read_text,
)
from grids.sampling import check_step
from grids.units import factor_to_si
from models.errors import InputError

_CHANNEL = re.compile(r"^Chan\s+\d+:\s*(\S+)", re.I)
_POINTS = re.compile(
    r"^\s*(\d{1,9})\s+Accel\S*\s+points.*?at\s+(\d+\.?\d*)\s*pts/sec.*?in\s+units\s+of\s+(\S+?)\.?\s+"
    r"Format:\s*\(\s*(\d{1,3})\s*[fF]\s*(\d{1,3})\.\d+\s*\)",
    re.I,
)


def _read(path: Path, key: str | None, statement: Mapping[str, Any]) -> Record:
    lines = read_text(path)
    components: list[tuple[str, float, FloatArray]] = []
    name, announced = "", 0
    for number, line in enumerate(lines):
        if channel := _CHANNEL.match(line):
            name, announced = channel[1], announced + 1
        elif (points := _POINTS.match(line)) is not None:
            where = f"{path.name}: channel {name or len(components) + 1}"
            count, a_line, width = int(points[1]), int(points[4]), int(points[5])
            if a_line == 0 or width == 0:
                raise InputError(f"{where}: header says columns of {width} characters, {a_line} a line: damaged")
            block = lines[number + 1 : number + 1 - (-count // a_line)]
            end = next((i for i, row in enumerate(block) if row.startswith("/&")), len(block))
            values = fixed_width(block[:end], width, where)
            if values.size != count:
                raise InputError(
                    f"{where}: header says {count} samples, the file has {values.size}: it is cut short or damaged"
                )
            rate = float(points[2])
            if rate <= 0.0:
                raise InputError(f"{where}: header says {rate:g} samples per second: the file is damaged")
            samples = check_samples(values * factor_to_si(points[3], "m s-2", where), where)
            components.append((name or str(len(components) + 1), check_step(1.0 / rate, where), samples))
    if not components:
        raise InputError(
            f"{path.name}: no line 'N Accelerogram points at R pts/sec in units of U. Format: ...': "
            "it is no CSMIP volume 1 file"
        )
    if len(components) < announced:
        raise InputError(
            f"{path.name}: {announced} channels, {len(components)} with a line 'N Accelerogram points at R pts/sec': "
            "the file is damaged, fetch it again"
        )
    source = {
        "format": CSMIP_V1.name,
        "files": (path.name,),
        "station": lines[5].strip() if len(lines) > 5 else "",
    }
    return assemble(path.stem, components, source, where=path.name)


CSMIP_V1 = Reader("CSMIP volume 1", (".v1",), _read)
