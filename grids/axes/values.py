"""Listed values, records or words: ``{ values = [...], unit = "..." }``."""

from __future__ import annotations

import numpy as np

from grids.axes.base import MOST_POINTS, Axis, AxisKind, Request, number_axis
from grids.targets import MOTION
from models.errors import InputError


def _read(request: Request) -> Axis:
    entries = request.table["values"]
    where = f"{request.where} values"
    if not isinstance(entries, list) or not 0 < len(entries) <= MOST_POINTS:
        raise InputError(f"{where} = {entries!r}; give a list of at least one value.")
    if request.name == MOTION:
        if "unit" in request.table:
            raise InputError(f"{request.where}: motions have no unit; leave unit out.")
        return Axis(MOTION, _words(entries, where), "1", "ground motion")
    target = request.target()
    if target.words:
        if "unit" in request.table:
            raise InputError(f"{request.where}: words have no unit; leave unit out.")
        words = _words([target.word(entry, where) for entry in entries], where)
        return Axis(request.name, words, "1", target.meaning)
    return number_axis(request, np.array([request.in_si(entry, target, where) for entry in entries]))


def _words(entries: list[object], where: str) -> np.ndarray[tuple[int], np.dtype[np.object_]]:
    for index, entry in enumerate(entries):
        if entry in entries[:index]:
            raise InputError(f"{where}: {entry!r} is given twice; leave one out.")
    words = np.empty(len(entries), dtype=object)
    words[:] = entries
    return words


KIND = AxisKind("values", ("unit",), _read)
