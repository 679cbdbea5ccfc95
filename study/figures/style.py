"""What all figures share: colours that colour-blind readers can distinguish, labels with units, axes."""

from __future__ import annotations

import textwrap
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator
from numpy.typing import NDArray

from study.wording import title, unit_shown

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#F0E442")
"""Okabe and Ito's palette."""
MAP_COLOURS = "cividis"
NOTHING = "#e6e6e6"
UNKNOWN = "#ffffff"
ROUNDED = 0.03
"""Relative distance of points from equal factors; preferred numbers lie within it."""
TITLE_WIDTH = 68
"""Characters in a line of a title."""


def new_axes(ax: Axes | None, width: float = 6.4, height: float = 4.4) -> Axes:
    """The given Axes, or those of a new figure."""
    if ax is not None:
        return ax
    return plt.figure(figsize=(width, height), layout="constrained").add_subplot()


def shown(values: xr.DataArray) -> tuple[NDArray[Any], str]:
    """Values and unit as engineers read them."""
    factor, unit = unit_shown(str(values.attrs.get("units", "1")))
    return (values.values if factor == 1.0 else factor * values.values), unit


def label(values: xr.DataArray) -> str:
    """Name and unit of a quantity for an axis or a colour bar."""
    words, unit = title(str(values.name)), shown(values)[1]
    return words if unit == "1" else f"{words} [{unit}]"


def symbol_label(values: xr.DataArray) -> str:
    """Symbol (else name) and unit of a quantity for an axis."""
    words, unit = str(values.attrs.get("symbol") or title(str(values.name))), shown(values)[1]
    return words if unit == "1" else f"{words} [{unit}]"


def literal(text: str) -> str:
    """A name from a file as matplotlib prints it: a dollar sign in it begins no formula."""
    return text.replace("$", r"\$")


def set_title(ax: Axes, text: str) -> None:
    """Write a title in as many lines as it needs, broken at commas only."""
    parts = text.replace(" ", "\u00a0").replace(",\u00a0", ", ")
    ax.set_title(literal("\n".join(textwrap.wrap(parts, TITLE_WIDTH))), fontsize="medium", pad=8)


def positions(values: xr.DataArray) -> tuple[NDArray[np.float64], list[str] | None]:
    """Where the points of an axis lie, and the words to print there when it holds no numbers."""
    if values.dtype.kind in "iuf":
        numbers = np.asarray(shown(values)[0], dtype=float)
        if np.all(np.isfinite(numbers)):
            return numbers, None
        # inf stands for no effect and lies nowhere on a scale: all points side by side
        return np.arange(values.size, dtype=float), [literal(f"{number:.4g}") for number in numbers]
    return np.arange(values.size, dtype=float), [literal(str(v)) for v in values.values]


def geometric(points: NDArray[np.float64]) -> bool:
    """Whether ascending points grow by equal factors, as those of ``geomspace`` or rounded ones (preferred numbers),
    and not as well by equal steps."""
    if points.size < 3 or points[0] <= 0.0:
        return False
    factors, steps = (space(points[0], points[-1], points.size) for space in (np.geomspace, np.linspace))
    return bool(np.allclose(points, factors, rtol=ROUNDED) and not np.allclose(points, steps, rtol=ROUNDED))


def set_scale(ax: Axes, which: str, points: NDArray[np.float64], words: list[str] | None) -> None:
    """Print the words of an axis that holds no numbers; a logarithmic scale for points by equal factors."""
    axis = ax.xaxis if which == "x" else ax.yaxis
    if words is not None:
        axis.set_ticks(np.arange(len(words)), words)
        if which == "x":
            plt.setp(axis.get_majorticklabels(), rotation=30, ha="right")
    elif geometric(np.sort(points)):
        (ax.set_xscale if which == "x" else ax.set_yscale)("log")
        set_log_ticks(axis)


def set_log_ticks(axis: Axis) -> None:
    """Plain numbers at 1, 2, 5, 10, ... on a logarithmic axis."""
    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_locator(NullLocator())


def edges(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Borders half way between neighbouring ascending points (half the factor where they grow by equal
    factors), the outer ones as far out as the next lies in."""
    if points.size == 1:
        half = 0.5 * (abs(points[0]) or 1.0)
        return np.array([points[0] - half, points[0] + half])
    if geometric(points):
        return np.asarray(np.exp(edges(np.log(points))))
    middle = 0.5 * (points[1:] + points[:-1])
    return np.concatenate([[2 * points[0] - middle[0]], middle, [2 * points[-1] - middle[-1]]])
