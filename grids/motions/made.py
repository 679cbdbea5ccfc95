"""Motions that are made, not read: a table of a plan, or the same words as a source of their own.

pulse = { shape = "sine", amplitude = "0.3 g", frequency = "2 Hz" }
artificial = { spectrum = "EC8", type = 1, ground = "B", pga = "0.2 g", seed = [1, 2, 3] }
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import Any

from grids.files import parse_toml
from grids.motions.artificial import make_artificial, one_by_one
from grids.motions.base import Motion
from grids.motions.pulses import make_pulse
from models.errors import InputError

MAKERS: Mapping[str, Callable[[Mapping[str, Any]], Motion]] = {"pulse": make_pulse, "artificial": make_artificial}


def parse_made(source: str) -> dict[str, Any] | None:
    """The table of ``pulse = {...}`` or ``artificial = {...}``; None for any other source."""
    if not re.match(rf"\s*({'|'.join(MAKERS)})\s*=", source):
        return None
    try:
        return parse_toml(source)
    except InputError as error:
        raise InputError(f"motion: {error}") from None


def each(source: Mapping[str, Any]) -> list[dict[str, Any]]:
    """One source for each motion: several seeds are several."""
    table = source.get("artificial")
    if not isinstance(table, Mapping):
        return [dict(source)]
    return [{**source, "artificial": one} for one in one_by_one(table)]


def make(source: Mapping[str, Any], component: str | None, vertical: bool | None) -> Motion:
    """The motion of a source that holds one of `MAKERS`. Raises InputError."""
    kind = next(name for name in MAKERS if name in source)
    if len(source) > 1 or not isinstance(source[kind], Mapping):
        raise InputError(f"motion: give {kind} = {{...}} as a table, and nothing beside it")
    motion = MAKERS[kind](source[kind])
    named = f"motion {motion.name}: {'an artificial motion' if kind == 'artificial' else 'a pulse'}"
    if component is not None:
        raise InputError(f"{named} has no component {component!r}: leave component out")
    if vertical:
        raise InputError(f"{named} has no vertical component: leave vertical out")
    return motion
