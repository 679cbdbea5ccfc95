"""``file.npz:key``: arrays of numpy, one component each, the key ending with ``_COMPONENT``.

Keys that share all but the component are one record: its vertical (``_UD``, ``_UP`` ...) is found by
itself. An array has no unit, so step and unit are stated: in a TOML beside the file
(``time_step = "0.005 s"``, ``unit = "1e-4 g"``), or by a table ``file.csv`` beside it with a line per record
(columns ``id``, ``npts``, ``dt_s``, ``H1``, ``H2``, ``PGA_H1_g``, ``PGA_H2_g``, ``PGA_UD_g``). The table
states no unit: arrays are taken in m s-2, and a peak that is not the table's PGA is an error.
"""

from __future__ import annotations

import csv
import math
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from grids.files import Schema, check, parse_toml
from grids.files import read_text as read_utf8
from grids.motions.readers.base import FloatArray, Reader, Record, assemble, check_samples, vertical_sign
from grids.netcdf_file import MORE_BYTES, TIMES_THE_FILE
from grids.sampling import check_step, parse_numbers
from grids.units import STANDARD_GRAVITY, factor_to_si, to_si
from models.errors import InputError, nearest

PGA_TOLERANCE = 0.01
"""Largest relative departure of a peak from the PGA in the table (it has four decimals)."""


class Statement(Schema):
    """What holds for every array of the file."""

    time_step: str | float
    unit: str
    source: str = ""
    licence: str = ""


def split_key(key: str) -> tuple[str, str]:
    """Record and component of a key: ``20160416_0125_KMMH03``, ``NS``."""
    record, _, component = key.rpartition("_")
    return record, component


def keys_of(path: Path) -> list[str]:
    """The names of the arrays."""
    try:
        with zipfile.ZipFile(path) as archive:
            return [name.removesuffix(".npy") for name in archive.namelist()]
    except Exception:  # zipfile does not bound what a damaged directory raises
        raise InputError(f"{path.name}: is no .npz archive: it is cut short or damaged") from None


def is_vertical(key: str) -> bool:
    """Whether a key names a vertical component."""
    return vertical_sign(split_key(key)[1]) != 0


def _chosen(path: Path, key: str | None, keys: list[str]) -> tuple[str, list[str], str | None]:
    """Name of the record, its keys, and the horizontal component that ``key`` stands for."""
    if not key:
        raise InputError(
            f'{path.name}: holds {len(keys)} arrays: name one as "{path.name}:{keys[0] if keys else "key"}"'
        )
    whole = [k for k in keys if split_key(k)[0] == key]
    if key not in keys and whole:
        return key, whole, None
    if key not in keys:
        raise InputError(f"{path.name}: has no key {key!r}; {_nearest_key(key, keys)}")
    record, component = split_key(key)
    together = [k for k in keys if record and split_key(k)[0] == record]
    partner = [k for k in together if is_vertical(k)]
    if is_vertical(key):
        return record, together, None
    if not partner:
        return key, [key], key
    return key, together, component


def _nearest_key(key: str, keys: list[str]) -> str:
    close = nearest(key, keys)
    return close if close.startswith("did") else f"it holds {len(keys)} arrays, for instance {', '.join(keys[:3])}"


def _index_line(path: Path, record: str) -> Mapping[str, str] | None:
    """The line of the table beside the file that describes ``record``, if there is a table."""
    beside = path.with_suffix(".csv")
    if not beside.is_file():
        return None
    try:
        lines = list(csv.DictReader(read_utf8(beside, "the table").splitlines()))
    except csv.Error as error:
        raise InputError(f"{beside.name}: is no table ({error}): fetch it again") from None
    line = next((line for line in lines if line.get("id") == record), None)
    if line is None or not line.get("dt_s"):
        raise InputError(f"{beside.name}: has no line with id {record!r} and dt_s: add it, or a TOML with time_step")
    return line


