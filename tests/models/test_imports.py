"""Inside `models` the way is one: coefficients, then mechanisms, then models; kernels are loaded when they run."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

import models

ROOM = Path(models.__file__).parent
FILES = sorted(ROOM.rglob("*.py"))
LATE = {f"models.{name}.{part}" for name in models.MODELS for part in ("lanes", "reference")}
"""What a model imports only when it runs."""


def imports(tree: ast.AST) -> list[str]:
    """The modules that are imported anywhere in ``tree``."""
    found = [alias.name for node in ast.walk(tree) if isinstance(node, ast.Import) for alias in node.names]
    return found + [node.module or "" for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)]


@pytest.mark.parametrize("path", FILES, ids=lambda p: p.relative_to(ROOM).as_posix())
def test_only_integrators_and_models_are_imported_late(path: Path) -> None:
    tree = ast.parse(path.read_text())
    functions = [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)]
    late = {module for function in functions for module in imports(function) if module.startswith("models")}
    if path == ROOM / "__init__.py":
        assert late == {f"models.{name}.model" for name in models.MODELS}
    else:
        assert all(any(module.startswith(part) for part in LATE) for module in late), late
    assert "importlib" not in imports(tree)


@pytest.mark.parametrize("path", sorted((ROOM / "mechanisms").glob("*.py")), ids=lambda p: p.stem)
def test_mechanisms_know_coefficients_and_no_model(path: Path) -> None:
    known = imports(ast.parse(path.read_text()))
    assert not any(module.endswith(".model") or ".lanes" in module or ".reference" in module for module in known)


def test_no_kernel_is_loaded_before_it_runs() -> None:
    code = (
        "import models, sys; [models.get(n) for n in models.MODELS]; print(*(m for m in sys.modules if '.lanes.' in m))"
    )
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=ROOM.parent)
    assert not [name for name in ran.stdout.split() if name.startswith(tuple(LATE))]
