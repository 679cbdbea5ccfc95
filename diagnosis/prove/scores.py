"""From answers and keys to figures, every share with its exact (Clopper-Pearson) interval."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from scipy.stats import binomtest

Answer = Mapping[str, Any]
Key = Mapping[str, Any]
SILENT = ("null", "mismatch")
"""Kinds in which nothing is missing."""
HALF = 0.5
"""Of the achievable, from which on the recording held out counts as predicted."""


@dataclass(frozen=True)
class Scored:
    """An answer beside its key."""

    case: str
    answer: Answer
    key: Key

    @property
    def kind(self) -> str:
        return str(self.key["kind"])

    @property
    def verdict(self) -> str:
        return str(self.answer["verdict"])

    @property
    def imperfections(self) -> list[str]:
        """Names of a laboratory's errors in the recordings."""
        given = self.key.get("imperfections", {})
        return list(given.get("names", given))

    @property
    def effects(self) -> list[Mapping[str, Any]]:
        """Effects of the answer, without what the key calls rightly named (``named_rightly``) beside what is hidden.

        Without that entry it is an imperfection that is itself in the catalogue.
        """
        known = set(self.key.get("named_rightly", self.imperfections)) - {
            effect["name"] for effect in self.key["effects"]
        }
        return [effect for effect in self.answer["effects"] if effect["name"] not in known]

    @property
    def detected(self) -> bool:
        """Whether the answer says that anything is missing beyond such instruments; one that failed is wrong anyhow."""
        if self.verdict == "failed":
            return self.kind in SILENT
        if self.verdict in ("missing", "cannot_tell_apart") and self.answer["effects"]:
            return bool(self.effects)
        return self.verdict != "nothing_missing"

    @property
    def weak(self) -> bool:
        return bool(self.key.get("weak", False))

    @property
    def truth(self) -> list[str]:
        """Classes of the hidden effects."""
        return [effect["class"] for effect in self.key["effects"]]

    @property
    def first_class(self) -> str:
        """Class of the strongest effect named; the verdict where none is, or no other than such instruments."""
        if not self.detected:
            return "nothing_missing"
        return str(self.effects[0]["class"]) if self.effects else self.verdict

    @property
    def named(self) -> set[str]:
        """Classes of all effects and rivals of the answer."""
        return {entry["class"] for entry in [*self.effects, *self.answer["rivals"]]}

    @property
    def names(self) -> set[str]:
        """Names of all effects and rivals of the answer."""
        return {entry["name"] for entry in [*self.effects, *self.answer["rivals"]]}


@dataclass(frozen=True)
class Share:
    """``count`` of ``of``, and the exact 95 % interval of the probability; nan of none."""

    count: int
    of: int
    value: float
    low95: float
    high95: float

    @classmethod
    def of_flags(cls, flags: Iterable[bool]) -> Share:
        found = list(flags)
        if not found:
            return cls(0, 0, float("nan"), 0.0, 1.0)
        interval = binomtest(sum(found), len(found)).proportion_ci(0.95, "exact")
        return cls(sum(found), len(found), sum(found) / len(found), float(interval.low), float(interval.high))


def covered(case: Scored) -> list[bool]:
    """For every hidden parameter of an effect named rightly: whether its interval holds the truth.

    Parameters over the peak are compared in rad. A parameter that only shapes an effect counts too.
    """
    flags = []
    hidden = {effect["name"]: effect for effect in case.key["effects"]}
    for effect in case.answer["effects"]:
        if effect["name"] not in hidden:
            continue
        found = effect["parameters"]
        for name, value in hidden[effect["name"]].get("parameters", {}).items():
            if name not in found:
                continue
            factor = 1.0
            if name.endswith("_over_peak") and case.answer.get("reference_peak") and "over_peak" in case.key:
                factor = case.key["over_peak"] / case.answer["reference_peak"]
            flags.append(found[name]["low95"] <= value * factor <= found[name]["high95"])
    return flags


def base_covered(case: Scored) -> list[bool]:
    """Whether the intervals of the calibrated base parameters hold the truth."""
    truth = case.key.get("true_parameters", {})
    return [v["low95"] <= truth[n] <= v["high95"] for n, v in case.answer["base"].items() if n in truth]


def achieved(case: Scored) -> float | None:
    """Which share of what noise leaves to remove the answer removes from the misfit of the recording held out.

    0 of an answer that failed or says that nothing is missing; None of one that predicts no such recording, or where
    there is nothing to remove.
    """
    if case.verdict == "failed":
        return 0.0
    held = (case.answer.get("fit") or {}).get("holdout")
    if held is None:
        return None
    share: float | None = held["share_of_achievable"]
    return 0.0 if case.verdict == "nothing_missing" else share


