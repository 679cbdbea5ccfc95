"""``rocking diagnose specimen.toml REC... --holdout REC --out DIR``: what the model leaves out."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryFile
from typing import TYPE_CHECKING, Annotated

import typer

from models.errors import InputError
from rocking.commands.base import STRICT, warn
from rocking.commands.outputs import in_answer, keep_inputs
from rocking.commands.recordings import read_recordings, stages, warn_of_recordings

if TYPE_CHECKING:
    from grids.specimen import Specimen

FIGURES = "figures"
"""Folder of the figures of an answer."""
FEWEST_DRAWS = 19
"""Of a bootstrap: with so many none as large is a p-value of .05."""


def diagnose(
    specimen: Annotated[Path, typer.Argument(help="Specimen file (TOML).")],
    out: Annotated[Path, typer.Option(help="Folder of the answer.")],
    recordings: Annotated[
        list[Path] | None, typer.Argument(help="Recordings to learn from (.nc, or .csv with .toml).")
    ] = None,
    holdout: Annotated[
        list[Path] | None, typer.Option(help="Recording that only tests the answer (may be repeated).")
    ] = None,
    bootstrap: Annotated[
        int, typer.Option(help="Draws of a parametric bootstrap for the p-value, 99 for instance.", min=0)
    ] = 0,
    outcomes: Annotated[
        Path | None,
        typer.Option(help="Runs of which is known only whether they overturned the specimen (TOML), no recordings."),
    ] = None,
    strict: Annotated[bool, typer.Option("--strict", help=STRICT)] = False,
) -> None:
    """Say what the model leaves out of recordings, model it, and show the fit improve.

    Writes diagnosis.json, report.html, extended.toml, posterior.nc (samples of what was found), fit.nc and figures;
    law.csv where a law is given in a table; with --outcomes runs.csv in the place of fit.nc. Ctrl-C ends the search, or
    the bootstrap or the intervals after it, and writes what was found until then. The exit code is 0 whatever is
    found, 2 for unusable input.
    """
    from grids.plausibility import suspicions_of_specimen
    from grids.specimen import read_specimen

    given = [specimen, *(recordings or []), *(holdout or []), *([outcomes] if outcomes else [])]
    keep_inputs(in_answer(out), given)
    if 0 < bootstrap < FEWEST_DRAWS:
        raise InputError(
            f"--bootstrap {bootstrap}: so few draws tell no p-value below {1 / (1 + bootstrap):.2g}; "
            f"give {FEWEST_DRAWS} or more, 99 for instance."
        )
    wall = read_specimen(specimen)
    warn(suspicions_of_specimen(wall), strict)
    if outcomes is not None:
        if recordings or holdout or bootstrap:
            raise InputError("--outcomes takes no recordings, --holdout or --bootstrap: leave them out")
        of_outcomes(wall, outcomes, out, strict)
        return
    if not recordings:
        raise InputError("no recording is named: give one or more, or --outcomes TABLE")
    read = read_recordings(recordings, holdout or [], strict=strict)
    warn_of_recordings(wall, read, strict)
    train, test = read[: len(recordings)], read[len(recordings) :]
    make_folder(out)
    with stages("stopped; nothing was written") as progress:
        from diagnosis import diagnose as diagnose_recordings
        from diagnosis.report import write_answer

        found = diagnose_recordings(wall, train, test, bootstrap=bootstrap, progress=progress)
    typer.echo(found.statement)  # before the disk can refuse the rest
    with stages(f"stopped while the answer was written; {out} is not complete") as progress:
        progress("writing the report", 0.98)
        paths = write_answer(found, wall, train, test, out)
    typer.echo("written: " + ", ".join(str(path) for path in paths), err=True)


def of_outcomes(wall: Specimen, table: Path, out: Path, strict: bool) -> None:
    """The diagnosis of runs of which only the outcomes are known."""
    from diagnosis.outcomes import diagnose_outcomes
    from diagnosis.outcomes.files import write_answer
    from grids.plausibility import suspicions_of_outcomes
    from grids.recordings.outcomes import read_outcomes

    runs = read_outcomes(table)
    warn(suspicions_of_outcomes(runs), strict)
    make_folder(out)
    with stages("stopped; nothing was written") as progress:
        found = diagnose_outcomes(wall, runs, progress=progress)
    typer.echo(found.statement)
    with stages(f"stopped while the answer was written; {out} is not complete"):
        paths = write_answer(found, wall, out)
    typer.echo("written: " + ", ".join(str(path) for path in paths), err=True)


def make_folder(out: Path) -> None:
    """The folder of the answer, before the work; InputError where it cannot be made or written to."""
    try:
        out.mkdir(parents=True, exist_ok=True)
    except (FileExistsError, NotADirectoryError):
        raise InputError(f"--out {out} is a file or lies in one; name a folder.") from None
    except OSError as error:
        why = (error.strerror or str(error)).lower()
        raise InputError(f"--out {out} cannot be made ({why}); name a folder elsewhere.") from None
    for path in in_answer(out):
        if path.is_dir():
            raise InputError(f"{path} is a folder where the answer has a file; move it, or name another --out.")
    if (out / FIGURES).exists() and not (out / FIGURES).is_dir():
        raise InputError(f"{out / FIGURES} is a file where the answer has a folder; move it, or name another --out.")
    try:
        with TemporaryFile(dir=out):
            pass
    except OSError as error:
        why = (error.strerror or str(error)).lower()
        raise InputError(f"--out {out} cannot be written to ({why}); make it writable, or name another.") from None
