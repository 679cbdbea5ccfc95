"""The page on diagnosis.json lists its keys, and no others."""

from __future__ import annotations

import re
from pathlib import Path

from models.mechanisms.table_force import ON_WALL, TABLES
from tests.diagnosis.report.schema import AnswerFile

PAGE = Path(__file__).resolve().parents[3] / "docs" / "diagnosis_json.md"


def test_every_key_of_the_answer_is_described() -> None:
    keys, terms = PAGE.read_text(encoding="utf-8").split("## A law in a table")
    assert re.findall(r"^\| `(\w+)` \|", keys, re.MULTILINE) == list(AnswerFile.model_fields)
    assert re.findall(r"^\| `(\w+)` \|", terms, re.MULTILINE) == [*TABLES.terms, *ON_WALL.terms]
