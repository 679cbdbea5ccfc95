"""What a reader returns: every component of one record, checked, in m s-2 and with the vertical up."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from grids.sampling import SHORTEST, parse_numbers
from models.errors import InputError

FloatArray = NDArray[np.float64]

LARGEST = 200.0
"""Peak in m s-2 beyond which the unit must be wrong (the strongest records reach about 45)."""

_VARIABLES = ("base_acceleration_", "acceleration_")
_UP_ALONE = {"u", "v"}
_UP = {"up", "ver", "vrt", "ud", "updown", "z", "upward"}
_DOWN = {"down", "dwn", "dn", "downward"}
_PLAIN = {"a", "acc", "accel", "acceleration", "base", "ground", "table", "ch", "channel", "comp", "component"}
"""Words that say nothing of a direction."""
_UP_BY_FORM = re.compile(r"vert|verti[ck]al[a-z]*|a(cc)?z|v(el)?z|[bcdefghlms][ghlmn]z")
"""Vertical in several languages, az and vz, and the codes of SEED: band, instrument, orientation."""


def vertical_sign(component: str) -> int:
    """+1 for a vertical component positive up, -1 for one positive down, 0 for a horizontal one."""
    word = re.sub(r"[^a-z]", "", component.lower())
    if word in _DOWN:
        return -1
    if word in _UP or word in _UP_ALONE:
        return 1
    words = [re.sub(r"\d$", "", one) for one in re.findall(r"[a-z0-9]+", component.lower())]
    signs = [_sign_of_word(one) for one in words if one not in _PLAIN]
    if not signs or 0 in signs:
        return 0
    return min(signs)


def _sign_of_word(word: str) -> int:
    if word in _DOWN:
        return -1
    return 1 if word in _UP or _UP_BY_FORM.fullmatch(word) else 0


def component_name(variable: str) -> str | None:
    """``north`` of ``acceleration_north``, ``x`` of ``base_acceleration_x``; None for other names."""
    return next((variable.removeprefix(p) for p in _VARIABLES if variable.startswith(p)), None)


@dataclass(frozen=True)
class Record:
    """Components (n,) in m s-2 by name, all of one length and step (s); the vertical positive up.

    ``preferred`` names the horizontal component that the given file or key stands for, if any.
    """

    name: str
    time_step: float
    horizontals: Mapping[str, FloatArray]
    vertical: tuple[str, FloatArray] | None
    source: Mapping[str, Any]
    notes: tuple[str, ...] = ()
    preferred: str | None = None


@dataclass(frozen=True)
class Reader:
    """``read(path, key, statement)`` with the part after the colon of ``file:key`` and what the
    user states about the file (units, step, columns); ``statement_keys`` are the words it knows."""

    name: str
    suffixes: tuple[str, ...]
    read: Callable[[Path, str | None, Mapping[str, Any]], Record]
    takes_key: bool = False
    statement_keys: tuple[str, ...] = field(default=())


def check_samples(values: Any, where: str) -> FloatArray:
    """Samples (n,) in m s-2 as float64: numbers, finite, enough of them, plausible, not all zero."""
    array = np.asarray(values)
    if array.ndim != 1:
        raise InputError(f"{where}: has shape {array.shape}: give one row of samples")
    if array.dtype.kind not in "fiu":
        raise InputError(f"{where}: holds {array.dtype} and not numbers: name an array of accelerations")
    array = array.astype(np.float64)
    if array.size < SHORTEST:
        raise InputError(f"{where}: has {array.size} sample(s), fewer than {SHORTEST}: is the file cut short?")
    bad = np.flatnonzero(~np.isfinite(array))
    if bad.size:
        raise InputError(
            f"{where}: {bad.size} of {array.size} samples are not finite, the first is number {bad[0] + 1}: "
            "repair or cut the record"
        )
    peak = float(np.max(np.abs(array)))
    if peak == 0.0:
        raise InputError(f"{where}: every sample is zero: is it the right channel?")
    if peak > LARGEST:
        raise InputError(f"{where}: peak is {peak:.4g} m s-2, more than any ground motion: is the unit stated right?")
    return array


def assemble(
    name: str,
    components: Sequence[tuple[str, float, FloatArray]],
    source: Mapping[str, Any],
    *,
    where: str,
    preferred: str | None = None,
    notes: tuple[str, ...] = (),
) -> Record:
    """One record of its components (name, time step in s, samples in m s-2): vertical found by its
    name and turned up, lengths cut to the shortest, both noted."""
    said = list(notes)
    names = [component for component, _, _ in components]
    twice = sorted({n for n in names if names.count(n) > 1})
    if twice:
        raise InputError(f"{where}: component {twice[0]} is there {names.count(twice[0])} times: keep one")
    steps = {component: step for component, step, _ in components}
    if max(steps.values()) > min(steps.values()) * (1 + 1e-6):
        listed = ", ".join(f"{component} {step:g} s" for component, step in steps.items())
        raise InputError(f"{where}: the components differ in time step ({listed}): resample them to one step")
    lengths = {component: values.size for component, _, values in components}
    shortest = min(lengths.values())
    if max(lengths.values()) > shortest:
        listed = ", ".join(f"{component} {size}" for component, size in lengths.items())
        said.append(f"components of unequal length ({listed} samples) cut to the shortest, {shortest}")
    horizontals: dict[str, FloatArray] = {}
    vertical: tuple[str, FloatArray] | None = None
    for component, _, values in components:
        sign = vertical_sign(component)
        if sign == 0:
            horizontals[component] = values[:shortest]
            continue
        if vertical is not None:
            raise InputError(f"{where}: {vertical[0]} and {component} are both vertical: keep one of them")
        if sign < 0:
            said.append(f"sign of {component} flipped: vertical is positive up")
        vertical = component, sign * values[:shortest]
    if not horizontals:
        raise InputError(
            f"{where}: has no horizontal component (found: {', '.join(names) or 'none'}): "
            "add one or name the file that has it"
        )
    return Record(name, components[0][1], horizontals, vertical, source, tuple(said), preferred)


def read_text(path: Path) -> list[str]:
    """The lines of a text file; an InputError where it is empty or no text."""
    try:
        data = path.read_bytes()
    except OSError as error:
        raise InputError(f"{path.name}: cannot be read ({error.strerror}): check the path and its rights") from None
    if not data.strip():
        raise InputError(f"{path.name}: is empty: fetch the file again")
    if b"\0" in data:
        raise InputError(f"{path.name}: is not a text file: is its name ending right?")
    return data.decode("latin-1").splitlines()


def fixed_width(lines: Sequence[str], width: int, where: str) -> FloatArray:
    """Numbers in columns of ``width`` characters, which may touch each other."""
    rows = [line.rstrip() for line in lines]
    return parse_numbers([row[i : i + width].strip() for row in rows for i in range(0, len(row), width)], where)
