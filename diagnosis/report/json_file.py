"""``diagnosis.json``: the answer for a program, in the format that the design fixes."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

from diagnosis.answer.result import Diagnosis, Fit
from study.provenance import as_json


def diagnosis_json(diagnosis: Diagnosis) -> str:
    """The text of the file. Numbers that are not finite, which JSON does not know, become null."""
    return as_json(finite(as_mapping(diagnosis)), indent=2, allow_nan=False) + "\n"


def as_mapping(diagnosis: Diagnosis) -> dict[str, Any]:
    """The same as plain mappings and lists; whether and what was stopped stands in ``provenance``."""
    return {
        "verdict": diagnosis.verdict,
        "effects": _entries(diagnosis.effects),
        "rivals": _entries(diagnosis.rivals),
        "located": _entries(diagnosis.located),
        "shows": [_without_effect(place) for place in _entries(diagnosis.shows)],
        "constancy": _entries(diagnosis.constancy),
        "detail": None if diagnosis.detail is None else entry(asdict(diagnosis.detail)),
        "beyond_range": _entries(diagnosis.beyond),
        "unfit_windows": _entries(diagnosis.unfit),
        "undecided": None if diagnosis.undecided is None else entry(asdict(diagnosis.undecided)),
        "suspicions": [
            {"recording": name, "suspicion": what} for name, all_of in diagnosis.suspicions.items() for what in all_of
        ],
        "base": {name: entry(asdict(value)) for name, value in diagnosis.base.items()},
        "screen": _entries(diagnosis.screen),
        "null_band": diagnosis.null_band,
        "missing_force": diagnosis.missing_force,
        "p_value": diagnosis.p_value,
        "reference_peak": diagnosis.reference_peak,
        "channels": {name: dict(wider) for name, wider in diagnosis.channels.items()},
        "fit": {
            "train": _fit(diagnosis.train),
            "holdout": None if diagnosis.holdout is None else _holdout(diagnosis.holdout, diagnosis),
        },
        "statement": diagnosis.statement,
        "next_experiment": None if diagnosis.next_experiment is None else entry(dict(diagnosis.next_experiment)),
        "other_model": None if diagnosis.other_model is None else entry(asdict(diagnosis.other_model)),
        "errors": None if diagnosis.errors is None else asdict(diagnosis.errors),
        "not_tried": [{"name": name, "why": why} for name, why in diagnosis.not_tried.items()],
        "provenance": {
            **entry(dict(diagnosis.provenance)),
            "seen": list(diagnosis.seen),
            "finished": diagnosis.finished,
            "skipped": list(diagnosis.skipped),
            "failed": dict(diagnosis.failed),
        },
    }


def _entries(parts: Sequence[Any]) -> list[Any]:
    return [entry(asdict(part)) for part in parts]


def entry(value: Any) -> Any:
    """A part of the answer: what it leaves empty is null, its class has the file's name."""
    if isinstance(value, dict):
        return {"class" if key == "effect_class" else key: entry(item) for key, item in value.items()}
    return list(value) if isinstance(value, tuple) else None if value == "" else value


def _without_effect(place: dict[str, Any]) -> dict[str, Any]:
    """A residual belongs to no effect and has no amplitude of its own."""
    return {key: value for key, value in place.items() if key not in ("effect", "amplitude", "unit")}


def _fit(fit: Fit) -> dict[str, Any]:
    return {"before": fit.before, "after": fit.after, "noise_floor": fit.noise_floor}


def _holdout(fit: Fit, diagnosis: Diagnosis) -> dict[str, Any]:
    stages = [asdict(one) for one in diagnosis.held_stages]
    contradicted = None if diagnosis.contradicted is None else list(diagnosis.contradicted)
    return {
        **_fit(fit), "share_of_achievable": fit.share_of_achievable, "stages": stages, "contradicted": contradicted,
    }  # fmt: skip


def finite(value: Any) -> Any:
    """The same with null for numbers that JSON does not know."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, Mapping):
        return {str(key): finite(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [finite(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
