"""``rocking diagnose specimen.toml REC... --holdout REC --out DIR``: what the model leaves out."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rocking.commands.base import STRICT, warn
from rocking.commands.recordings import read_recordings, stages


def diagnose(
    specimen: Annotated[Path, typer.Argument(help="Specimen file (TOML).")],
    recordings: Annotated[list[Path], typer.Argument(help="Recordings to learn from (.nc, or .csv with .toml).")],
    out: Annotated[Path, typer.Option(help="Folder of the answer.")],
    holdout: Annotated[
        list[Path] | None, typer.Option(help="Recording that only tests the answer (may be repeated).")
    ] = None,
    bootstrap: Annotated[
        int, typer.Option(help="Draws of a parametric bootstrap for the p-value, 99 for instance.", min=0)
    ] = 0,
    strict: Annotated[bool, typer.Option("--strict", help=STRICT)] = False,
) -> None:
    """Say what the model leaves out of recordings, model it, and show the fit improve.

    Writes diagnosis.json, extended.toml, report.html, fit.nc and figures. Ctrl-C ends the search, or the
    bootstrap or the intervals after it, and writes what was found until then. The exit code is 0 whatever
    is found, 2 for unusable input.
    """
    from grids.plausibility import suspicions_of_specimen
    from grids.specimen import read_specimen

    wall = read_specimen(specimen)
    warn(suspicions_of_specimen(wall), strict)
    read = read_recordings(recordings, holdout or [])
    train, test = read[: len(recordings)], read[len(recordings) :]
    make_folder(out)
    with stages("stopped; nothing was written") as progress:
        from diagnosis import diagnose as diagnose_recordings
        from diagnosis.report import write_answer

        found = diagnose_recordings(wall, train, test, bootstrap=bootstrap, progress=progress)
    with stages(f"stopped while the answer was written; {out} is not complete") as progress:
        progress("writing the report", 0.98)
        paths = write_answer(found, wall, train, test, out)
    typer.echo(found.statement)
    typer.echo("written: " + ", ".join(str(path) for path in paths), err=True)


def make_folder(out: Path) -> None:
    """The folder of the answer, before the work; InputError where it cannot be made."""
    from models.errors import InputError

    try:
        out.mkdir(parents=True, exist_ok=True)
    except (FileExistsError, NotADirectoryError):
        raise InputError(f"--out {out} is a file or lies in one; name a folder.") from None
    except OSError as error:
        why = (error.strerror or str(error)).lower()
        raise InputError(f"--out {out} cannot be made ({why}); name a folder elsewhere.") from None
