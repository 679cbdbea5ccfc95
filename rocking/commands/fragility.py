"""``rocking fragility D``: how often walls overturn, or rotate beyond a threshold, over a measure of the motion."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rocking.commands.base import NEAREST, SELECT, console, read_event, read_selection

if TYPE_CHECKING:
    import xarray as xr

EXCEEDS = "Event 'OUTPUT > VALUE' with its unit, for instance 'peak_rotation > 2 deg' (default: the wall overturns)."


def fragility(
    folder: Annotated[Path, typer.Argument(help="A study's folder, results/NAME, with an axis motion.")],
    measure: Annotated[str, typer.Option(help="Measure of the motion: pga, pgv, pgd, arias, sa_0.5s, ...")] = "pga",
    event: Annotated[str | None, typer.Option(help=EXCEEDS)] = None,
    over: Annotated[str | None, typer.Option(help="An axis: a curve for each of its values.")] = None,
    select: Annotated[list[str] | None, typer.Option(help=f"{SELECT} (default: middle values).")] = None,
    nearest: Annotated[bool, typer.Option("--nearest", help=NEAREST)] = False,
    out: Annotated[
        Path | None, typer.Option(help="File of the figure (default: fragility.png in the study's).")
    ] = None,
) -> None:
    """Fit lognormal fragilities, print them with 95 % intervals and draw them over the observed shares."""
    from study.figures import plot_fragility, save_figure
    from study.open import open_study
    from study.sets.fragility import fragility as fit

    cube = open_study(folder)
    found = fit(cube, read_event(cube, event), measure, read_selection(cube, select, nearest), over)
    _print(found, over)
    home = folder if folder.is_dir() else folder.parent
    typer.echo(f"written: {save_figure(partial(plot_fragility, found), out or home / 'fragility.png')}")


def _print(found: xr.Dataset, over: str | None) -> None:
    from rich.table import Table

    from study.selection import value_shown
    from study.wording import unit_shown

    factor, unit = unit_shown(found["median"].attrs["units"])
    of = f"{found.motions} motions" + (f", {found.samples} samples" if found.samples else "")
    heads = [*([over] if over else []), f"median {found.measure} [{unit}]", "dispersion", "cells", "note"]
    table = Table(*heads, title=f"{found.event}, {of}, {found.selection}".rstrip(", "))
    for k in range(found.sizes[over] if over else 1):
        one = found.isel({over: k}) if over else found
        name = [value_shown(found[over], found[over].values[k])] if over else []
        median, spread = (_interval(one, what, by) for what, by in (("median", factor), ("dispersion", 1.0)))
        table.add_row(*name, median, spread, str(int(one["cells"])), str(one["why"].values))
    console().print(table)


def _interval(one: xr.Dataset, name: str, factor: float) -> str:
    value, low, high = (factor * float(one[f"{name}{end}"]) for end in ("", "_low", "_high"))
    return f"{value:.3g} ({low:.3g} to {high:.3g})"
