"""``rocking map D``: the overturning and the onset map of a cube as figures, or the map of one output."""

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
    output: Annotated[str | None, typer.Option(help="Draw this output instead, as OUTPUT_map.png.")] = None,
    out: Annotated[Path | None, typer.Option(help="Folder of the figures (default: the study's).")] = None,
) -> None:
    """Draw overturning_map.png and onset_map.png over two axes."""
    from study.figures import plot_onset_map, plot_output_map, plot_overturning_map, save_figure
    from study.maps import default_axes, middle
    from study.open import open_study

    cube = open_study(folder)
    x, y = default_axes(cube, x, y)
    at = read_selection(cube, select or [])
    at = {**middle(cube, (x, y, *at), intensity=output is not None), **at}
    home = out or (folder if folder.is_dir() else folder.parent)
    figures = {
        "overturning_map": partial(plot_overturning_map, cube, x, y, at),
        "onset_map": partial(plot_onset_map, cube, x, y, at),
    }
    if output is not None:
        figures = {f"{output}_map": partial(plot_output_map, cube, output, x, y, at)}
    for name, draw in figures.items():
        typer.echo(f"written: {save_figure(draw, home / f'{name}.png')}")
