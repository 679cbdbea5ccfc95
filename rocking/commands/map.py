"""``rocking map D``: the overturning and the onset map of a cube as figures, or the map of one output."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from rocking.commands.base import NEAREST, SELECT, read_selection


def map_(
    folder: Annotated[Path, typer.Argument(help="A study's folder, results/NAME.")],
    x: Annotated[
        str | None,
        typer.Option(help="Axis across (default: the first; pga or motion_scale only where no other is left)."),
    ] = None,
    y: Annotated[
        str | None, typer.Option(help="Axis up (default: the next; pga or motion_scale only where no other is left).")
    ] = None,
    select: Annotated[
        list[str] | None, typer.Option(help=f"{SELECT}, for the other axes (default: their middle values).")
    ] = None,
    nearest: Annotated[bool, typer.Option("--nearest", help=NEAREST)] = False,
    output: Annotated[str | None, typer.Option(help="Draw this output instead, as OUTPUT_map.png.")] = None,
    out: Annotated[Path | None, typer.Option(help="Folder of the figures (default: the study's).")] = None,
) -> None:
    """Draw overturning_map.png and onset_map.png over two axes."""
    from study import maps
    from study.figures import plot_onset_map, plot_output_map, plot_overturning_map, save_figure
    from study.open import open_study

    with open_study(folder, lazy=True) as cube:
        at = read_selection(cube, select, nearest)
        x, y = maps.default_axes(cube, x, y, at)
        home = out or (folder if folder.is_dir() else folder.parent)
        if output is not None:
            drawn = maps.output_map(cube, output, x, y, at)
            figures = {f"{output}_map": partial(plot_output_map, cube, output, x, y, at)}
        else:
            drawn = maps.overturning_map(cube, x, y, at)
            figures = {
                "overturning_map": partial(plot_overturning_map, cube, x, y, at),
                "onset_map": partial(plot_onset_map, cube, x, y, at),
            }
        typer.echo(f"over {x} and {y}, at {drawn.attrs['selection'] or 'all there is'}")
        for name, draw in figures.items():
            typer.echo(f"written: {save_figure(draw, home / f'{name}.png')}")
