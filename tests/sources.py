"""The files of the program and of its tests, and what they import."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
ORDER = ("models", "grids", "study", "diagnosis", "rocking")
FILES = {room: sorted((ROOT / room).rglob("*.py")) for room in ORDER}
TESTS = sorted((ROOT / "tests").rglob("*.py"))


def place(path: Path) -> str:
    """Of a file in the project."""
    return path.relative_to(ROOT).as_posix()


@cache
def tree(path: Path) -> ast.Module:
    """What a file says."""
    return ast.parse(path.read_text("utf-8"))


def nodes(paths: Iterable[Path]) -> Iterator[tuple[Path, ast.AST]]:
    """Every node of some files, beside its file."""
    for path in paths:
        for node in ast.walk(tree(path)):
            yield path, node


def imported_modules(path: Path) -> set[str]:
    """Names of the modules that a file imports, or imports something from."""
    found: set[str] = set()
    for node in ast.walk(tree(path)):
        if isinstance(node, ast.Import):
            found.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{place(path)}: relative import"
            found.add(node.module or "")
    return found


def imported_names(path: Path) -> Iterator[str]:
    """All that a file imports, by dotted names."""
    for node in ast.walk(tree(path)):
        if isinstance(node, ast.Import | ast.ImportFrom):
            module = f"{node.module}." if isinstance(node, ast.ImportFrom) else ""
            yield from (module + alias.name for alias in node.names)