def _check_index(where: str, line: Mapping[str, str], component: str, values: FloatArray) -> None:
    if line.get("npts") and line["npts"].strip() != str(values.size):
        raise InputError(f"{where}: has {values.size} samples, the table says npts {line['npts']}: damaged")
    role = next((h for h in ("H1", "H2") if line.get(h) == component), "UD")
    stated = line.get(f"PGA_{role}_g")
    if not stated:
        raise InputError(f"{where}: the table has no PGA_{role}_g to show the unit: add a TOML with time_step and unit")
    peak = float(np.max(np.abs(values))) / STANDARD_GRAVITY
    pga = float(parse_numbers([stated], f"{where}: PGA_{role}_g of the table")[0])
    if not abs(peak - pga) <= PGA_TOLERANCE * pga:
        raise InputError(
            f"{where}: peak is {peak:.4g} g as m s-2, the table says {stated} g: "
            "state the unit in a TOML beside the file"
        )


def _load(path: Path, keys: list[str]) -> dict[str, Any]:
    try:
        most = TIMES_THE_FILE * path.stat().st_size + MORE_BYTES
        with np.load(path, allow_pickle=False) as archive:
            sizes = {key: _stated_size(archive.zip, key) for key in keys}
            if sum(sizes.values()) > most:
                raise ValueError(f"its arrays take {sum(sizes.values()):.3g} bytes, far more than a file of its size")
            return {key: archive[key] for key in keys}
    except Exception as error:  # numpy reads a header as Python text: what a damaged one raises has no bounds
        raise InputError(f"{path.name}: cannot be read ({error}): it is cut short or damaged") from None


def _stated_size(archive: zipfile.ZipFile, key: str) -> int:
    """Bytes that an array takes by its own header. ValueError when the archive holds fewer or more."""
    info = archive.getinfo(f"{key}.npy")
    with archive.open(info) as member:
        version = np.lib.format.read_magic(member)
        read = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
        shape, _, dtype = read(member)
        size = math.prod(shape) * dtype.itemsize
        if size != info.file_size - member.tell():
            raise ValueError(f"array {key} has {info.file_size - member.tell()} bytes, its header says {size}")
    return size


def _read(path: Path, key: str | None, statement: Mapping[str, Any]) -> Record:
    name, keys, preferred = _chosen(path, key, keys_of(path))
    arrays = _load(path, keys)
    beside = path.with_suffix(".toml")
    stated: Statement | None = None
    line: Mapping[str, str] | None = None
    if statement or beside.is_file():
        try:
            stated = check(Statement, dict(statement) or parse_toml(read_utf8(beside, "the description")))
        except InputError as error:
            where = f"what is stated of {path.name}" if statement else beside.name
            raise InputError(f"{where}: {error}") from None
    else:
        line = _index_line(path, split_key(keys[0])[0])
    if stated is not None:
        factor = factor_to_si(stated.unit, "m s-2", path.name)
        step = check_step(to_si(stated.time_step, "s", f"{path.name}: time_step"), path.name)
    elif line is not None:
        factor = 1.0
        step = check_step(to_si(f"{line['dt_s']} s", "s", f"{path.name}: dt_s"), path.name)
    else:
        raise InputError(
            f"{path.name}: has no unit and no time step: write {beside.name} with time_step and unit, "
            'for instance time_step = "0.005 s" and unit = "g"'
        )
    components: list[tuple[str, float, FloatArray]] = []
    for one, array in arrays.items():
        where, component = f"{path.name}:{one}", split_key(one)[1] if len(keys) > 1 else one
        raw = np.asarray(array)
        values = check_samples(raw * factor if raw.dtype.kind in "fiu" else raw, where)
        if line is not None:
            _check_index(where, line, split_key(one)[1], values)
        components.append((component, step, values))
    facts = {} if stated is None else {k: v for k in ("source", "licence") if (v := getattr(stated, k))}
    source = {"format": NPZ.name, "files": (path.name,), "record": split_key(keys[0])[0] or name, **facts}
    return assemble(name, components, source, where=f"{path.name}:{key}", preferred=preferred)


NPZ = Reader("npz with a key", (".npz",), _read, takes_key=True, statement_keys=tuple(Statement.model_fields))
