"""Pages written from what models, mechanisms and sensors declare: one source for checks, cubes and docs."""

from __future__ import annotations

import math
from collections.abc import Iterable
from pathlib import Path

import models
from models.base import Mechanism, Parameter, Quantity
from models.model import Model


def write_pages(folder: Path) -> None:
    """Write ``models.md`` and ``mechanisms.md`` into ``folder``."""
    folder.mkdir(exist_ok=True)
    _write(folder / "models.md", models_page())
    _write(folder / "mechanisms.md", mechanisms_page())


def _write(path: Path, text: str) -> None:
    if not path.exists() or path.read_text() != text:
        path.write_text(text)


def _cell(text: object) -> str:
    return str(text).replace("|", "\\|").replace("\n", " ")


def _table(head: tuple[str, ...], rows: Iterable[tuple[object, ...]]) -> str:
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    lines += ["| " + " | ".join(_cell(cell) for cell in row) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def _number(value: float | None) -> str:
    if value is None:
        return "required"
    if math.isnan(value):
        return "see meaning"
    return "infinite" if math.isinf(value) else f"{value:g}"


def _bounds(p: Parameter) -> str:
    low = "" if math.isinf(p.low) else ("> " if p.low_open else "≥ ") + f"{p.low:g}"
    high = "" if math.isinf(p.high) else f"≤ {p.high:g}"
    return ", ".join(part for part in (low, high) if part)


def _quantities(quantities: tuple[Quantity, ...]) -> str:
    return _table(("name", "unit", "meaning", "rule"), ((f"`{q.name}`", q.unit, q.meaning, q.rule) for q in quantities))


def model_section(model: Model) -> str:
    """Everything one model takes and gives."""
    given = " · ".join(" or ".join("+".join(f"`{n}`" for n in way) for way in ways) for ways in model.alternatives)
    words = "".join(
        f"- `{name}`: " + ", ".join(f"`{w}`" for w in choices) + " (the first is the default)\n"
        for name, choices in model.options.items()
    )
    parts = [
        f"## `{model.name}`: {model.title}\n",
        "```text\n" + (type(model).__doc__ or "").strip() + "\n```\n",
        f"Exactly one of: {given}. Integrators: {', '.join(f'`{i}`' for i in model.integrators)}.\n",
        "### Parameters\n",
        _table(
            ("name", "symbol", "unit", "meaning", "bounds", "default"),
            ((f"`{p.name}`", p.symbol, p.unit, p.meaning, _bounds(p), _number(p.default)) for p in model.parameters),
        ),
        "### Options\n\n" + words if words else "",
        "### Outputs of a cell\n",
        _quantities(model.outputs),
        "### Auxiliary coordinates of a cube\n",
        _quantities(model.derived),
        "### Observables of a history\n",
        _quantities(model.observables),
    ]
    return "\n".join(part for part in parts if part)


def models_page() -> str:
    sections = "\n".join(model_section(models.get(name)) for name in models.MODELS)
    return (
        "# Models\n\nWritten from the declarations in `models/`; a plan, a specimen and a cube use the same names.\n\n"
        + sections
    )


def _mechanism(mechanism: Mechanism, where: str, *others: Mechanism) -> str:
    """``others``: its declarations with parameters of their own on other models."""
    elsewhere = "".join(f"\nOn {_acts_on(other)} with parameters of its own: {_form(other)}" for other in others)
    return f"## `{mechanism.name}`\n\nClass `{mechanism.effect_class}`; {where}. {_form(mechanism)}{elsewhere}"


def _form(mechanism: Mechanism) -> str:
    parameters = _table(
        ("parameter", "unit", "meaning", "null", "range of a fit"),
        (
            (f"`{mechanism.name}.{p.name}`", p.unit, p.meaning, _number(p.null), f"{p.low:g} to {p.high:g}")
            for p in mechanism.parameters
        ),
    )
    if mechanism.tabulated:
        parameters = "In a specimen `file` names its table, and a study takes it with the specimen (see Plans)."
    source = f" Source: {mechanism.source}." if mechanism.source else ""
    return f"`{mechanism.equation}`.{source}\n\nLeft out, it shows: {mechanism.signature}.\n\n{parameters}"


def _acts_on(mechanism: Mechanism) -> str:
    return ", ".join(f"`{name}`" for name in mechanism.acts)


def mechanisms_page() -> str:
    from grids.instruments import INSTRUMENTS
    from models.mechanisms import MECHANISMS

    forms: dict[str, list[Mechanism]] = {}
    for mechanism in MECHANISMS:
        forms.setdefault(mechanism.name, []).append(mechanism)
    inside = "\n".join(_mechanism(m, f"acts on {_acts_on(m)}", *others) for m, *others in forms.values())
    beside = "\n".join(_mechanism(m, "an instrument's effect, on every model") for m in INSTRUMENTS.values())
    return (
        "# Mechanisms\n\nWhat a base model may leave out. Those of the first part are usable in plans, specimens and "
        "diagnosis; those of instruments in specimens and diagnosis only. At its null a mechanism does nothing.\n\n"
        f"{inside}\n{beside}"
    )
