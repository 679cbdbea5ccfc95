"""Cases with their keys and answers made by hand, right ones and wrong ones."""

from __future__ import annotations

from diagnosis.prove.scores import Scored

FIRST = "tilt"
"""The mechanism whose size is told."""


def said(verdict: str, effects=(), rivals=(), seconds: float = 1.0, **parameters) -> dict:
    """An answer, as it is written; ``parameters``: those of `FIRST`."""
    return {
        "verdict": verdict,
        "effects": [
            {"name": n, "class": n, "parameters": parameters if n == FIRST else {}, "evidence": 50.0} for n in effects
        ],
        "rivals": [{"name": n, "class": n, "evidence_gap": 4.0} for n in rivals],
        "base": {"width": {"low95": 0.2, "estimate": 0.25, "high95": 0.3}},
        "seconds": seconds,
        "processor_seconds": 0.5 * seconds,
        "sources": "abc",
    }


def key(kind: str, *names: str, weak: bool = False, noise: float = 0.01, size: float = 1.0) -> dict:
    """What a case hides, as its key says it."""
    effects = [{"name": n, "class": n, "parameters": {"tilt": 0.01} if n == FIRST else {}} for n in names]
    return {
        "kind": kind, "model": "housner", "effects": effects, "weak": weak, "true_parameters": {"width": 0.26},
        "noise_fraction_of_peak": noise, "relative_size": size, "over_peak": 0.02,
    }  # fmt: skip


def estimate(low: float, high: float) -> dict:
    """The middle of an interval of 95 %, with its ends."""
    return {"low95": low, "estimate": 0.5 * (low + high), "high95": high}


CASES = [
    Scored("1", said("nothing_missing"), key("null")),
    Scored("2", said("missing", ["gain"]), key("null")),
    Scored("3", said("missing", [FIRST], tilt=estimate(0.005, 0.02)), key("single", FIRST)),
    Scored("4", said("cannot_tell_apart", ["gain"], ["delay"]), key("single", "delay")),
    Scored("5", said("nothing_missing"), key("single", "gain")),
    Scored("6", said("nothing_missing"), key("single", "gain", weak=True)),
    Scored("7", said("missing", [FIRST, "gain"], tilt=estimate(0.02, 0.03)), key("pair", FIRST, "gain")),
    Scored("8", said("missing", ["gain"]), key("pair", "gain", "delay")),
    Scored("9", said("not_in_library", ["gain"]), key("open", "x")),
    Scored("10", said("missing", ["gain"]), key("open", "x")),
    Scored("11", said("not_in_library", [FIRST]), key("single", FIRST)),
    Scored("12", said("missing", ["gain"], seconds=9.0), key("mismatch")),
]
