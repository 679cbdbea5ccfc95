"""The ways to write an axis, one file each."""

from __future__ import annotations

from grids.axes import cases, geomspace, latin_hypercube, linspace, morris, saltelli, sobol, values
from grids.axes.base import Axis, AxisKind, Design, Request
from models.errors import InputError, nearest

KINDS: tuple[AxisKind, ...] = (
    linspace.KIND,
    geomspace.KIND,
    values.KIND,
    latin_hypercube.KIND,
    sobol.KIND,
    saltelli.KIND,
    morris.KIND,
    cases.KIND,
)

__all__ = ["KINDS", "Axis", "Design", "Request", "read_axis"]


def read_axis(request: Request) -> Axis:
    """The axis an entry of [axes] describes; InputError says what is wrong with it."""
    keys = [kind.key for kind in KINDS]
    if not isinstance(request.table, dict):
        raise InputError(
            f"{request.where} = {request.table!r}; write for example {{ values = [...] }}, "
            f"or put a fixed value in [parameters]."
        )
    present = [kind for kind in KINDS if kind.key in request.table]
    if len(present) != 1:
        given = " and ".join(kind.key for kind in present) or "none of them"
        raise InputError(f"{request.where} has {given}; give exactly one of {', '.join(keys)}.")
    allowed = {present[0].key, *present[0].beside}
    for key in request.table:
        if key not in allowed:
            raise InputError(f"{request.where}: '{key}' is not known beside {present[0].key}; {nearest(key, allowed)}")
    return present[0].read(request)
