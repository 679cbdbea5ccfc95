"""What all figures share: colours that colour-blind readers tell apart, labels with units."""

from __future__ import annotations

from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from numpy.typing import NDArray

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#F0E442")
"""Okabe and Ito's palette."""
MAP_COLOURS = "cividis"
NOTHING = "#e6e6e6"
UNKNOWN = "#ffffff"
GRAVITY = 9.80665

_TEXT = {"s-1": "s⁻¹", "m s-1": "m s⁻¹", "rad s-1": "rad s⁻¹", "kg m-3": "kg m⁻³", "N m-2": "N m⁻²"}


def new_axes(ax: Axes | None, width: float = 6.4, height: float = 4.4) -> Axes:
    """The given Axes, or those of a new figure."""
    if ax is not None:
        return ax
    return plt.figure(figsize=(width, height), layout="constrained").add_subplot()


def shown(values: xr.DataArray) -> tuple[NDArray[Any], str]:
    """Values and unit as engineers read them: accelerations in g, rotations and lengths in SI."""
    unit = str(values.attrs.get("units", "1"))
    if unit == "m s-2":
        return values.values / GRAVITY, "g"
    return values.values, _TEXT.get(unit, unit)


def label(values: xr.DataArray, name: str | None = None) -> str:
    """Name and unit of a quantity for an axis or a colour bar."""
    words = (name or str(values.name)).replace("_", " ").replace(".", ": ")
    words = " ".join(word.upper() if word == "pga" else word for word in words.split(" "))
    unit = shown(values)[1]
    return words if unit == "1" else f"{words} [{unit}]"


def positions(values: xr.DataArray) -> tuple[NDArray[np.float64], list[str] | None]:
    """Where the points of an axis lie, and the words to print there when it holds no numbers."""
    if values.dtype.kind in "iuf":
        return np.asarray(shown(values)[0], dtype=float), None
    return np.arange(values.size, dtype=float), [str(v) for v in values.values]


def set_words(ax: Axes, which: str, words: list[str] | None) -> None:
    """Print the words of an axis that holds no numbers."""
    if words is not None:
        ticks = np.arange(len(words))
        if which == "x":
            ax.set_xticks(ticks, words, rotation=30, ha="right")
        else:
            ax.set_yticks(ticks, words)


def edges(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Borders half way between neighbouring points, the outer ones as far out as the next lies in."""
    if points.size == 1:
        half = 0.5 * (abs(points[0]) or 1.0)
        return np.array([points[0] - half, points[0] + half])
    middle = 0.5 * (points[1:] + points[:-1])
    return np.concatenate([[2 * points[0] - middle[0]], middle, [2 * points[-1] - middle[-1]]])
