"""Draw a figure straight into a file, without a window and without leaving it open."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.backend_bases import FigureCanvasBase
from matplotlib.figure import Figure

from models.errors import InputError
from study.store import write_whole


def check_suffix(path: Path) -> None:
    """Raise InputError for an ending that matplotlib cannot write: before the work, not after it."""
    if path.suffix.lstrip(".") not in FigureCanvasBase.get_supported_filetypes():
        raise InputError(f"cannot draw to '{path.name}': end the name in .png, .pdf, .svg or .jpg")


def save_figure(draw: Callable[[], Axes | tuple[Axes, ...]], path: Path) -> Path:
    """Write what ``draw`` draws to ``path``. Raises InputError for an ending matplotlib cannot write."""
    check_suffix(path)
    with plt.rc_context({"backend": "agg"}):
        drawn = draw()
        figure = (drawn[0] if isinstance(drawn, tuple) else drawn).get_figure(root=True)
        if not isinstance(figure, Figure):
            raise TypeError("the Axes belong to no figure")
        write_whole(path, lambda temporary: figure.savefig(temporary, dpi=150, format=path.suffix.lstrip(".")))
        plt.close(figure)
    return path
