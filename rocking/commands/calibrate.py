"""``rocking calibrate specimen.toml REC...``: the base model's parameters with intervals."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

import models
from models.errors import InputError
from rocking.commands.base import STRICT, console, warn
from rocking.commands.outputs import keep_inputs, keep_others
from rocking.commands.recordings import read_recordings, stages, warn_of_recordings

if TYPE_CHECKING:
    from rich.table import Table

    from diagnosis.answer.calibration import Calibration
    from diagnosis.fit.intervals import Estimate
    from grids.specimen import Specimen


def calibrate(
    specimen: Annotated[Path, typer.Argument(help="Specimen file (TOML).")],
    recordings: Annotated[
        list[Path], typer.Argument(help="Recordings (.nc, or .csv with .toml), in the order of the tests.")
    ],
    out: Annotated[
        Path | None,
        typer.Option(
            help="Specimen file to write, with the fitted values; beside NAME.toml NAME.posterior.nc, and NAME.law.csv."
        ),
    ] = None,
    at_strain: Annotated[
        float | None,
        typer.Option(help="With --out: layers as they were when their largest strain so far was this (0.1 for 10 %)."),
    ] = None,
    at_closings: Annotated[
        int | None,
        typer.Option(help="With --out: layers as they were when their joints had closed this many times so far."),
    ] = None,
    strict: Annotated[bool, typer.Option("--strict", help=STRICT)] = False,
) -> None:
    """Fit the specimen's uncertain parameters to recordings; nothing missing is looked for.

    Prints estimates, 95 % intervals (by profile likelihood), bounds hit, correlations and the profiles; with
    several recordings, in the order of the tests, also what each of them says alone, and of rubber layers whether
    they stay the same over the tests or drift with their largest strain or the number of their closings so far.
    """
    at = exposure_asked(at_strain, at_closings)
    if at is not None and out is None:
        raise InputError(f"--at-{at[0]} says which specimen to write: name its file with --out.")
    if out is not None:
        if out.suffix.lower() != ".toml":
            raise InputError(f"--out {out}: a specimen is written as TOML; end the name in .toml.")
        keep_inputs([out, samples_beside(out), law_of(out)], [specimen, *recordings])
        keep_others(out)
        keep_others(samples_beside(out))
    from diagnosis.answer.calibration import exposure_of
    from grids.plausibility import suspicions_of_specimen
    from grids.specimen import read_specimen
    from grids.write_specimen import law_beside

    wall = read_specimen(specimen)
    if out is not None and law_beside(wall) is not None:
        keep_others(law_of(out), named_in=out)
    if at is not None:
        exposure_of(wall, *at, len(recordings))
    warn(suspicions_of_specimen(wall), strict)
    read = read_recordings(recordings, strict=strict)
    warn_of_recordings(wall, read, strict)
    with stages("stopped") as progress:
        from diagnosis import calibrate as calibrate_recordings

        found = calibrate_recordings(wall, read, progress=progress)
    show = console()
    show.print(parameter_table(wall.title, found))
    if len(found.parameters) > 1:
        show.print(correlation_table(found))
    if found.channels:
        show.print(channel_table(found))
    if found.by_recording:
        show.print(drift_table(found))
    for seen in found.seen:
        show.print(f"Seen in the recordings: {seen}.", highlight=False)
    for drift in found.drifts:
        show.print(f"{drift}.", highlight=False)
    show.print(profile_table(found))
    show.print(
        f"misfit {100 * found.misfit:.3g} % of the signal, noise {100 * found.noise_floor:.3g} %, "
        f"{found.windows} windows",
        highlight=False,
    )
    if out is not None:
        write(wall, found, out, at)


def exposure_asked(strain: float | None, closings: int | None) -> tuple[str, float] | None:
    """What the layers had gone through in the specimen to write, and how much of it; None: all tests together."""
    if strain is not None and closings is not None:
        raise InputError("--at-strain and --at-closings each say which specimen to write: give one of the two.")
    if closings is not None:
        return "closings", float(closings)
    return None if strain is None else ("strain", strain)


def write(wall: Specimen, found: Calibration, out: Path, at: tuple[str, float] | None) -> None:
    """The calibrated specimen as a file, ``at`` an exposure if given; else beside it samples of what was found."""
    from diagnosis.answer.calibration import calibrated_specimen, specimen_at
    from diagnosis.report.posterior_file import write_posterior
    from grids.write_specimen import law_beside, specimen_text
    from study.store import write_text

    chosen = calibrated_specimen(wall, found) if at is None else specimen_at(wall, found, *at)
    write_text(out, specimen_text(chosen, law_of(out).name))
    law = law_beside(chosen)
    if law is not None:
        write_text(law_of(out), law)
    typer.echo(f"written: {out}", err=True)
    if found.posterior and at is None:
        path = write_posterior(found.posterior, models.get(wall.model), wall.title, samples_beside(out))
        typer.echo(f"written: {path}", err=True)
    else:  # those of an earlier calibration of the same name
        samples_beside(out).unlink(missing_ok=True)


def samples_beside(out: Path) -> Path:
    """Where the samples lie of the specimen at ``out``: a folder may hold those of other answers too."""
    return out.with_suffix(".posterior.nc")


def law_of(out: Path) -> Path:
    """Where the law in a table lies of the specimen at ``out``, if it has one."""
    return out.with_suffix(".law.csv")


def parameter_table(title: str, found: Calibration) -> Table:
    """One row a parameter."""
    from rich.table import Table

    table = Table("parameter", title=title, title_justify="left")
    for head in ("estimate", "low 95 %", "high 95 %"):
        table.add_column(head, justify="right")
    table.add_column("unit")
    table.add_column("bound")
    for name, value in found.parameters.items():
        bound = {"low": "at its lower bound", "high": "at its upper bound", "": ""}[value.at_bound]
        table.add_row(name, *_numbers(value), value.unit, bound)
    return table


def correlation_table(found: Calibration) -> Table:
    """The correlation of the estimates, below the diagonal."""
    from rich.table import Column, Table

    names = list(found.parameters)
    table = Table("correlation", *(Column(name, overflow="fold") for name in names[:-1]))
    for i, name in enumerate(names[1:], start=1):
        table.add_row(name, *(f"{found.correlation[i, j]:+.2f}" for j in range(i)))
    return table


def channel_table(found: Calibration) -> Table:
    """What each channel adds: how many times wider the intervals would be without it."""
    from rich.table import Table

    table = Table("without channel", *found.parameters, caption="width of the intervals over that with all channels")
    for channel, wider in found.channels.items():
        table.add_row(channel, *(f"{wider[name]:.3g}" for name in found.parameters))
    return table


def drift_table(found: Calibration) -> Table:
    """What each recording says alone, parameter by parameter."""
    from rich.table import Table

    table = Table("parameter", "recording alone")
    for head in ("estimate", "low 95 %", "high 95 %"):
        table.add_column(head, justify="right")
    table.add_column("unit")
    for name in found.parameters:
        for k, (recording, alone) in enumerate(found.by_recording.items()):
            table.add_row("" if k else name, recording, *_numbers(alone[name]), alone[name].unit)
    return table


def profile_table(found: Calibration) -> Table:
    """By how much twice the log likelihood falls when a parameter is held beside its estimate, all others refitted."""
    from rich.table import Table

    caption = (
        "fall of 2 log likelihood, all others refitted: 3.84 marks 95 % where the model fits to the noise; "
        "the intervals are widened by what it leaves besides"
    )
    table = Table("profile", caption=caption, caption_justify="left")
    for head in ("held at", "fall"):
        table.add_column(head, justify="right")
    table.add_column("unit")
    for name, (at, fall) in found.profiles.items():
        for k, (value, lost) in enumerate(zip(at, fall, strict=True)):
            unit = found.parameters[name].unit
            last = k + 1 == at.size
            table.add_row("" if k else name, f"{value:.5g}", f"{max(lost, 0.0):.3g}", unit, end_section=last)
    return table


def _numbers(value: Estimate) -> tuple[str, str, str]:
    return f"{value.estimate:.5g}", f"{value.low95:.5g}", f"{value.high95:.5g}"
