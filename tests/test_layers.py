"""The rooms import in one direction only: rocking -> diagnosis -> study -> grids -> models."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

import models
from tests.sources import FILES, ORDER, ROOT, TESTS, imported_modules, imported_names

LONGEST = 400


def imported_rooms(path: Path) -> set[str]:
    return {module.split(".")[0] for module in imported_modules(path)} & set(ORDER)


@pytest.mark.parametrize("path", FILES, ids=lambda p: p.relative_to(ROOT).as_posix())
def test_a_room_imports_only_rooms_below_it(path: Path) -> None:
    room = path.relative_to(ROOT).parts[0]
    allowed = set(ORDER[: ORDER.index(room) + 1])
    assert imported_rooms(path) <= allowed


@pytest.mark.parametrize("path", FILES, ids=lambda p: p.relative_to(ROOT).as_posix())
def test_no_file_is_too_long(path: Path) -> None:
    assert len(path.read_text().splitlines()) <= LONGEST


@pytest.mark.parametrize("path", TESTS, ids=lambda p: p.relative_to(ROOT).as_posix())
def test_a_test_imports_no_other_test_and_no_private_name(path: Path) -> None:
    """What tests share is in modules that are no tests; what they hold to account is public."""
    for name in imported_names(path):
        room, *parts = name.split(".")
        if room in (*ORDER, "benchmarks", "tests"):
            assert not any(part.startswith("_") and not part.startswith("__") for part in parts), name
            assert room != "tests" or not any(part.startswith("test_") for part in parts), name


FOLDERS = ("data", "fit", "errors", "forces", "search", "answer", "report", "outcomes", "prove")
"""Of the diagnosis, the way of a recording: each imports those before it. ``progress`` serves all of them."""
STEPS = sorted(path for folder in FOLDERS for path in (ROOT / "diagnosis" / folder).rglob("*.py"))


@pytest.mark.parametrize("path", STEPS, ids=lambda p: p.relative_to(ROOT).as_posix())
def test_the_diagnosis_imports_in_the_order_of_its_folders(path: Path) -> None:
    allowed = {"progress", *FOLDERS[: FOLDERS.index(path.relative_to(ROOT).parts[1]) + 1]}
    for module in imported_modules(path):
        room, _, rest = module.partition(".")
        assert room != "diagnosis" or rest.partition(".")[0] in allowed, module


OF_A_MODEL = re.compile(r"rotation_[12]|contact_[12]|displacement_[12]|bearing_|\bimpacts?\b|compression_")
"""What only a model's own declaration may say."""


@pytest.mark.parametrize("path", STEPS, ids=lambda p: p.relative_to(ROOT).as_posix())
def test_the_diagnosis_knows_no_model(path: Path) -> None:
    """Neither a model by its name, nor a channel, state or event of one."""
    names = set(models.MODELS)
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            assert node.value not in names and not any(f'"{name}"' in node.value for name in names), node.value
            assert not OF_A_MODEL.search(node.value), node.value
        if isinstance(node, ast.Name | ast.Attribute | ast.arg):
            name = node.id if isinstance(node, ast.Name) else node.attr if isinstance(node, ast.Attribute) else node.arg
            assert not OF_A_MODEL.search(name) and name not in names, name
        if isinstance(node, ast.ImportFrom):
            assert not any((node.module or "").startswith(f"models.{name}") for name in names), node.module
