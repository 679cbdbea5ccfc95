"""Channels that say what they measure and where: a quantity of a body at a position and in a direction.

[channels.lvdt_left]              # in a specimen, in the TOML beside a CSV; attributes of a variable in netCDF
quantity = "displacement"         # or velocity, acceleration, rotation, angular_velocity, uplift, compression, force
body = 1                          # the lower body, the only one, or the slab above bearings; default; 2 the next above
                                  # it. Of uplift and compression also base_layer, top_layer: the joint under 1, under 2
position_x = "-200 mm"            # from the middle of the body's underside, turning with it; default 0
position_z = 0
direction = "z"                   # x (default), z; across, along: the body's own
relative_to = "base"              # base, body_below, absolute; default base, of an acceleration absolute
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from typing import Any

from grids.files import Schema, check
from grids.units import to_si
from models.errors import InputError, nearest
from models.kinematics import DIRECTIONS, REFERENCES, UNITS, Place

KEYS = ("quantity", "body", "position_x", "position_z", "direction", "relative_to")
OF_HISTORIES = ("time", "level", "event", "event_time", "event_kind", "event_body")
"""What a history written by a simulation holds beside channels."""
MOST = 12
"""Bodies of a model: the levels of a building."""
LAYERS = {"base_layer": 1, "top_layer": 2}
"""The body over each layer: what opens or closes is the joint under it."""
IN_LAYERS = ("uplift", "compression")
FARTHEST = 50.0
"""m, of a place from the middle of a body's underside: beyond, it is in another unit."""
POINTLESS = ("rotation", "angular_velocity", "uplift", "compression")
"""Quantities that have no direction of their own to choose."""


class PlaceTable(Schema):
    """One channel as a file states it."""

    quantity: str
    body: int | float | str = 1
    position_x: float | int | str = 0.0
    position_z: float | int | str = 0.0
    direction: str = ""
    relative_to: str = ""


def read_places(tables: Mapping[str, Mapping[str, Any]], standard: Iterable[str]) -> dict[str, Place]:
    """Places by channel, of tables by channel; names must not be ``standard`` ones. Raises InputError."""
    known = tuple(standard)
    stems = tuple({name.partition("_")[0] + "_" for name in known})
    found = {}
    for name, table in tables.items():
        if name in known:
            raise InputError(f"[channels.{name}]: {name} says by its name what it measures; leave the table out.")
        if name in OF_HISTORIES:
            raise InputError(f"[channels.{name}]: histories call something else so; name it for instance lvdt_left.")
        if name.startswith(stems) or not re.fullmatch(r"[A-Za-z]\w*", name):
            raise InputError(
                f"[channels.{name}]: name it with letters, digits and _, and not like the standard channels "
                f"({', '.join(sorted(stems))}...); for instance lvdt_left."
            )
        found[name] = read_place(name, table)
    return found


def read_place(name: str, table: Mapping[str, Any]) -> Place:
    """The place that a table or the attributes of a variable state. Raises InputError."""
    where = f"channel {name}"
    try:
        given = check(PlaceTable, {key: table[key] for key in table})
    except InputError as error:
        raise InputError(f"{where}: {error}") from None
    _among(given.quantity, UNITS, f"{where}: quantity")
    body = _body(given, where)
    if given.quantity in POINTLESS and (given.direction or given.relative_to):
        raise InputError(f"{where}: {given.quantity} has no direction and no relative_to; leave them out.")
    if given.quantity == "force" and (given.relative_to or _position(given) != (0.0, 0.0)):
        raise InputError(
            f"{where}: a force is that of the whole joint under the body; leave position and relative_to out."
        )
    direction = given.direction or "x"
    _among(direction, DIRECTIONS[:2] if given.quantity == "force" else DIRECTIONS, f"{where}: direction")
    relative = given.relative_to or ("absolute" if given.quantity == "acceleration" else "base")
    _among(relative, REFERENCES, f"{where}: relative_to")
    if relative == "absolute" and given.quantity in ("displacement", "velocity"):
        raise InputError(
            f"{where}: an absolute {given.quantity} is not predicted: subtract that of the base, and give "
            "relative_to = 'base'."
        )
    if relative == "body_below" and given.quantity in ("velocity", "acceleration"):
        raise InputError(
            f"{where}: relative_to = 'body_below' is for displacements; give 'base'"
            + (" or 'absolute'." if given.quantity == "acceleration" else ".")
        )
    x, z = (to_si(value, "m", f"{where}: position_{axis}") for axis, value in zip("xz", _position(given), strict=True))
    for axis, value in (("x", x), ("z", z)):
        if abs(value) > FARTHEST:
            raise InputError(f"{where}: position_{axis} = {value:g} m is on no wall; give its unit, '{value:g} mm'.")
    return Place(given.quantity, body, x, z, direction, relative)


def attributes(place: Place) -> dict[str, str | int | float]:
    """What a netCDF variable, or a table, says of a channel."""
    found: dict[str, str | int | float] = {"quantity": place.quantity, "body": place.body}
    if place.quantity == "force":
        return found | {"direction": place.direction}
    if place.quantity not in ("rotation", "angular_velocity"):
        found["position_x"] = place.x
    if place.quantity not in POINTLESS:
        found |= {"position_z": place.z, "direction": place.direction, "relative_to": place.relative_to}
    return found


def _body(given: PlaceTable, where: str) -> int:
    if given.quantity in IN_LAYERS and given.body in LAYERS:
        return LAYERS[str(given.body)]
    if isinstance(given.body, str) or given.body not in range(1, MOST + 1):
        said = f"'{given.body}'" if isinstance(given.body, str) else given.body
        raise InputError(
            f"{where}: body = {said}; it is 1 (the lower, or the only one), 2 (the one above it) ... {MOST}; "
            f"{' and '.join(IN_LAYERS)} may also be of {' or '.join(LAYERS)}."
        )
    return int(given.body)


def _position(given: PlaceTable) -> tuple[float | str, float | str]:
    return given.position_x, given.position_z


def _among(word: str, known: Iterable[str], where: str) -> None:
    if word not in tuple(known):
        raise InputError(f"{where} = '{word}' is not known; {nearest(word, tuple(known))}")
