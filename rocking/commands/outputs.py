"""Where commands write: never over what they read, nor over a file that none of them wrote."""

from __future__ import annotations

import re
from collections.abc import Iterable
from mmap import ACCESS_READ, mmap
from os.path import isfile
from pathlib import Path

from grids.writer import WRITER
from models.errors import InputError

STUDY = ("cube.nc", "manifest.json", "study.toml", "blocks", "failed")
"""What `run` writes into a study's folder and other commands read there."""
ANSWER = ("diagnosis.json", "extended.toml", "posterior.nc", "fit.nc", "report.html", "law.csv", "runs.csv")
"""Files of the answer of a diagnosis."""


def keep_inputs(outputs: Iterable[Path], inputs: Iterable[Path]) -> None:
    """Raise InputError when a file to write is one of the ``inputs`` or lies in one that is a folder.

    A table and the TOML that describes it are one input, whichever of them is named, and so are a specimen and its law.
    """
    read = [one.resolve() for path in inputs for one in _with_companions(path)]
    for output in outputs:
        written = output.resolve()
        for path in read:
            if path == written or path in written.parents:
                raise InputError(f"{output} would be written over an input of this command; name another place for it.")


def keep_others(output: Path) -> None:
    """Raise InputError when ``output`` is there and not from here: `WRITER` stands in the netCDF and TOML written.

    A table is kept that a TOML beside it describes: a recording, or outcomes.
    """
    if not isfile(output) or not output.stat().st_size:
        return
    with output.open("rb") as file, mmap(file.fileno(), 0, access=ACCESS_READ) as held:
        ours = held.find(WRITER.encode()) >= 0 or output.suffix not in (".nc", ".toml")
    if not ours or (output.suffix == ".csv" and output.with_suffix(".toml").exists()):
        raise InputError(f"{output} is there and was not written by this program: remove it, or give another name.")


def in_study(folder: Path) -> list[Path]:
    """What is read of a study's folder, or of the file of a cube."""
    return [folder] if folder.is_file() else [folder / name for name in STUDY]


def in_answer(folder: Path) -> list[Path]:
    """The files of the answer of a diagnosis."""
    return [folder / name for name in ANSWER]


def _with_companions(path: Path) -> list[Path]:
    beside = {".csv": ".toml", ".txt": ".toml", ".toml": ".csv"}.get(path.suffix.lower())
    companions = [] if beside is None else [path.with_suffix(beside)]
    if path.suffix.lower() == ".toml" and path.is_file():
        laws = re.findall(r'^\s*file\s*=\s*["\'](.+)["\']', path.read_text("utf-8", "replace"), re.MULTILINE)
        companions += [path.parent / name for name in laws]
    return [path, *(one for one in companions if one.exists())]
