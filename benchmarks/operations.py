"""Floating-point operations of a compiled function, counted in its source.

Add, subtract, multiply, divide and square root count one each; comparisons, abs, min, max, negation
and index arithmetic do not. Branches that a compiled variant does not hold (``if general is not
None`` with general None) are left out.
"""

from __future__ import annotations

import ast
import inspect
import textwrap
from typing import Any

_COUNTED = (ast.Add, ast.Sub, ast.Mult, ast.Div)


def count_operations(function: Any, absent: tuple[str, ...]) -> int:
    """Operations of one call, the compiled functions it calls included; ``absent`` arguments are None."""
    python = getattr(function, "py_func", function)
    tree = ast.parse(textwrap.dedent(inspect.getsource(python))).body[0]
    assert isinstance(tree, ast.FunctionDef)
    return _block(tree.body, {**python.__globals__, **inspect.getclosurevars(python).nonlocals}, absent)


def _block(body: list[ast.stmt], names: dict[str, Any], absent: tuple[str, ...]) -> int:
    total = 0
    for statement in body:
        if isinstance(statement, ast.If) and _needs(statement.test, absent):
            total += _block(statement.orelse, names, absent)
            continue
        if isinstance(statement, ast.For):
            # the loop over the lanes: one lane
            total += _block(statement.body, names, absent)
            continue
        if isinstance(statement, ast.AugAssign):
            total += isinstance(statement.op, _COUNTED)
        total += _expression(statement, names, absent)
        if isinstance(statement, ast.Return):
            break
    return total


def _needs(test: ast.expr, absent: tuple[str, ...]) -> bool:
    return (
        isinstance(test, ast.Compare)
        and isinstance(test.left, ast.Name)
        and test.left.id in absent
        and isinstance(test.ops[0], ast.IsNot)
    )


def _expression(node: ast.AST, names: dict[str, Any], absent: tuple[str, ...]) -> int:
    total = 0
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.Subscript):
            continue
        if isinstance(child, ast.BinOp) and isinstance(child.op, _COUNTED):
            total += 1
        if isinstance(child, ast.Call) and isinstance(child.func, ast.Name):
            called = names.get(child.func.id)
            if hasattr(called, "py_func") or getattr(called, "__module__", "").startswith("models."):
                total += count_operations(called, absent)
            elif child.func.id == "sqrt":
                total += 1
        total += _expression(child, names, absent)
    return total
