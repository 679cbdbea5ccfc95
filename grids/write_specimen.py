"""The text of a specimen file."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from typing import Any

from grids.law_table import LAW_FILE, law_text
from grids.recordings.placed import attributes
from grids.specimen import Specimen
from grids.writer import WRITTEN
from models.mechanisms import acting_on


def specimen_text(specimen: Specimen, law_file: str = LAW_FILE) -> str:
    """The TOML that `grids.specimen.read_specimen` reads back equal: SI units, floats with all their digits.

    A law in a table (`law_beside`) is named by its file, ``law_file``, which is to be written beside it.
    """
    head = {"title": specimen.title, "model": specimen.model}
    tables: dict[str, Mapping[str, Any]] = {
        "parameters": specimen.parameters,
        "tolerance": specimen.tolerance,
        "measured": specimen.measured,
        "calibrate": specimen.calibrate,
        "motion": {} if specimen.vertical is None else {"vertical": specimen.vertical},
        "initial": specimen.initial,
        "options": specimen.options,
        "instruments": {} if specimen.reference_peak is None else {"reference_peak": specimen.reference_peak},
    }
    parts = [f"# {WRITTEN}\n{_lines(head)}"]
    parts += [f"[{name}]\n{_lines(table)}" for name, table in tables.items() if table or name == "parameters"]
    parts += [f"[channels.{_key(name)}]\n{_lines(attributes(place))}" for name, place in specimen.places.items()]
    for name, values in specimen.mechanisms.items():
        known = acting_on(specimen.model).get(name)
        named: Mapping[str, Any] = values
        if known is not None and known.tabulated is not None:
            beside = {key: values[key] for key in known.tabulated.oscillator if key in values}
            named = {"file": law_file} | (beside if any(beside[key] for key in known.tabulated.oscillator[:2]) else {})
        parts.append(f"[mechanisms.{name}]\n{_lines(named)}")
        parts += [f"[[mechanisms.{name}.stages]]\n{_lines(vars(one))}" for one in specimen.stages.get(name, ())]
    return "\n".join(parts)


def law_beside(specimen: Specimen) -> str | None:
    """The law in a table that `specimen_text` names, as the text of its file; None without one."""
    for name, mechanism in acting_on(specimen.model).items():
        if name in specimen.mechanisms and mechanism.tabulated is not None:
            return law_text(specimen.mechanisms[name], mechanism.tabulated)
    return None


def _lines(table: Mapping[str, Any]) -> str:
    return "".join(f"{_key(name)} = {_value(value)}\n" for name, value in table.items())


def _key(name: str) -> str:
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else _string(name)


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return _string(value)
    if isinstance(value, tuple | list):
        return "[" + ", ".join(_value(item) for item in value) + "]"
    return repr(float(value))


def _string(text: str) -> str:
    # A basic TOML string escapes as JSON does, and the delete character besides.
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")
