"""``rocking simulate specimen.toml``: one history."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rocking.commands.base import STRICT, number, warn
from rocking.commands.outputs import keep_inputs, keep_others
from rocking.commands.recordings import say, warn_of_recordings


def simulate(
    specimen: Annotated[Path, typer.Argument(help="Specimen file (TOML).")],
    out: Annotated[Path, typer.Option(help="History to write, .nc.")],
    motion: Annotated[
        str | None, typer.Option(help="Shipped motion, motion file, or recording (its base motion).")
    ] = None,
    duration: Annotated[float | None, typer.Option(help="Length of the run in s.", parser=number)] = None,
    integrator: Annotated[str, typer.Option(help="lanes, reference or newmark.")] = "lanes",
    component: Annotated[str | None, typer.Option(help="Horizontal component of the motion.")] = None,
    scale: Annotated[float, typer.Option(help="Factor on the motion.", parser=number)] = 1.0,
    displacement_high_pass: Annotated[
        float | None,
        typer.Option(
            help="Write displacements as integrated from accelerations, high-passed at this corner in Hz.",
            parser=number,
        ),
    ] = None,
    figure: Annotated[Path | None, typer.Option(help="Draw the rotation over time (.png, .pdf, .svg, .jpg).")] = None,
    strict: Annotated[bool, typer.Option("--strict", help=STRICT)] = False,
) -> None:
    """Simulate a specimen and write every observable over time, and the events."""
    from grids.motions.locate import file_of
    from grids.plausibility import suspicions_of_peak, suspicions_of_specimen
    from grids.recordings import Recording
    from grids.specimen import read_specimen, with_mechanism
    from rocking.simulation import recording_of
    from rocking.simulation import simulate as simulate_history
    from study.figures.save import check_suffix
    from study.history import ending, suspicions_of_ending, write_history
    from study.wording import spoken

    if figure is not None:
        check_suffix(figure)
    read = file_of(motion) if motion else None
    keep_inputs([out], [specimen, *([read] if read else [])])
    keep_others(out)
    wall = read_specimen(specimen)
    if displacement_high_pass is not None:
        wall = with_mechanism(wall, "integrated_displacement", {"high_pass_hz": displacement_high_pass})
    warn(suspicions_of_specimen(wall), strict)
    shaken: Recording | str | None = None if motion is None else recording_of(motion) or motion
    if isinstance(shaken, Recording):
        say(shaken)
        warn_of_recordings(wall, [shaken], strict, alone=True)
    history = simulate_history(wall, shaken, duration=duration, integrator=integrator, component=component, scale=scale)
    warn(suspicions_of_peak("the motion", float(abs(history["base_acceleration_x"]).max())), strict)
    warn(suspicions_of_ending(history), strict)
    typer.echo(f"written: {write_history(history, out)} ({history.sizes['event']} events, {spoken(ending(history))})")
    if figure is not None:
        from study.figures import plot_history, save_figure

        typer.echo(f"written: {save_figure(lambda: plot_history(history), figure)}")
