"""Recordings in CSV, with a TOML beside them that maps columns to channels (see `grids.columns`).

time = { column = "t", unit = "ms" }          # or time_step = "0.005 s"
[columns]
base_acceleration_x = { column = "acc table", unit = "g" }
rotation_1 = { column = "inclinometer", unit = "mrad", sign = -1 }
level_acceleration_x_0 = { column = "slab", unit = "g" }      # ends in the level's number, 0 above the bearings
lvdt_left = { column = "W3", unit = "mm" }    # any other name has a table that says what it measures
[channels.lvdt_left]
quantity = "displacement"                     # ... (see `grids.recordings.placed`)
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np

from grids.columns import Layout, read_columns, read_layout
from grids.recordings.base import CHANNELS, FloatArray, Raw, unknown_channel
from grids.recordings.levels import BY_LEVEL, numbered, stem
from grids.recordings.placed import read_places
from grids.units import factor_to_si
from models.errors import InputError, nearest

SUFFIXES = (".csv", ".txt")


def read(path: Path) -> Raw:
    """The channels of a CSV file in SI; raises InputError."""
    layout = read_layout(path, {})
    places = read_places(layout.channels, CHANNELS)
    where = path.with_suffix(".toml").name
    if lost := [name for name in places if name not in layout.columns]:
        raise InputError(f"{where}: [channels.{lost[0]}] has no column; {nearest(lost[0], layout.columns)}")
    for name in layout.columns:
        if name in places:
            continue
        if stem(name) not in CHANNELS or (stem(name) in BY_LEVEL) != (stem(name) != name):
            cure = (
                f"'{name}' is recorded level by level; name it {name}_0, {name}_1 ..."
                if name in BY_LEVEL
                else unknown_channel(name)
            )
            raise InputError(f"{where}: [columns] {cure}")

    def factor(name: str, unit: str, at: str) -> float:
        return factor_to_si(unit, places[name].unit if name in places else CHANNELS[stem(name)].unit, at)

    table = read_columns(path, layout, factor)
    channels: dict[str, FloatArray] = {n: v for n, v in table.values.items() if stem(n) == n}
    levels: tuple[str, ...] = ()
    for channel in BY_LEVEL:
        members = sorted((int(n[len(channel) + 1 :]), n) for n in table.values if stem(n) == channel)
        if not members:
            continue
        found = numbered([str(level) for level, _ in members])
        if levels and found != levels:
            raise InputError(
                f"{channel} has levels {', '.join(found)}, {BY_LEVEL[0]} {', '.join(levels)}; map the same ones."
            )
        levels = found
        channels[channel] = np.stack([table.values[name] for _, name in members])
    signs = [name for name, column in layout.columns.items() if column.sign == -1]
    notes = (f"sign turned as stated: {', '.join(signs)}",) if signs else ()
    source = {k: getattr(layout, k) for k in ("title", "source", "licence") if getattr(layout, k)}
    smooth = layout.between_samples != "linear"
    twice = tuple(_named_twice(layout, table.values))
    return Raw(table.time_step, table.start, channels, levels, notes, source, places, smooth, twice)


def _named_twice(layout: Layout, values: Mapping[str, FloatArray]) -> Iterator[str]:
    """Channels that are one column in two units or signs; in one of both they hold the same samples."""
    seen: dict[str | int, str] = {}
    for name, column in layout.columns.items():
        first = seen.setdefault(column.column, name)
        if np.ptp(values[name]) and not np.array_equal(values[name], values[first], equal_nan=True):
            yield f"{name} and {first} are one column, {column.column!r}, in two units or signs: is it named twice?"
