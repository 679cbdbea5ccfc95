"""``rocking status D``: how far a study is."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def status(folder: Annotated[Path, typer.Argument(help="A study's folder, results/NAME.")]) -> None:
    """Print how many blocks and cells are finished and what failed."""
    from study.state import state

    typer.echo(str(state(folder)))
