"""``rocking simulate specimen.toml``: one history."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def simulate(
    specimen: Annotated[Path, typer.Argument(help="Specimen file (TOML).")],
    out: Annotated[Path, typer.Option(help="History to write, .nc.")],
    motion: Annotated[
        str | None, typer.Option(help="Shipped motion, motion file, or recording (its base motion).")
    ] = None,
    duration: Annotated[float | None, typer.Option(help="Length of the run in s.")] = None,
    integrator: Annotated[str, typer.Option(help="lanes, reference or newmark.")] = "lanes",
    component: Annotated[str | None, typer.Option(help="Horizontal component of the motion.")] = None,
    scale: Annotated[float, typer.Option(help="Factor on the motion.")] = 1.0,
    figure: Annotated[Path | None, typer.Option(help="Draw the rotation over time (.png, .pdf).")] = None,
) -> None:
    """Simulate a specimen and write every observable over time, and the events."""
    from rocking.simulation import simulate as simulate_history
    from study.history import write_history

    history = simulate_history(
        specimen, motion, duration=duration, integrator=integrator, component=component, scale=scale
    )
    typer.echo(f"written: {write_history(history, out)} ({history.sizes['event']} events)")
    if figure is not None:
        from study.figures import plot_history, save_figure

        typer.echo(f"written: {save_figure(lambda: plot_history(history), figure)}")
