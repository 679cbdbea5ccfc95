"""Inside `models` the way is one: coefficients, then mechanisms, then models; kernels are loaded when they run."""

import ast
import subprocess
import sys
from pathlib import Path

import models
from tests.sources import FILES, place, tree

ROOM = Path(models.__file__).parent
LATE = {f"models.{name}.{part}" for name in models.MODELS for part in ("lanes", "reference")}
"""What a model imports only when it runs."""


def imports(tree: ast.AST) -> list[str]:
    """The modules that are imported anywhere in ``tree``."""
    found = [alias.name for node in ast.walk(tree) if isinstance(node, ast.Import) for alias in node.names]
    return found + [node.module or "" for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)]


def test_only_integrators_and_models_are_imported_late() -> None:
    for path in FILES["models"]:
        functions = [node for node in ast.walk(tree(path)) if isinstance(node, ast.FunctionDef)]
        late = {module for function in functions for module in imports(function) if module.startswith("models")}
        if path == ROOM / "__init__.py":
            assert late == {f"models.{name}.model" for name in models.MODELS}
        else:
            assert all(any(module.startswith(part) for part in LATE) for module in late), f"{place(path)}: {late}"
        assert "importlib" not in imports(tree(path)), place(path)


def test_mechanisms_know_coefficients_and_no_model() -> None:
    for path in (ROOM / "mechanisms").glob("*.py"):
        for module in imports(tree(path)):
            model = module.endswith(".model") or ".lanes" in module or ".reference" in module
            assert not model, f"{place(path)}: {module}"


def test_no_kernel_is_loaded_before_it_runs() -> None:
    code = (
        "import models, sys; [models.get(n) for n in models.MODELS]; print(*(m for m in sys.modules if '.lanes.' in m))"
    )
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=ROOM.parent)
    assert not [name for name in ran.stdout.split() if name.startswith(tuple(LATE))]
