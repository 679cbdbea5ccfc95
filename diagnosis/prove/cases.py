"""The files of concealed cases, and the form of keys and answers: what scoring needs is there before it begins."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import ConfigDict, Field

from grids.files import Schema, check
from models.errors import InputError

FILES = ("specimen.toml", "train_1.nc", "train_2.nc", "test_1.nc")
Pair = Annotated[list[float], Field(min_length=2, max_length=2)]


class Open(Schema):
    """Other entries may stand beside those that are scored."""

    model_config = ConfigDict(extra="ignore", frozen=True, strict=True)


class Named(Open):
    name: str
    effect_class: str = Field(alias="class")


class Hidden(Named):
    parameters: dict[str, float] = Field(default_factory=dict)


class Note(Open):
    """Of one recording."""

    strength: float | dict[str, float] | None = None
    duration: float = 0.0
    active: list[Pair] = Field(default_factory=list)
    active_interval: Pair | None = None
    cycles: list[float] = Field(default_factory=list)


class Entry(Open):
    """Of one case in the key."""

    kind: Literal["null", "mismatch", "single", "pair", "open"]
    effects: list[Hidden]
    weak: bool = False
    recordings: dict[str, Note] = Field(default_factory=dict)
    true_parameters: dict[str, float] = Field(default_factory=dict)
    imperfections: dict[str, Any] | list[str] = Field(default_factory=dict)
    named_rightly: list[str] = Field(default_factory=list)


class Key(Open):
    cases: dict[str, Entry]


class Interval(Open):
    low95: float
    high95: float


class Said(Named):
    parameters: dict[str, Interval]
    evidence: float


class Rival(Named):
    evidence_gap: float


class Located(Open):
    recording: str
    start: float
    end: float


class HeldOut(Open):
    share_of_achievable: float | None


class Fit(Open):
    holdout: HeldOut | None


class Answer(Open):
    """Of the diagnosis, as it is kept."""

    verdict: str
    effects: list[Said]
    rivals: list[Rival]
    located: list[Located]
    base: dict[str, Interval]
    fit: Fit | None = None
    seconds: float


def check_files(folders: Iterable[Path]) -> None:
    """Raise InputError unless every case has its files."""
    for folder in folders:
        for name in FILES:
            if not (folder / name).is_file():
                raise InputError(f"{folder} has no {name}; a case needs {', '.join(FILES)}: add it.")


def check_key(path: Path, content: Mapping[str, Any], cases: Iterable[str]) -> None:
    """Raise InputError unless the key has an entry of the right form for each of ``cases``."""
    _check(Key, path, content)
    for name in cases:
        if name not in content["cases"]:
            raise InputError(f"{path} has no entry for {name}; add it, or take the case away.")


def check_answer(path: Path, content: Mapping[str, Any]) -> None:
    """Raise InputError unless a kept answer can be scored."""
    _check(Answer, path, content)


def _check(schema: type[Schema], path: Path, content: Mapping[str, Any]) -> None:
    try:
        check(schema, dict(content))
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
