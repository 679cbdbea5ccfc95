"""``rocking cloud D OUTPUT``: an output over a measure of the motion, and which measure sorts outcomes best."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from rocking.commands.base import NEAREST, SELECT, console, read_event, read_selection
from rocking.commands.fragility import EXCEEDS


def cloud(
    folder: Annotated[Path, typer.Argument(help="A study's folder, results/NAME, with an axis motion.")],
    output: Annotated[str, typer.Argument(help="An output of the study, for instance peak_rotation.")],
    measure: Annotated[str | None, typer.Option(help="Measure across (default: the one that sorts best).")] = None,
    event: Annotated[str | None, typer.Option(help=EXCEEDS)] = None,
    select: Annotated[list[str] | None, typer.Option(help=f"{SELECT} (default: middle values).")] = None,
    nearest: Annotated[bool, typer.Option("--nearest", help=NEAREST)] = False,
    out: Annotated[Path | None, typer.Option(help="Folder of the figures (default: the study's).")] = None,
) -> None:
    """Rank the measures of the motions by how well they sort outcomes; draw cloud.png and measures.png."""
    from rich.table import Table

    from study.figures import plot_cloud, plot_sorting, save_figure
    from study.open import open_study
    from study.sets.sorting import sorting

    cube = open_study(folder)
    at = read_selection(cube, select, nearest)
    found = sorting(cube, read_event(cube, event), at)
    table = Table("measure", "sorts (95 % interval)", "dispersion", title=f"{found.event}, {found.motions} motions")
    for name, area, low, high, spread in zip(found["measure"].values, *(found[v].values for v in found), strict=True):
        table.add_row(str(name), f"{area:.3f} ({low:.3f} to {high:.3f})", f"{spread:.3g}")
    console().print(table)
    home = out or (folder if folder.is_dir() else folder.parent)
    across = measure or str(found["measure"].values[0])
    typer.echo(f"written: {save_figure(partial(plot_cloud, cube, output, across, at), home / 'cloud.png')}")
    typer.echo(f"written: {save_figure(partial(plot_sorting, found), home / 'measures.png')}")
