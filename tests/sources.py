"""The files of the program, and what they import."""

from __future__ import annotations

import ast
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
ORDER = ("models", "grids", "study", "diagnosis", "rocking")
FILES = sorted(path for room in ORDER for path in (ROOT / room).rglob("*.py"))


def imported_modules(path: Path) -> set[str]:
    """Names of the modules that a file imports, or imports something from."""
    found: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            found.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path.relative_to(ROOT)}: relative import"
            found.add(node.module or "")
    return found
