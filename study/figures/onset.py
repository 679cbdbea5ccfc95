"""The onset map of a cube, with the rigid block's threshold for comparison."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import xarray as xr
from matplotlib.axes import Axes

from study.figures.map_figure import draw_legend, plot_map
from study.figures.style import COLOURS, positions, shown
from study.maps import default_axes, onset_map
from study.selection import complete, over_samples, select

THRESHOLD = "threshold without vertical shaking"


def plot_onset_map(
    cube: xr.Dataset,
    x: str | None = None,
    y: str | None = None,
    at: Mapping[str, Any] | None = None,
    *,
    ax: Axes | None = None,
) -> Axes:
    """Draw where rocking starts over two axes, or the smallest intensity that starts it.

    Arguments as in `study.maps.onset_map`. Over PGA, a dashed line marks the onset acceleration of
    the wall under horizontal shaking alone.
    """
    x, y = default_axes(cube, x, y, at)
    ax = plot_map(onset_map(cube, x, y, at), words=("rocks", "does not rock"), ax=ax)
    if y == "pga" and "onset_acceleration" in cube.coords and not over_samples(cube, at, (x, y)):
        threshold = select(cube, complete(cube, at, (x, y)))["onset_acceleration"].squeeze()
        if threshold.dims == (x,):
            low, high = ax.get_ylim()
            line = ax.plot(positions(cube[x])[0], shown(threshold)[0], "--", color=COLOURS[6], label=THRESHOLD)
            ax.set_ylim(low, high)
            legend = ax.get_legend()
            handles = [handle for handle in (legend.legend_handles if legend else []) if handle is not None]
            draw_legend(ax, [*handles, *line])
    return ax
