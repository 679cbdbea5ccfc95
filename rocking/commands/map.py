"""``rocking map D``: the overturning and the onset map of a cube as figures."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from rocking.commands.base import read_selection


def map_(
    folder: Annotated[Path, typer.Argument(help="A study's folder, results/NAME.")],
    x: Annotated[str | None, typer.Option(help="Axis across (default: the first).")] = None,
    y: Annotated[str | None, typer.Option(help="Axis up (default: the next that is not pga).")] = None,
    select: Annotated[
        list[str] | None, typer.Option(help="AXIS=VALUE for the others (default: their middle values).")
    ] = None,
    out: Annotated[Path | None, typer.Option(help="Folder of the figures (default: the study's).")] = None,
) -> None:
    """Draw overturning_map.png and onset_map.png over two axes."""
    from study.figures import plot_onset_map, plot_overturning_map, save_figure
    from study.maps import default_axes, middle
    from study.open import open_study

    cube = open_study(folder)
    x, y = default_axes(cube, x, y)
    at = read_selection(cube, select or [])
    at = {**middle(cube, (x, y, *at)), **at}
    home = out or (folder if folder.is_dir() else folder.parent)
    for name, draw in (("overturning_map", plot_overturning_map), ("onset_map", plot_onset_map)):
        path = save_figure(partial(draw, cube, x, y, at), home / f"{name}.png")
        typer.echo(f"written: {path}")
