"""TOML files checked by a pydantic schema, with one sentence for whatever is wrong."""

from __future__ import annotations

import re
import tomllib
from os import PathLike
from pathlib import Path
from typing import Any, TypeVar, get_args

from pydantic import BaseModel, ConfigDict, ValidationError

from models.errors import InputError, nearest

SchemaT = TypeVar("SchemaT", bound="Schema")


class Schema(BaseModel):
    """A table of a file. Unknown keys are mistakes; a number is not guessed from a string."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)


def path_of(given: object, what: str, cure: str = "give the name of its file") -> Path:
    """The path that a call from Python names; InputError of what is none."""
    if not isinstance(given, str | PathLike):
        raise InputError(f"{what} is of type {type(given).__name__}: {cure}")
    return Path(given)


def read_text(path: Path, what: str) -> str:
    """The text of a UTF-8 file; InputError when it is missing or not text."""
    try:
        return path.read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        beside = [p.name for p in path.parent.glob(f"*{path.suffix}")] if path.parent.is_dir() else []
        raise InputError(
            f"{what} {path} does not exist; {nearest(path.name, beside)}"
            if beside
            else f"{what} {path} does not exist; check the path."
        ) from None
    except UnicodeDecodeError:
        raise InputError(f"{what} {path} is not UTF-8 text; save it as UTF-8.") from None
    except OSError as error:
        raise InputError(f"{what} {path} cannot be read: {error.strerror}.") from None
    except ValueError:  # of the path: it has a character that no path can have
        raise InputError(f"{what} {str(path)!r} is no name of a file; correct it.") from None


def parse_toml(text: str) -> dict[str, Any]:
    """The tables of a TOML text; InputError with the line of the mistake."""
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        line = re.search(r"at line (\d+)", str(error))
        shown = text.splitlines()[int(line[1]) - 1].strip() if line else ""
        quoted = f" '{shown}'" if shown else ""
        raise InputError(f"not valid TOML{quoted}: {error}; correct that line.") from None
    except RecursionError:
        raise InputError("not valid TOML: brackets lie thousands deep; is the file damaged?") from None
    except ValueError as error:  # of Python's own numbers: thousands of digits
        raise InputError(f"not valid TOML: {error}; shorten that number.") from None


def check(schema: type[SchemaT], table: dict[str, Any]) -> SchemaT:
    """The table as ``schema``; InputError about what does not fit, misspelt keys first."""
    try:
        return schema.model_validate(table)
    except ValidationError as error:
        found = sorted(error.errors(), key=lambda one: one["type"] != "extra_forbidden")
        raise InputError(_sentence(schema, dict(found[0]))) from None


def _sentence(schema: type[Schema], error: dict[str, Any]) -> str:
    location = [str(part) for part in error["loc"] if not str(part).startswith("function-")]
    kind, value = error["type"], error["input"]
    where = _address(location)
    if kind == "extra_forbidden":
        return f"{where} is not known; {nearest(location[-1], _known(schema, location[:-1]))}"
    if kind == "missing":
        return f"{where} is missing; add it."
    if kind == "value_error":
        return f"{where}: {error['ctx']['error']}"
    if kind == "too_short" and not value:
        return f"{where} is empty; give at least {error['ctx']['min_length']}."
    rule = error["msg"].replace("Input should be", "it must be")
    return f"{where} = {value!r}: {rule[0].lower()}{rule[1:]}."


def _address(location: list[str]) -> str:
    """['motion', 'files', '0'] as '[motion] files 0', a lone key as it stands."""
    return f"[{location[0]}] {' '.join(location[1:])}" if len(location) > 1 else location[0]


def _known(schema: type[Schema], location: list[str]) -> list[str]:
    """Keys of the table at ``location``, also where it may be left out or is one of many, by name or in a list."""
    held: Any = schema
    for part in location:
        inner = _schema_in(held)
        if inner is None:
            break
        if part in inner.model_fields:  # else the name or number of one of many, all of the same schema
            held = inner.model_fields[part].annotation
    found = _schema_in(held)
    return [field.alias or name for name, field in found.model_fields.items()] if found else []


def _schema_in(annotation: Any) -> type[Schema] | None:
    """The schema that a type is or holds: ``Table | None``, ``dict[str, Table]``."""
    if isinstance(annotation, type) and issubclass(annotation, Schema):
        return annotation
    return next((found for found in map(_schema_in, get_args(annotation)) if found), None)
