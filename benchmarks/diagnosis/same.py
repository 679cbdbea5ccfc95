"""Two runs over the same cases, case by case: are verdict, names and numbers the same?"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from benchmarks.diagnosis.suite import place
from diagnosis.prove.answers import read_json

TOLERANCE = 1e-6
"""Of estimates, evidence and gaps: relative difference under which two numbers are the same."""
WORDS = (
    ("verdict", lambda answer: answer["verdict"]),
    ("effects", lambda answer: [effect["name"] for effect in answer["effects"]]),
    ("rivals", lambda answer: [rival["name"] for rival in answer["rivals"]]),
    ("constancy", lambda answer: [(c["parameter"], c["depends_on"], c["stronger"]) for c in answer["constancy"]]),
    ("located", lambda answer: [(p["recording"], p["channel"], tuple(p["where"])) for p in answer["located"]]),
)  # fmt: skip
"""What must be equal to the letter."""


def same(folder: Path, *, seed: int, run: str, against: str, say: Callable[[str], None]) -> bool:
    """Whether every case that both runs answered has the same answer; every difference is said."""
    here = place(folder, seed)
    labels = sorted({path.name for path in (here / run).glob("*.json")} & {p.name for p in (here / against).glob("*")})
    differing = 0
    largest = 0.0
    for label in labels:
        after, before = read_json(here / run / label), read_json(here / against / label)
        found = differences(before, after)
        largest = max(largest, *(size for _, size in found[1]), 0.0)
        lines = [*found[0], *(f"{name} differs by {size:.1e}" for name, size in found[1] if size > TOLERANCE)]
        differing += bool(lines)
        for line in lines:
            say(f"{label.removesuffix('.json')}: {line}")
    say(
        f"{len(labels) - differing} of {len(labels)} cases answered alike by '{against}' and '{run}'; "
        f"largest relative difference of a number {largest:.1e}"
    )
    return differing == 0 and bool(labels)


def differences(before: Mapping[str, Any], after: Mapping[str, Any]) -> tuple[list[str], list[tuple[str, float]]]:
    """What reads differently, and the relative difference of every number that both answers hold."""
    words = [f"{name} {of(before)} -> {of(after)}" for name, of in WORDS if of(before) != of(after)]
    one, other = numbers(before), numbers(after)
    return words, [(name, _apart(one[name], other[name])) for name in sorted(one.keys() & other.keys())]


def numbers(answer: Mapping[str, Any]) -> dict[str, float]:
    """Estimates with their intervals, evidence and gaps of an answer, by what they are of."""
    found = {f"gap of {rival['name']}": float(rival["evidence_gap"]) for rival in answer["rivals"]}
    parts = [("base", answer["base"])]
    for effect in answer["effects"]:
        found[f"evidence of {effect['name']}"] = float(effect["evidence"])
        parts.append((effect["name"], effect["parameters"]))
    for owner, parameters in parts:
        for name, value in parameters.items():
            found |= {f"{key} of {owner}.{name}": float(value[key]) for key in ("estimate", "low95", "high95")}
    return found


def _apart(one: float, other: float) -> float:
    """|one - other| over the larger size (at least 1e-3); 0 where both are the same infinity."""
    if one == other:
        return 0.0
    apart = abs(one - other) / max(abs(one), abs(other), 1e-3)
    return apart if math.isfinite(apart) else math.inf