def score(cases: Sequence[Scored], *, weak_too: bool = False) -> dict[str, Any]:
    """All figures of one set of cases: shares with intervals, means, and times.

    ``weak_too``: singles whose range ends before nominal size count in the figures of singles.
    """

    def of(*kinds: str) -> list[Scored]:
        return [case for case in cases if case.kind in kinds]

    nulls, singles, pairs, opens = of(*SILENT), of("single"), of("pair"), of("open")
    full = [case for case in singles if weak_too or not case.weak]
    seen = [case for case in full if case.detected]
    inside = [*nulls, *singles, *pairs]
    named = [case for case in [*full, *pairs] if set(case.truth) & {effect["class"] for effect in case.effects}]
    flagged = [case for case in cases if case.verdict == "not_in_library"]
    outside, library = ([a for case in chosen if (a := achieved(case)) is not None] for chosen in (opens, named))

    def share(chosen: Sequence[Scored], test: Callable[[Scored], bool]) -> dict[str, Any]:
        return asdict(Share.of_flags(test(case) for case in chosen))

    def first_right(case: Scored) -> bool:
        return case.first_class in case.truth

    def among(case: Scored) -> bool:
        return case.detected and bool(set(case.truth) & case.named)

    return {
        "cases": len(cases),
        "by_kind": dict(Counter(case.kind for case in cases)),
        "false_alarm": share(of("null"), lambda case: case.detected),
        "mismatch_alarm": share(of("mismatch"), lambda case: case.detected),
        "detected": share(full, lambda case: case.detected),
        "class_first": share(full, first_right),
        "class_first_strict": share(full, lambda case: first_right(case) and case.verdict != "not_in_library"),
        "class_first_detected": share(seen, first_right),
        "class_first_weak": share([case for case in singles if case.weak], first_right),
        "rivals_cover": share(full, among),
        "rivals_cover_detected": share(seen, among),
        "rivals_mean": float(np.mean([len(case.names) for case in seen])) if seen else float("nan"),
        "pairs_both": share(pairs, lambda case: set(case.truth) <= {effect["class"] for effect in case.effects}),
        "pairs_one": share(pairs, among),
        "interval_coverage": asdict(Share.of_flags(flag for case in cases for flag in covered(case))),
        "base_coverage": asdict(Share.of_flags(flag for case in nulls for flag in base_covered(case))),
        "open_recall": share(opens, lambda case: case.verdict == "not_in_library"),
        "open_detected": share(opens, lambda case: case.detected),
        "open_false": share(inside, lambda case: case.verdict == "not_in_library"),
        "open_precision": share(flagged, lambda case: case.kind == "open"),
        "share_of_achievable": asdict(Share.of_flags(one >= HALF for one in outside)),
        "share_of_achievable_open_median": _median(outside),
        "share_of_achievable_named_median": _median(library),
        **_times(cases, "seconds"),
        **_times(cases, "processor_seconds"),
    }


def _times(cases: Sequence[Scored], name: str) -> dict[str, float]:
    """Median and largest of the answers' time of that ``name``; nan of none."""
    taken = [float(case.answer[name]) for case in cases if name in case.answer]
    return {
        f"{name}_median": _median(taken),
        f"{name}_most": max(taken, default=float("nan")),
    }


def _median(values: Sequence[float]) -> float:
    """Nan of none."""
    return float(np.median(values)) if values else float("nan")


def confusion(cases: Sequence[Scored]) -> tuple[list[str], list[str], np.ndarray]:
    """Truth (rows: null, classes, open) against the first class named (columns): counts."""

    def true_label(case: Scored) -> str:
        return {"single": case.truth[0] if case.truth else "", "open": "not_in_library"}.get(
            case.kind, "nothing_missing"
        )

    def said(case: Scored) -> str:
        return case.verdict if case.verdict == "not_in_library" else case.first_class

    chosen = [case for case in cases if case.kind != "pair"]
    tail = ["not_in_library", "nothing_missing"]
    rows = sorted({true_label(c) for c in chosen} - set(tail)) + tail
    columns = sorted(({said(c) for c in chosen} | set(rows)) - set(tail)) + tail
    counts = np.zeros((len(rows), len(columns)), int)
    for case in chosen:
        counts[rows.index(true_label(case)), columns.index(said(case))] += 1
    return rows, columns, counts
