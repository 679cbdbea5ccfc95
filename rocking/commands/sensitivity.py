"""``rocking sensitivity F``: run a study of a design, or continue it, and say which parameters matter."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rocking.commands.base import NEAREST, SELECT, console, read_event, read_selection, whole
from rocking.commands.fragility import EXCEEDS
from rocking.commands.run import run

if TYPE_CHECKING:
    import xarray as xr


def sensitivity(
    plan: Annotated[Path, typer.Argument(help="Plan file (TOML) with an axis of kind saltelli or morris.")],
    event: Annotated[list[str] | None, typer.Option(help=f"{EXCEEDS} May be repeated.")] = None,
    output: Annotated[list[str] | None, typer.Option(help="Outputs to print and draw (default: all).")] = None,
    select: Annotated[list[str] | None, typer.Option(help=f"{SELECT}, for axes other than motion.")] = None,
    nearest: Annotated[bool, typer.Option("--nearest", help=NEAREST)] = False,
    scheduler: Annotated[str, typer.Option(help="As of rocking run.")] = "threads",
    workers: Annotated[int | None, typer.Option(help="As of rocking run.", parser=whole)] = None,
    results: Annotated[Path, typer.Option(help="Folder of all results.")] = Path("results"),
) -> None:
    """Run the study, print a table of what to tune first, write sensitivity.nc and figures beside the cube."""
    from grids.plan import read_plan
    from models.errors import InputError
    from models.errors import nearest as closest
    from study.export import write_dataset
    from study.figures import plot_indices, plot_interactions, plot_tornado, save_figure
    from study.open import open_study
    from study.sensitivity.analysis import analyse, design_axis

    checked = read_plan(plan)
    design_axis(checked)
    run(plan, scheduler, workers, results, False)
    folder = results / checked.name
    cube = open_study(folder)
    events = [read_event(cube, text) for text in event or ()]
    found = analyse(cube, checked, events, read_selection(cube, select, nearest))
    typer.echo(f"written: {write_dataset(found, folder / 'sensitivity.nc')}")
    known = [str(name) for name in found["output"].values]
    for name in output or known:
        if name not in known:
            raise InputError(f"'{name}' is none of the analysed outputs: {closest(name, known)}")
        _print(found, name)
        stem = name.replace(" ", "_").replace(">", "over")
        figures = {"indices": plot_indices, "tornado": plot_tornado}
        figures |= {"interactions": plot_interactions} if "second" in found else {}
        for kind, draw in figures.items():
            typer.echo(f"written: {save_figure(partial(draw, found, name), folder / f'{kind}_{stem}.png')}")


def _print(found: xr.Dataset, output: str) -> None:
    from rich.table import Table

    from study.sensitivity.table import what_to_tune

    rows = what_to_tune(found, output)
    one = found.sel(output=output)
    of = str(found["motions"].values[0])
    table = Table(*rows[0], title=f"{output}: mean {float(one['mean'][0]):.4g} over {found.points} points, {of}")
    for row in rows[1:]:
        table.add_row(*row)
    console().print(table)
    motion, parameters = float(one["share_of_motion"]), float(one["share_of_parameters"])
    if motion >= 0.0:
        typer.echo(f"of the variance over motions and parameters: the motion alone {motion:.0%}, ", nl=False)
        typer.echo(f"the parameters alone {parameters:.0%}, both together the rest")
    if float(one["unknown_share"]) > 0.0:
        typer.echo(f"points without a valid answer, left out: {float(one['unknown_share']):.2%}")
