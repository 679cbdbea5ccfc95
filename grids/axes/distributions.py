"""Distributions of a sampled parameter, as quantile functions of a share in [0, 1].

| written | distribution |
|---|---|
| `[low, high]` or `{ range = [low, high] }` | uniform |
| `{ range = [low, high], spacing = "log" }` | log-uniform |
| `{ normal = [mean, standard_deviation] }` | normal |
| `{ lognormal = [median, logarithmic_standard_deviation] }` | lognormal |
| `["linear", "hardening"]` | words, each equally likely |

``truncated = [low, high]`` beside normal and lognormal conditions them on that interval; ``unit`` holds for all numbers
but a logarithmic standard deviation.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr, ndtri

from grids.axes.base import Request, bounded
from grids.targets import MOTION, Target
from grids.units import factor_to_si, to_si
from models.errors import InputError

Shares = NDArray[np.float64]
Quantile = Callable[[Shares], NDArray[Any]]

KINDS = ("range", "normal", "lognormal")
BESIDE = {"range": ("unit", "spacing"), "normal": ("unit", "truncated"), "lognormal": ("unit", "truncated")}
SPACINGS = ("linear", "log")


def read_distribution(request: Request, name: str, entry: object) -> Quantile:
    """The quantile function of an entry of ``parameters``; InputError says what is wrong with it."""
    where = f"{request.where} {name}"
    if name == MOTION:
        raise InputError(f"{where}: a sample draws parameters; give the motions an axis of their own.")
    target = request.targets.find(name, where)
    if target.words:
        return _words(target, entry, where)
    table: Mapping[str, Any] = entry if isinstance(entry, dict) else {"range": entry}
    present = [kind for kind in KINDS if kind in table]
    if len(present) != 1:
        raise InputError(f"{where} = {entry!r}; give [low, high], or a table with exactly one of {', '.join(KINDS)}.")
    (kind,) = present
    if unknown := set(table) - {kind, *BESIDE[kind]}:
        raise InputError(
            f"{where}: {sorted(unknown)[0]!r} is not known beside {kind}; known: {', '.join(BESIDE[kind])}."
        )
    first, second = _pair(table, kind, target, where, spread=kind == "lognormal")
    if kind == "range":
        return _range(first, second, table["range"], table.get("spacing", "linear"), target, where)
    if not np.isfinite([first, second]).all():
        raise InputError(f"{where}: {kind} = {table[kind]}: both numbers must be finite; correct them.")
    if not second > 0.0 or (kind == "lognormal" and not first > 0.0):
        raise InputError(f"{where}: {kind} = {table[kind]}: the spread must be above zero, a median too; correct it.")
    ends = _pair(table, "truncated", target, where) if "truncated" in table else (-np.inf, np.inf)
    if not ends[0] < ends[1]:
        raise InputError(f"{where}: truncated = {table['truncated']}: low must be below high; swap or separate them.")
    return _normal(first, second, ends, kind == "lognormal", target, where)


def _words(target: Target, entry: object, where: str) -> Quantile:
    if not isinstance(entry, list) or len(entry) < 2 or len(set(map(str, entry))) < len(entry):
        raise InputError(f"{where} = {entry!r}; list at least two different words.")
    words = np.array([target.word(word, where) for word in entry], dtype=object)
    return lambda share: words[np.minimum((share * words.size).astype(int), words.size - 1)]


def _range(low: float, high: float, given: object, spacing: str, target: Target, where: str) -> Quantile:
    if spacing not in SPACINGS:
        raise InputError(f"{where}: spacing = {spacing!r}; write 'linear' or 'log'.")
    if not np.isfinite([low, high]).all():
        raise InputError(f"{where} = {given}: both ends must be finite; correct them.")
    if not low < high:
        raise InputError(f"{where} = {given}: low must be below high; swap or separate them.")
    if spacing == "log" and low <= 0.0:
        raise InputError(f"{where}: a log spacing starts above zero, not at {low:.6g}; raise it or use linear.")
    bounded(np.array([low, high]), target, where)
    if spacing == "log":
        return lambda share: low * (high / low) ** share
    return lambda share: low + (high - low) * share


def _normal(centre: float, spread: float, ends: tuple[float, float], log: bool, target: Target, where: str) -> Quantile:
    def standard(value: float) -> float:
        if not log:
            return (value - centre) / spread
        return float(np.log(value / centre) / spread) if value > 0.0 else -np.inf

    low, high = (float(ndtr(standard(end))) for end in ends)
    if not low < high:
        raise InputError(f"{where}: the distribution has nothing between the ends of truncated; move them.")

    def quantile(share: Shares) -> NDArray[Any]:
        index = spread * ndtri(low + (high - low) * share)
        values = centre * np.exp(index) if log else centre + index
        try:
            return bounded(np.clip(values, *ends), target, where)
        except InputError as error:
            raise InputError(f"{str(error).rstrip('.')}; cut the distribution with truncated = [low, high].") from None

    return quantile


def _pair(
    table: Mapping[str, Any], key: str, target: Target, where: str, *, spread: bool = False
) -> tuple[float, float]:
    """Two numbers in SI; a logarithmic ``spread`` has no unit."""
    entry = table[key]
    if not isinstance(entry, list) or len(entry) != 2:
        raise InputError(f"{where}: {key} = {entry!r}; give two numbers.")
    unit = table.get("unit")

    def number(value: object) -> float:
        if unit is None or isinstance(value, str):
            return to_si(value, target.unit, where)
        return to_si(value, "1", where) * factor_to_si(str(unit), target.unit, where)

    return number(entry[0]), to_si(entry[1], "1", where) if spread else number(entry[1])
