"""Specimens and recordings as they are, or as the files that hold them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from grids.recordings import Recording, read_recording
from grids.recordings.checked import checked
from grids.specimen import Specimen, read_specimen
from models.errors import InputError


def specimen_of(given: Specimen | str | Path) -> Specimen:
    """A specimen, read where its file is named. Raises InputError."""
    if isinstance(given, str | Path):
        return read_specimen(given)
    if not isinstance(given, Specimen):
        raise InputError(_refusal("specimen", given))
    return given


def recordings_of(given: Sequence[Recording | str | Path] | Recording | str | Path) -> list[Recording]:
    """Recordings, or one, read where their files are named, else checked. Raises InputError."""
    alone = (Recording, str, Path, Mapping)  # a Mapping, as a Dataset is, would be taken for a list of its names
    if isinstance(given, alone) or not isinstance(given, Iterable):
        given = [given]
    return [_recording(one) for one in given]


def _recording(given: Recording | str | Path) -> Recording:
    if isinstance(given, str | Path):
        return read_recording(given)
    if not isinstance(given, Recording):
        raise InputError(_refusal("recording", given))
    return checked(given)


def _refusal(what: str, given: object) -> str:
    return f"{what} is of type {type(given).__name__}: give what read_{what} returns, or the name of its file"
