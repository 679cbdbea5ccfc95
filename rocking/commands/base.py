"""What the commands share: a user's mistake is one sentence and exit code 2; selections; output."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import typer
from typer.core import TyperGroup

from models.errors import InputError
from rocking.command import INTERRUPTED, STOPPED, raise_interrupts

if TYPE_CHECKING:
    import xarray as xr

USER_ERROR = 2
FAILURES = 1


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
    return f"{error.filename}: {what}; name another place, or make this one writable." if error.filename else f"{what}."


def read_selection(cube: xr.Dataset, entries: Sequence[str]) -> dict[str, Any]:
    """``["restitution=0.9", "pga=0.3 g"]`` as SI values by axis; InputError for what is no axis."""
    from grids.units import to_si

    found: dict[str, Any] = {}
    for entry in entries:
        name, equals, text = entry.partition("=")
        name, text = name.strip(), text.strip()
        if not equals or not text:
            raise InputError(f"selection '{entry}': write axis=value, for instance restitution=0.9")
        axis = cube.coords.get(name) if name in cube.dims else None
        if axis is None or axis.dtype.kind not in "iuf":
            found[name] = text
        else:
            unit = str(axis.attrs["units"])
            found[name] = to_si(float(text) if _is_number(text) else text, unit, f"selection {name}")
    return found


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


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
