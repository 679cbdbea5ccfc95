"""``rocking export D``: part of a cube as CSV or netCDF."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rocking.commands.base import NEAREST, SELECT, read_selection
from rocking.commands.outputs import in_study, keep_inputs, keep_others


def export(
    folder: Annotated[Path, typer.Argument(help="A study's folder, results/NAME.")],
    out: Annotated[Path, typer.Option(help="File to write, .csv or .nc.")],
    output: Annotated[list[str] | None, typer.Option(help="Output to keep (may be repeated; default: all).")] = None,
    select: Annotated[list[str] | None, typer.Option(help=f"{SELECT} (may be repeated; default: all).")] = None,
    nearest: Annotated[bool, typer.Option("--nearest", help=NEAREST)] = False,
) -> None:
    """Write all cells of a cube, or some of them, as a table or a smaller cube."""
    from study.export import export as export_cube
    from study.open import open_study
    from study.selection import place

    keep_inputs([out], in_study(folder))
    keep_others(out)
    with open_study(folder, lazy=True) as cube:
        at = read_selection(cube, select, nearest)
        path = export_cube(cube, out, outputs=output or (), at=at)
        typer.echo(f"written: {path}" + (f", at {place(cube, at)}" if at else ""))
