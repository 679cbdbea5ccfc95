"""What the commands share: a user's mistake is one sentence and exit code 2; selections; output."""

from __future__ import annotations

import errno
import sys
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

import typer
from typer.core import TyperGroup

from models.errors import InputError
from rocking.interrupts import INTERRUPTED, STOPPED, raise_interrupts

if TYPE_CHECKING:
    import xarray as xr
    from rich.console import Console

    from study.sets.cells import Event

NumberT = TypeVar("NumberT", int, float)
USER_ERROR = 2
FAILURES = 1
WIDE = 200
"""Columns of a table that goes into a file or a pipe."""


class Commands(TyperGroup):
    """The group of commands, which turns a mistake, what the disk refuses and Ctrl-C into a sentence."""

    def invoke(self, ctx: Any) -> Any:
        try:
            raise_interrupts()
            return super().invoke(ctx)
        except InputError as error:
            typer.echo(f"error: {error}", err=True)
            raise typer.Exit(USER_ERROR) from None
        except BrokenPipeError:  # of `rocking ... | head`: typer ends that quietly
            raise
        except OSError as error:
            typer.echo(f"error: {_refusal(error)}", err=True)
            raise typer.Exit(USER_ERROR) from None
        except KeyboardInterrupt:
            typer.echo(STOPPED, err=True)
            raise typer.Exit(INTERRUPTED) from None


def _refusal(error: OSError) -> str:
    """What the operating system refuses (a full disk, rights, a path that cannot be), and where."""
    if error.strerror is None:
        return str(error)
    what = error.strerror[0].lower() + error.strerror[1:]
    if not error.filename:
        return f"{what}."
    full = error.errno in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO)
    cure = "make room there, or name another place." if full else "name another place, or make this one writable."
    return f"{error.filename}: {what}; {cure}"


def console() -> Console:
    """For tables: as wide as the terminal, and where there is none as wide as a table may get."""
    from rich.console import Console

    return Console(width=None if sys.stdout.isatty() else WIDE)


SELECT = "AXIS=VALUE with its unit, for instance 'pga=0.3 g'"
NEAREST = "Take the nearest values of the grid for what --select gives off it."


def read_selection(cube: xr.Dataset, entries: Sequence[str] | None, nearest: bool) -> dict[str, Any]:
    """``["restitution=0.9", "pga=0.3 g"]`` as values of the grid by axis; errors as in `study.selection.select`."""
    from study.selection import on_grid

    found: dict[str, Any] = {}
    for entry in entries or ():
        name, equals, text = (part.strip() for part in entry.partition("="))
        if not equals or not text:
            raise InputError(f"selection '{entry}': write axis=value, for instance restitution=0.9")
        if name in found:
            raise InputError(f"selection '{entry}': {name} is selected twice; leave one out")
        found[name] = text
    return on_grid(cube, found, nearest=nearest)


def read_event(cube: xr.Dataset, text: str | None) -> Event:
    """``"peak_rotation > 2 deg"`` as an event of the cube; overturning without a text. Raises InputError."""
    from grids.units import to_si
    from study.selection import lacks_unit
    from study.sets.cells import event_of, unit_of

    if text is None:
        return event_of(cube)
    output, sign, value = (part.strip() for part in text.partition(">"))
    if not sign or not value:
        raise InputError(f"event '{text}': write OUTPUT > VALUE, for instance 'peak_rotation > 2 deg'")
    unit = unit_of(cube, output)
    if unit != "1" and lacks_unit(value):
        raise InputError(f"event '{text}' has no unit; write '{output} > {value} {unit}', or another unit of it")
    return event_of(cube, output, to_si(value, unit, f"event '{text}'"))


STRICT = "Refuse what is unusual (a block 1500 m high, a PGA over 5 g) instead of warning."


def number(text: str | float) -> float:
    """The number of an option, written as in plans: 1_5 is none."""
    return _plain(text, float, "number; write for example 0.5")


def whole(text: str | int) -> int:
    """The same for a whole number."""
    return _plain(text, int, "whole number; write for example 4")


def _plain(text: object, kind: Callable[[Any], NumberT], said: str) -> NumberT:
    try:
        if "_" in str(text):
            raise ValueError
        return kind(text)
    except ValueError:
        raise typer.BadParameter(f"{text!r} is no {said}") from None


def warn(suspicions: Sequence[str], strict: bool) -> None:
    """Print suspicions as warnings on stderr; InputError with the first one if ``strict``."""
    if strict and suspicions:
        raise InputError(f"{suspicions[0].rstrip('.')} (refused because of --strict)")
    for suspicion in suspicions:
        typer.echo(f"warning: {suspicion}", err=True)


def human_time(seconds: float) -> str:
    """A time as people say it."""
    if seconds < 60.0:
        return f"{seconds:.1f} s"
    minutes = seconds / 60.0
    return f"{minutes:.1f} min" if minutes < 60.0 else f"{minutes / 60.0:.1f} h"


def human_bytes(count: float) -> str:
    """A size with a decimal prefix."""
    for unit in ("B", "kB", "MB", "GB"):
        if count < 1000.0:
            return f"{count:.3g} {unit}"
        count /= 1000.0
    return f"{count:.3g} TB"
