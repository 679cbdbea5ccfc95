"""Specimens and recordings as they are, or as the files that hold them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from grids.recordings import Recording, read_recording
from grids.specimen import Specimen, read_specimen


def specimen_of(given: Specimen | str | Path) -> Specimen:
    """A specimen, read where its file is named. Raises InputError."""
    return given if isinstance(given, Specimen) else read_specimen(given)


def recordings_of(given: Sequence[Recording | str | Path] | Recording | str | Path) -> list[Recording]:
    """Recordings, or one, read where their files are named. Raises InputError."""
    given = [given] if isinstance(given, Recording | str | Path) else given
    return [one if isinstance(one, Recording) else read_recording(one) for one in given]
