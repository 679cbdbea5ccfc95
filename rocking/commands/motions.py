"""``rocking motions [FILE]``: list, read, plot and convert ground motions."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rocking.commands.outputs import keep_inputs, keep_others

if TYPE_CHECKING:
    from grids.motions import Motion


def motions(
    file: Annotated[str | None, typer.Argument(help="Shipped name, file, glob or file.npz:key.")] = None,
    component: Annotated[str | None, typer.Option(help="Horizontal component.")] = None,
    figure: Annotated[Path | None, typer.Option(help="Draw motion and spectrum (.png, .pdf, .svg, .jpg).")] = None,
    out: Annotated[Path | None, typer.Option(help="Write the motion as netCDF.")] = None,
) -> None:
    """List the shipped motions, or describe, draw and convert one."""
    from grids.motions import find, list_shipped, read_motion
    from grids.motions.locate import split_source
    from models.errors import InputError

    sources = list(list_shipped()) if file is None else find(file)
    if (figure or out) and (file is None or len(sources) > 1):
        raise InputError(f"{len(sources)} motions: name one to draw or to write it")
    for source in sources:
        typer.echo(repr(read_motion(source, component=component)))
    if file is None or len(sources) > 1:
        return
    if out is not None and isinstance(sources[0], str):
        keep_inputs([out], [Path(split_source(sources[0])[0])])
    if out is not None:
        keep_others(out)
    motion = read_motion(sources[0], component=component)
    _describe(motion)
    if out is not None:
        from grids.motions.write import write_motion

        typer.echo(f"written: {write_motion(motion, out)}")
    if figure is not None:
        from study.figures import plot_motion, save_figure

        typer.echo(f"written: {save_figure(lambda: plot_motion(motion), figure)}")


def _describe(motion: Motion) -> None:
    """Intensity measures, source and what was done."""
    from grids.motions.intensity import intensity_measures
    from grids.plausibility import suspicions_of_peak
    from rocking.commands.base import warn

    measures = intensity_measures(motion)
    rows = {
        "PGA": f"{measures.pga:.4g} m s-2",
        "PGV": f"{measures.pgv:.4g} m s-1",
        "PGD": f"{measures.pgd:.4g} m",
        "Arias intensity": f"{measures.arias:.4g} m s-1",
        "5-95 % duration": f"{measures.significant_duration:.4g} s from {measures.start:.4g} s on",
        "velocity": measures.rule,
        **{str(key): str(value) for key, value in motion.source.items()},
        "fingerprint": motion.fingerprint,
    }
    for name, text in rows.items():
        typer.echo(f"  {name:<16} {text}")
    for note in motion.notes:
        typer.echo(f"  note: {note}")
    warn(suspicions_of_peak(motion.name, motion.pga), False)
