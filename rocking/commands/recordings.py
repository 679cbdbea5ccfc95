"""What `calibrate` and `diagnose` share: reading a specimen and recordings, and showing the stages."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from models.errors import InputError
from rocking.commands.base import warn
from rocking.interrupts import INTERRUPTED

if TYPE_CHECKING:
    from diagnosis.progress import Progress
    from grids.recordings import Recording
    from grids.specimen import Specimen


def read_recordings(paths: Sequence[Path], held_out: Sequence[Path] = (), *, strict: bool = False) -> list[Recording]:
    """All recordings in their order; what was done to them and what looks wrong goes to stderr.

    Raises InputError for a recording given twice, two that share a name, or if ``strict`` an unusual motion of a base.
    """
    from diagnosis.data.measured import left_out
    from grids.plausibility import suspicions_of_recordings
    from grids.recordings import read_recording

    seen: dict[str, Path] = {}
    found = []
    for path in (*paths, *held_out):
        recording = read_recording(path)
        if recording.name in seen:
            both = seen[recording.name].resolve() == path.resolve()
            cure = "a recording held out cannot be fitted too" if path in held_out else "give it once"
            raise InputError(
                f"recording {path} is given twice; {cure}."
                if both
                else f"recordings {seen[recording.name]} and {path} share the name {recording.name}; rename one."
            )
        seen[recording.name] = path
        found.append(recording)
        say(recording)
    warn(suspicions_of_recordings(found), strict)
    for together in (found[: len(paths)], found[len(paths) :]):
        for channel, lacking in left_out(together).items():
            typer.echo(f"note: {channel} is not compared, because {', '.join(lacking)} lacks it", err=True)
    return found


def say(recording: Recording) -> None:
    """What was done to a recording and what looks wrong with it, on stderr."""
    for note in recording.notes:
        typer.echo(f"note: {recording.name}: {note}", err=True)
    for suspicion in recording.suspicions:
        typer.echo(f"suspicion: {recording.name}: {suspicion}", err=True)


def warn_of_recordings(specimen: Specimen, recordings: Sequence[Recording], strict: bool, alone: bool = False) -> None:
    """Warn of what does not go together: stages that fit none of the recordings, channels far from the bodies."""
    from grids.plausibility import suspicions_of_places, suspicions_of_stages

    lengths = {recording.name: float(recording.time[-1]) for recording in recordings}
    warn(suspicions_of_stages(specimen, lengths, alone), strict)
    warn(suspicions_of_places(specimen, {k: v for one in recordings for k, v in one.places.items()}), strict)


@contextmanager
def stages(interrupted: str) -> Iterator[Progress]:
    """A bar on stderr whose callback takes (what is being done, share done).

    A Ctrl-C that nobody else takes ends the command with the sentence ``interrupted``.
    """
    from rich.console import Console
    from rich.progress import BarColumn, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as Bar

    columns: tuple[Any, ...] = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
    try:
        with Bar(*columns, console=Console(stderr=True), transient=True) as bar:
            task = bar.add_task("reading", total=1.0)
            yield lambda text, share: bar.update(task, description=text, completed=share)
    except KeyboardInterrupt:
        typer.echo(interrupted, err=True)
        raise typer.Exit(INTERRUPTED) from None
