"""``diagnosis.json``: the answer for a program, in the format that the design fixes."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from diagnosis.answer.result import Diagnosis, Fit, Undecided
from diagnosis.fit.intervals import Estimate
from study.provenance import as_json


def diagnosis_json(diagnosis: Diagnosis) -> str:
    """The text of the file. Numbers that are not finite, which JSON does not know, become null."""
    return as_json(_finite(as_mapping(diagnosis)), indent=2, allow_nan=False) + "\n"


def as_mapping(diagnosis: Diagnosis) -> dict[str, Any]:
    """The same as plain mappings and lists; whether and what was stopped stands in ``provenance``."""
    return {
        "verdict": diagnosis.verdict,
        "effects": [
            {
                "name": effect.name,
                "class": effect.effect_class,
                "parameters": {name: _estimate(value) for name, value in effect.parameters.items()},
                "evidence": effect.evidence,
                "p_value": effect.p_value,
            }
            for effect in diagnosis.effects
        ],
        "rivals": [
            {"name": rival.name, "class": rival.effect_class, "evidence_gap": rival.evidence_gap}
            for rival in diagnosis.rivals
        ],
        "located": [
            {
                "recording": place.recording,
                "channel": place.channel,
                "start": place.start,
                "end": place.end,
                "where": list(place.where),
                "share": place.share,
            }
            for place in diagnosis.located
        ],
        "constancy": [
            {
                "parameter": found.parameter,
                "depends_on": found.depends_on,
                "stronger": found.stronger or None,
                "evidence": found.evidence,
            }
            for found in diagnosis.constancy
        ],
        "undecided": None if diagnosis.undecided is None else _undecided(diagnosis.undecided),
        "suspicions": [
            {"recording": name, "suspicion": what} for name, all_of in diagnosis.suspicions.items() for what in all_of
        ],
        "p_value": diagnosis.p_value,
        "reference_peak": diagnosis.reference_peak,
        "fit": {
            "train": _fit(diagnosis.train),
            "holdout": None if diagnosis.holdout is None else _holdout(diagnosis.holdout),
        },
        "statement": diagnosis.statement,
        "next_experiment": None if diagnosis.next_experiment is None else dict(diagnosis.next_experiment),
        "provenance": {**diagnosis.provenance, "finished": diagnosis.finished, "skipped": list(diagnosis.skipped)},
    }


def _estimate(value: Estimate) -> dict[str, Any]:
    return {
        "estimate": value.estimate,
        "low95": value.low95,
        "high95": value.high95,
        "unit": value.unit,
        "at_bound": value.at_bound or None,
    }


def _undecided(suspect: Undecided) -> dict[str, Any]:
    return {
        "name": suspect.name,
        "class": suspect.effect_class,
        "gain": suspect.gain,
        "rests_on": suspect.rests_on or None,
    }


def _fit(fit: Fit) -> dict[str, Any]:
    return {"before": fit.before, "after": fit.after, "noise_floor": fit.noise_floor}


def _holdout(fit: Fit) -> dict[str, Any]:
    return {**_fit(fit), "share_of_achievable": fit.share_of_achievable}


def _finite(value: Any) -> Any:
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, Mapping):
        return {str(key): _finite(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
