"""Where motions are found: shipped with the project, beside the plan, in the data folder."""

from __future__ import annotations

import glob
import re
from collections.abc import Iterator, Mapping
from fnmatch import fnmatchcase
from os.path import isfile  # False for a name that is too long for a file
from pathlib import Path
from typing import Any

from grids.data_folder import data_folder
from grids.motions.made import each, parse_made
from grids.motions.readers import READERS, Reader, at2, npz
from models.errors import InputError, nearest

SHIPPED = Path(__file__).parent / "shipped"


def list_shipped() -> tuple[str, ...]:
    """Names of the motions that ship with the project."""
    return tuple(sorted(path.stem for path in SHIPPED.glob("*.nc")))


def reader_of(path: Path) -> Reader:
    """The reader of a file, by the ending of its name."""
    suffix = path.suffix.lower()
    for reader in READERS:
        if suffix in reader.suffixes:
            return reader
    if suffix == ".toml":
        raise InputError(f"{path.name}: a TOML file holds no samples; name the table that it describes (.csv).")
    known = ", ".join(s for reader in READERS for s in reader.suffixes)
    raise InputError(f"{path.name}: no reader for the ending {suffix or 'that it lacks'!r}; known: {known}.")


def split_source(source: str) -> tuple[str, str | None]:
    """File and key of ``file.npz:key``; a colon elsewhere belongs to the path."""
    match = re.fullmatch(r"(.+\.npz):(.*)", source, re.I)
    return (match[1], match[2]) if match else (source, None)


def file_of(source: str) -> Path | None:
    """The file that a source names; None of a motion that is made."""
    return None if parse_made(source) is not None else Path(split_source(source)[0])


def _folders(near: Path | None, only_own: bool = False) -> list[Path]:
    """Folders that a relative path is looked for in, in this order; without those of others if ``only_own``."""
    data = data_folder()
    own = [*([] if near is None else [near if near.is_dir() else near.parent]), Path.cwd()]
    return own if only_own else [*own, SHIPPED, *([data / "motions", data] if data else [])]


def locate(source: str, near: Path | None = None) -> tuple[Path, str | None]:
    """Path and key of a motion: beside the plan, in the current folder, shipped, in the data folder."""
    name, key = split_source(source)
    wanted = Path(name).expanduser()
    if wanted.is_absolute():
        if isfile(wanted):
            return wanted, key
        raise InputError(f"motion {source!r}: there is no such file; {_cure(wanted.name, [wanted.parent])}")
    for folder in _folders(near):
        if isfile(folder / wanted):
            return folder / wanted, key
    if isfile(SHIPPED / f"{name}.nc"):
        return SHIPPED / f"{name}.nc", key
    folders = [folder / wanted.parent for folder in _folders(near)]
    raise InputError(
        f"motion {source!r} is not beside the file that names it, in the current folder, among the shipped ones "
        f"or in the data folder (ROCKING_DATA); {_cure(wanted.name, folders)}"
    )


def _cure(name: str, folders: list[Path]) -> str:
    endings = {suffix for reader in READERS for suffix in reader.suffixes}
    found = {p.name for f in folders if f.is_dir() for p in f.iterdir() if p.suffix.lower() in endings}
    close = nearest(name, found | set(list_shipped()))
    return close if close.startswith("did") else f"shipped: {', '.join(list_shipped())}"


def _is_pattern(text: str) -> bool:
    return any(mark in text for mark in "*?[")


def find(source: str | Mapping[str, Any], near: Path | None = None) -> list[str | dict[str, Any]]:
    """The sources that one stands for: files of a glob, in the order of their names; seeds; else itself.

    Both the file and the key may be globs ("RSN*.AT2", "strong_motion_83.npz:*_NS"). Vertical
    components are left out: they come with the horizontal ones of their record.
    """
    if isinstance(source, str):
        source = parse_made(source) or source
    if isinstance(source, Mapping):
        return [*each(source)]
    name, key = split_source(source)
    if not _is_pattern(name) and not _is_pattern(key or ""):
        return [source]
    found: list[str | dict[str, Any]] = []
    for path in _matching(name, near):
        if key is not None:
            found += [f"{path}:{k}" for k in _matching_keys(path, key)]
        elif not (path.suffix.lower() in at2.AT2.suffixes and at2.is_vertical(path)):
            found.append(str(path))
    if not found:
        where = " beside the file that names it and in the current folder" if _of_the_user(name) else ""
        raise InputError(f"motion {source!r}: nothing matches{where}; {_cure(name, _folders(near))}")
    return found


def _of_the_user(pattern: str) -> bool:
    """Whether files of the user alone are meant: by "*.csv" and the like, not all that is shipped or downloaded."""
    return _is_pattern(str(Path(pattern))[0])  # without the ./ before it


def _matching(name: str, near: Path | None) -> Iterator[Path]:
    """The files of the first folder in which anything matches."""
    if not _is_pattern(name):
        yield locate(name, near)[0]
        return
    wanted = Path(name).expanduser()
    bases = [Path(wanted.anchor)] if wanted.is_absolute() else _folders(near, _of_the_user(name))
    for base in bases:
        relative = wanted.relative_to(wanted.anchor) if wanted.is_absolute() else wanted
        paths = [base / p for p in glob.glob(str(relative), root_dir=base, recursive=True)]
        matches = sorted(p for p in paths if p.is_file() and _readable(p))
        if matches:
            yield from matches
            return


def _readable(path: Path) -> bool:
    return any(path.suffix.lower() in reader.suffixes for reader in READERS)


def _matching_keys(path: Path, key: str) -> list[str]:
    keys = npz.keys_of(path)
    if not _is_pattern(key):
        return [key]
    return sorted(k for k in keys if fnmatchcase(k, key) and not npz.is_vertical(k))
