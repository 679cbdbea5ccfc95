"""``rocking spectra D``: rocking and overturning acceleration spectra of a cube over the size of the wall."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from rocking.commands.base import NEAREST, SELECT, read_selection


def spectra(
    folder: Annotated[Path, typer.Argument(help="A study's folder, results/NAME: heights at one aspect_ratio, pga.")],
    select: Annotated[list[str] | None, typer.Option(help=f"{SELECT} (default: middle values).")] = None,
    nearest: Annotated[bool, typer.Option("--nearest", help=NEAREST)] = False,
    out: Annotated[Path | None, typer.Option(help="Folder of the figures (default: the study's).")] = None,
) -> None:
    """Draw overturning_spectrum.png (PGA over onset acceleration against p) and, with the output
    peak_rotation_ratio, rocking_spectrum.png (at the selected or middle PGA)."""
    from study.figures import plot_overturning_spectrum, plot_rocking_spectrum, save_figure
    from study.open import open_study
    from study.sets.spectra import overturning_spectrum, rocking_spectrum

    cube = open_study(folder)
    at = read_selection(cube, select, nearest)
    home = out or (folder if folder.is_dir() else folder.parent)
    found = overturning_spectrum(cube, {name: value for name, value in at.items() if name != "pga"})
    typer.echo(f"written: {save_figure(partial(plot_overturning_spectrum, found), home / 'overturning_spectrum.png')}")
    if "peak_rotation_ratio" in cube.data_vars:
        rocks = rocking_spectrum(cube, at)
        typer.echo(f"written: {save_figure(partial(plot_rocking_spectrum, rocks), home / 'rocking_spectrum.png')}")
