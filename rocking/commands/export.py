"""``rocking export D``: part of a cube as CSV or netCDF."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rocking.commands.base import read_selection


def export(
    folder: Annotated[Path, typer.Argument(help="A study's folder, results/NAME.")],
    out: Annotated[Path, typer.Option(help="File to write, .csv or .nc.")],
    output: Annotated[list[str] | None, typer.Option(help="Output to keep (may be repeated; default: all).")] = None,
    select: Annotated[list[str] | None, typer.Option(help="AXIS=VALUE, nearest value (may be repeated).")] = None,
) -> None:
    """Write all cells of a cube, or some of them, as a table or a smaller cube."""
    from study.export import export as export_cube
    from study.open import open_study

    cube = open_study(folder)
    path = export_cube(cube, out, outputs=output or (), at=read_selection(cube, select or []))
    typer.echo(f"written: {path}")
