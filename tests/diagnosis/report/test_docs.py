"""The page on diagnosis.json lists its keys and no others, and describes those inside."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any, Literal, get_args, get_origin

import pytest
from pydantic import BaseModel

from models.mechanisms.table_force import ON_WALL, TABLES
from tests.diagnosis.report.schema import AnswerFile, ErrorsPart, ProvenancePart

PAGE = Path(__file__).resolve().parents[3] / "docs" / "diagnosis_json.md"
ROW = re.compile(r"^\| (`[^|]+`) \| (.*) \|$", re.MULTILINE)
KEY = re.compile(r"`([\w-]+)`")


def sections() -> dict[str, str]:
    """Text of the page by heading, what stands before the first one under ""."""
    first, *others = PAGE.read_text(encoding="utf-8").split("\n## ")
    return {"": first} | {heading: text for heading, _, text in (one.partition("\n") for one in others)}


def rows(text: str) -> dict[str, str]:
    """The lines of a table: first column, and the rest."""
    return dict(ROW.findall(text))


def listed(text: str) -> list[str]:
    """The keys in the first column of a table."""
    return [key for keys in rows(text) for key in KEY.findall(keys)]


def keys_of(part: Any) -> set[str]:
    """Every key that a part of the answer may hold, at any depth; names that depend on the specimen are none."""
    found: set[str] = set()
    if isinstance(part, type) and issubclass(part, BaseModel):
        for name, field in part.model_fields.items():
            found |= {field.alias or name} | keys_of(field.annotation)
    elif get_origin(part) is dict and get_origin(get_args(part)[0]) is Literal:
        found |= {*get_args(get_args(part)[0])} | keys_of(get_args(part)[1])
    elif get_origin(part) is not Literal:
        found |= {key for inner in get_args(part) for key in keys_of(inner)}
    return found


def test_every_key_of_the_answer_is_described() -> None:
    page = sections()
    assert listed(page[""]) == list(AnswerFile.model_fields)
    assert listed(page["A law in a table"]) == [*TABLES.terms, *ON_WALL.terms]


@pytest.mark.parametrize(("heading", "part"), [("`errors`", ErrorsPart), ("`provenance`", ProvenancePart)])
def test_a_part_with_a_table_of_its_own_has_a_line_for_every_key(heading: str, part: type[BaseModel]) -> None:
    assert listed(sections()[heading]) == [field.alias or name for name, field in part.model_fields.items()]


@pytest.mark.parametrize("key", AnswerFile.model_fields)
def test_keys_inside_are_described_where_they_stand(key: str) -> None:
    """In the line of the key, in the section of that name, or in the line of another key to which it refers."""
    page = sections()
    lines = {name.strip("`"): text for name, text in rows(page[""]).items()}
    own = lines[key] + page.get(f"`{key}`", "")
    told = set(KEY.findall(own + " ".join(lines.get(name, "") for name in KEY.findall(own))))
    assert keys_of(AnswerFile.model_fields[key].annotation) <= told
