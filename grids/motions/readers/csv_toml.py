"""CSV with a TOML beside it, see `grids.columns`; channels named up, down, z ... are vertical.

In a table that names channels ``base_acceleration_x`` or ``acceleration_north``, only these are the
motion (a recording); otherwise every channel is.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from grids.columns import Layout, read_columns, read_layout
from grids.motions.readers.base import Reader, Record, assemble, check_samples, component_name
from grids.units import factor_to_si
from models.errors import InputError


def _read(path: Path, key: str | None, statement: Mapping[str, Any]) -> Record:
    layout = read_layout(path, statement)
    if layout.between_samples == "band_limited":
        where = path.with_suffix(".toml").name
        raise InputError(f"{where}: a motion is linear between samples; leave between_samples = 'band_limited' out.")
    named = {name: column for name, column in layout.columns.items() if component_name(name)}
    layout = layout.model_copy(update={"columns": named or layout.columns})
    channels = read_columns(path, layout, lambda _, unit, where: factor_to_si(unit, "m s-2", where))
    components = [
        (component_name(name) or name, channels.time_step, check_samples(values, f"{path.name}: {name}"))
        for name, values in channels.values.items()
    ]
    turned = [component_name(name) or name for name, column in layout.columns.items() if column.sign < 0]
    notes = (f"sign of {', '.join(turned)} turned as stated",) if turned else ()
    stated = {k: v for k in ("title", "source", "licence") if (v := getattr(layout, k))}
    source = {"format": CSV.name, "files": (path.name,), **stated}
    return assemble(path.stem, components, source, where=path.name, notes=notes)


CSV = Reader("CSV with a TOML beside it", (".csv",), _read, statement_keys=tuple(Layout.model_fields))
