"""``rocking check D``: recompute random cells of a cube."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rocking.commands.base import FAILURES, whole


def check(
    folder: Annotated[Path, typer.Argument(help="A study's folder, results/NAME.")],
    cells: Annotated[int, typer.Option(help="How many cells.", parser=whole)] = 100,
    seed: Annotated[int | None, typer.Option(help="Choose the same cells every time.", parser=whole)] = None,
) -> None:
    """Recompute random cells and compare them with the cube bit for bit (exit code 1: they differ)."""
    from study.check import check as check_study

    report = check_study(folder, cells=cells, seed=seed)
    typer.echo(str(report))
    if report.differing:
        raise typer.Exit(FAILURES)
