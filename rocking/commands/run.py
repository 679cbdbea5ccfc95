"""``rocking run F``: start a study or continue it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rocking.commands.base import FAILURES, STRICT, human_time, warn, whole
from rocking.interrupts import INTERRUPTED

if TYPE_CHECKING:
    from rich.progress import Progress as Bar

    from study.run import Progress


def run(
    plan: Annotated[Path, typer.Argument(help="Plan file (TOML).")],
    scheduler: Annotated[
        str, typer.Option(help="synchronous, threads, processes, or tcp://host:port of a dask cluster.")
    ] = "threads",
    workers: Annotated[int | None, typer.Option(help="Blocks at once (default: one a core).", parser=whole)] = None,
    results: Annotated[Path, typer.Option(help="Folder of all results.")] = Path("results"),
    strict: Annotated[bool, typer.Option("--strict", help=STRICT)] = False,
) -> None:
    """Run a study, or continue it where it stopped, and write its cube."""
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn
    from rich.progress import Progress as Bar

    from grids.plan import read_plan
    from grids.plausibility import suspicions_of_plan
    from study.run import WorkerLost
    from study.run import run as run_study

    warn(suspicions_of_plan(read_plan(plan)), strict)
    columns = (
        TextColumn("cells"),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("{task.fields[rate]}  {task.fields[left]} left  {task.fields[failures]} failed blocks"),
    )
    show = _ProgressBar(Bar(*columns, console=Console(stderr=True)))
    try:
        report = run_study(plan, results=results, scheduler=scheduler, workers=workers, progress=show)
    except KeyboardInterrupt:
        typer.echo("stopped; finished blocks are kept, run again to continue", err=True)
        raise typer.Exit(INTERRUPTED) from None
    except WorkerLost as error:
        typer.echo(f"error: {error}", err=True)
        raise typer.Exit(FAILURES) from None
    finally:
        show.stop()
    typer.echo(str(replace(report, suspicions=())))  # they were said before the run
    if report.failed:
        raise typer.Exit(FAILURES)


class _ProgressBar:
    """Shows progress on a bar that appears with the first report, after the plan was accepted."""

    def __init__(self, bar: Bar) -> None:
        self.bar = bar
        self.task = bar.add_task("cells", total=None, rate="", left="?", failures=0)

    def stop(self) -> None:
        if self.bar.live.is_started:
            self.bar.stop()

    def __call__(self, progress: Progress) -> None:
        self.bar.start()
        left = progress.seconds_left
        self.bar.update(
            self.task,
            total=progress.cells,
            completed=progress.cells_done,
            rate=f"{progress.rate:,.0f} cells/s",
            left="?" if left is None else human_time(left),
            failures=progress.failures,
        )
