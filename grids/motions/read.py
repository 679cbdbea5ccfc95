"""From a name in a plan to a motion: find the file, read its record, choose the components."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from grids.motions.base import Motion
from grids.motions.locate import SHIPPED, locate, reader_of
from grids.motions.made import MAKERS, make, parse_made
from grids.motions.readers.base import FloatArray, Record, vertical_sign
from models.errors import InputError, nearest


@np.errstate(over="ignore", invalid="ignore")  # what becomes infinite is refused where samples are checked
def read_motion(
    source: str | Path | Mapping[str, Any],
    *,
    component: str | None = None,
    vertical: bool | None = None,
    near: Path | None = None,
) -> Motion:
    """The motion a source stands for.

    ``source``: a shipped name, a path (looked for beside ``near``, in the current folder, then in the
    data folder), ``"file.npz:key"``, ``{"pulse": {...}}`` or ``{"artificial": {...}}`` (or the same as a
    TOML text, ``'pulse = {...}'``), or ``{"file": ..., ...}`` with what is to be stated about the file
    (``time_step``, ``unit``, ``columns`` ...) instead of a TOML beside it.
    ``component``: the horizontal component; without it the one the file or key stands for, else
    the one with the larger peak. ``vertical``: None takes the vertical if the record has one, True
    demands it, False leaves it out. Raises InputError.
    """
    if isinstance(source, str):
        source = parse_made(source) or source
    if not isinstance(source, str | Path | Mapping):
        raise InputError(
            f"motion is of type {type(source).__name__}: give a name, a path or a table; of arrays make "
            "rocking.Motion(name, time_step, horizontal)"
        )
    if component is not None and not isinstance(component, str):
        raise InputError(f"component is {component!r}: give the name of a horizontal component, as a text")
    if isinstance(source, Mapping):
        if any(kind in source for kind in MAKERS):
            return _with_hashes(make(source, component, vertical))
        if "file" not in source:
            raise InputError(f"motion {dict(source)!r}: give 'file', 'pulse' or 'artificial'")
        statement = {k: v for k, v in source.items() if k != "file"}
        name = str(source["file"])
    else:
        statement, name = {}, str(source)
    path, key = locate(name, near)
    reader = reader_of(path)
    if key is not None and not reader.takes_key:
        raise InputError(f"motion {name!r}: {reader.name} takes no key after a colon: leave {key!r} out")
    unknown = sorted(set(statement) - set(reader.statement_keys))
    if unknown:
        cure = nearest(unknown[0], reader.statement_keys) if reader.statement_keys else "the file states it itself"
        raise InputError(f"motion {name!r}: {unknown[0]!r} cannot be stated for {reader.name}; {cure}")
    return _chosen(reader.read(path, key, statement), path, component, vertical)


def _chosen(record: Record, path: Path, component: str | None, vertical: bool | None) -> Motion:
    horizontals = record.horizontals
    notes = record.notes
    chosen = component if component is not None else record.preferred
    if chosen is None:
        chosen = max(horizontals, key=lambda name: float(np.max(np.abs(horizontals[name]))))
        if len(horizontals) > 1:
            notes = (
                *notes,
                f"component not named: {chosen} has the largest peak of {', '.join(horizontals)}",
            )
    chosen = next((name for name in horizontals if name.lower() == chosen.lower()), chosen)
    if chosen not in horizontals:
        if vertical_sign(chosen):
            raise InputError(
                f"motion {record.name}: component {chosen!r} is vertical: name a horizontal one, "
                f"{', '.join(horizontals)}"
            )
        raise InputError(f"motion {record.name}: has no component {chosen!r}; {nearest(chosen, horizontals)}")
    if vertical and record.vertical is None:
        raise InputError(
            f"motion {record.name}: has no vertical component (found: {', '.join(horizontals)}): "
            "set vertical = false or add its file"
        )
    name = record.name
    if record.preferred is not None and chosen != record.preferred:
        name = f"{name} ({chosen})"
    components = {"horizontal": chosen}
    up: FloatArray | None = None
    if vertical is not False and record.vertical is not None:
        components["vertical"], up = record.vertical
    shipped = {"shipped": True} if path.parent == SHIPPED else {}
    motion = Motion(
        name,
        record.time_step,
        horizontals[chosen],
        up,
        components=components,
        source={**record.source, **shipped},
        notes=notes,
    )
    return _with_hashes(motion)


def _with_hashes(motion: Motion) -> Motion:
    """The motion with the sha256 of its samples (little-endian float64) as read."""
    hashes = {"sha256_horizontal": _sha256(motion.horizontal)}
    if motion.vertical is not None:
        hashes["sha256_vertical"] = _sha256(motion.vertical)
    return replace(motion, source={**motion.source, **hashes})


def _sha256(values: FloatArray) -> str:
    return hashlib.sha256(values.astype("<f8").tobytes()).hexdigest()
