"""``rocking ida D OUTPUT``: curves of incremental dynamic analysis with quantiles over the motions."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from rocking.commands.base import NEAREST, SELECT, read_selection


def ida(
    folder: Annotated[Path, typer.Argument(help="A study's folder, results/NAME, with axes motion and pga.")],
    output: Annotated[str, typer.Argument(help="An output of the study, for instance peak_rotation.")],
    measure: Annotated[str, typer.Option(help="Measure of the motion that grows: pga, pgv, sa_0.5s, ...")] = "pga",
    select: Annotated[list[str] | None, typer.Option(help=f"{SELECT} (default: middle values).")] = None,
    nearest: Annotated[bool, typer.Option("--nearest", help=NEAREST)] = False,
    out: Annotated[Path | None, typer.Option(help="File of the figure (default: ida.png in the study's).")] = None,
) -> None:
    """Draw an output over a growing measure of each motion, with its 16, 50 and 84 % quantiles."""
    from study.figures import plot_incremental, save_figure
    from study.open import open_study
    from study.sets.incremental import incremental

    cube = open_study(folder)
    found = incremental(cube, output, measure, read_selection(cube, select, nearest))
    typer.echo(f"{found.motions} motions, at {found.selection or 'all there is'}")
    home = folder if folder.is_dir() else folder.parent
    typer.echo(f"written: {save_figure(partial(plot_incremental, found), out or home / 'ida.png')}")
