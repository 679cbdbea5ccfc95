"""``rocking slices D OUTPUT``: curves of one output of a cube along an axis, as a figure."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from rocking.commands.base import NEAREST, SELECT, read_selection


def slices(
    folder: Annotated[Path, typer.Argument(help="A study's folder, results/NAME.")],
    output: Annotated[str, typer.Argument(help="An output of the study, for instance peak_rotation.")],
    x: Annotated[str, typer.Option(help="Axis across.")],
    select: Annotated[
        list[str] | None,
        typer.Option(help=f"{SELECT} (default: the first axis left gives a curve a value, others their middle ones)."),
    ] = None,
    nearest: Annotated[bool, typer.Option("--nearest", help=NEAREST)] = False,
    out: Annotated[Path | None, typer.Option(help="File of the figure (default: OUTPUT.png in the study's).")] = None,
) -> None:
    """Draw an output along one axis, one curve for each value of the axis left open."""
    from study import maps
    from study.figures import plot_slices, save_figure
    from study.open import open_study

    with open_study(folder, lazy=True) as cube:
        at = read_selection(cube, select, nearest)
        home = folder if folder.is_dir() else folder.parent
        drawn = maps.slices(cube, output, x, at)
        typer.echo(f"over {' and '.join(map(str, drawn.dims[::-1]))}, at {drawn.attrs['selection'] or 'all there is'}")
        path = save_figure(partial(plot_slices, cube, output, x, at), out or home / f"{output}.png")
        typer.echo(f"written: {path}")
