"""Where commands write: never over what they read, nor over a file that none of them wrote."""

from __future__ import annotations

import re
from collections.abc import Iterable
from os.path import isfile, realpath
from pathlib import Path

from grids.writer import WRITER, WRITTEN
from models.errors import InputError

STUDY = ("cube.nc", "manifest.json", "study.toml", "blocks", "failed")
"""What `run` writes into a study's folder and other commands read there."""
ANSWER = ("diagnosis.json", "extended.toml", "posterior.nc", "fit.nc", "report.html", "law.csv", "runs.csv")
"""Files of the answer of a diagnosis."""


def keep_inputs(outputs: Iterable[Path], inputs: Iterable[Path]) -> None:
    """Raise InputError when a file to write is one of the ``inputs`` or lies in one of them.

    A table and the TOML that describes it are one input, whichever of them is named, and so are a specimen and its law.
    """
    # realpath: resolve raises RuntimeError for a link to itself
    read = [Path(realpath(one)) for path in inputs for one in _with_companions(path)]
    for output in outputs:
        written = Path(realpath(output))
        for path in read:
            if path == written or path in written.parents:
                raise InputError(f"{output} would be written over an input of this command; name another place for it.")


def keep_others(output: Path, named_in: Path | None = None) -> None:
    """Raise InputError when ``output`` is there and not from here, as far as files tell (`_is_ours`).

    The law of a specimen tells nothing: it is from here if the specimen ``named_in`` names it.
    """
    if not isfile(output) or not output.stat().st_size:
        return
    if not (_is_ours(output) if named_in is None else output in _with_companions(named_in)):
        raise InputError(f"{output} is there and was not written by this program: remove it, or give another name.")


def _is_ours(path: Path) -> bool:
    """NetCDF files and specimens say it; of a table it is assumed, unless a TOML beside it describes the table."""
    suffix = path.suffix.lower()
    if suffix == ".nc":
        from grids.netcdf_file import read_attributes

        try:
            stated = read_attributes(path)
        except InputError:
            return False
        return stated.get("source", "").startswith(f"{WRITER} ") or stated.get("history") == WRITTEN
    if suffix == ".toml":
        with path.open("rb") as file:
            return file.readline().strip() == f"# {WRITTEN}".encode()
    return suffix != ".csv" or not _is_described(path)


def _is_described(table: Path) -> bool:
    """Whether the TOML of the same name states the columns of a table: a recording, a motion, or outcomes."""
    from grids.files import parse_toml, read_text

    beside = table.with_suffix(".toml")
    if not isfile(beside):
        return False
    try:
        stated = parse_toml(read_text(beside, "the description of the columns"))
    except InputError:
        return True  # what a damaged one describes is not known
    return stated["table"] == table.name if "table" in stated else "columns" in stated


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
