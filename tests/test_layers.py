"""The rooms import in one direction only: rocking -> diagnosis -> study -> grids -> models."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

import models
from tests.sources import FILES, ORDER, ROOT, TESTS, imported_modules, imported_names, nodes, place

LONGEST = 400


def imported_rooms(path: Path) -> set[str]:
    return {module.split(".")[0] for module in imported_modules(path)} & set(ORDER)


@pytest.mark.parametrize("room", ORDER)
def test_a_room_imports_only_rooms_below_it(room: str) -> None:
    allowed = set(ORDER[: ORDER.index(room) + 1])
    for path in FILES[room]:
        assert imported_rooms(path) <= allowed, place(path)


@pytest.mark.parametrize("room", ORDER)
def test_no_file_is_too_long(room: str) -> None:
    for path in FILES[room]:
        assert len(path.read_text().splitlines()) <= LONGEST, place(path)


def test_a_test_imports_no_other_test_and_no_private_name() -> None:
    """What tests share is in modules that are no tests; what they hold to account is public."""
    for path in TESTS:
        for name in imported_names(path):
            room, *parts = name.split(".")
            if room in (*ORDER, "benchmarks", "tests"):
                private = any(part.startswith("_") and not part.startswith("__") for part in parts)
                assert not private, f"{place(path)}: {name}"
                assert room != "tests" or not any(part.startswith("test_") for part in parts), f"{place(path)}: {name}"


FOLDERS = ("data", "fit", "errors", "forces", "search", "answer", "report", "outcomes", "prove")
"""Of the diagnosis, the way of a recording: each imports those before it. ``progress`` serves all of them."""
STEPS = {folder: sorted((ROOT / "diagnosis" / folder).rglob("*.py")) for folder in FOLDERS}


@pytest.mark.parametrize("folder", FOLDERS)
def test_the_diagnosis_imports_in_the_order_of_its_folders(folder: str) -> None:
    allowed = {"progress", *FOLDERS[: FOLDERS.index(folder) + 1]}
    for path in STEPS[folder]:
        for module in imported_modules(path):
            room, _, rest = module.partition(".")
            assert room != "diagnosis" or rest.partition(".")[0] in allowed, f"{place(path)}: {module}"


OF_A_MODEL = re.compile(r"rotation_[12]|contact_[12]|displacement_[12]|bearing_|\bimpacts?\b|compression_")
"""What only a model's own declaration may say."""


@pytest.mark.parametrize("folder", FOLDERS)
def test_the_diagnosis_knows_no_model(folder: str) -> None:
    """Neither a model by its name, nor a channel, state or event of one."""
    names = set(models.MODELS)
    for path, node in nodes(STEPS[folder]):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            said = f"{place(path)}: {node.value}"
            assert node.value not in names and not any(f'"{name}"' in node.value for name in names), said
            assert not OF_A_MODEL.search(node.value), said
        if isinstance(node, ast.Name | ast.Attribute | ast.arg):
            name = node.id if isinstance(node, ast.Name) else node.attr if isinstance(node, ast.Attribute) else node.arg
            assert not OF_A_MODEL.search(name) and name not in names, f"{place(path)}: {name}"
        if isinstance(node, ast.ImportFrom):
            of_one = any((node.module or "").startswith(f"models.{name}") for name in names)
            assert not of_one, f"{place(path)}: {node.module}"
