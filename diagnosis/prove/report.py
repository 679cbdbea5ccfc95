"""Scored answers as plain numbers, tables and lines."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

from diagnosis.prove.places import instants_right, overlap
from diagnosis.prove.scores import Scored, Share, score

FIGURES = (
    "false_alarm", "class_first", "rivals_cover", "rivals_mean", "pairs_both", "interval_coverage",
    "open_recall", "open_precision", "open_false", "share_of_achievable", "seconds_median",
)  # fmt: skip
MORE = (
    "mismatch_alarm", "detected", "class_first_strict", "class_first_detected", "class_first_weak",
    "rivals_cover_detected", "pairs_one", "base_coverage", "open_detected", "share_of_achievable_open_median",
    "share_of_achievable_named_median", "seconds_most", "processor_seconds_median", "processor_seconds_most",
)  # fmt: skip

OF_PLACES = ("instants_right", "overlap_mean")
"""Only of cases in which something acts in a part of the recordings."""


def value(figure: Any) -> float | None:
    """The number of a figure, None where there was no case."""
    number = figure["value"] if isinstance(figure, Mapping) else figure
    return None if math.isnan(number) else float(number)


def summary(cases: Sequence[Scored], *, weak_too: bool = False) -> dict[str, Any]:
    """Plain numbers by name, and the intervals of the shares under ``intervals``."""
    figures = score(cases, weak_too=weak_too)
    numbers = {name: value(figures[name]) for name in (*FIGURES, *MORE)}
    shares = {name: figure for name, figure in figures.items() if isinstance(figure, Mapping) and "of" in figure}
    intervals = {name: {**share, "value": value(share)} for name, share in shares.items()}
    singles = [case for case in cases if case.kind == "single" and (weak_too or not case.weak)]
    begun = [right for case in singles if (right := instants_right(case)) is not None]
    overlaps = [size for case in singles if (size := overlap(case)) is not None]
    if begun:
        share = asdict(Share.of_flags(begun))
        intervals["instants_right"] = {**share, "value": value(share)}
        numbers["instants_right"] = value(share)
    if overlaps:
        numbers["overlap_mean"] = sum(overlaps) / len(overlaps)
    return {"cases": figures["cases"], "by_kind": figures["by_kind"], **numbers, "intervals": intervals}


def provenance(cases: Sequence[Scored]) -> dict[str, Any]:
    """Cases by the sources that answered them, and those that failed."""
    return {
        "sources": dict(Counter(str(case.answer.get("sources")) for case in cases)),
        "failed": [case.case for case in cases if case.verdict == "failed"],
    }


def warnings(figures: Mapping[str, Any], sources: str) -> list[str]:
    """Lines about answers that failed, and about those of other ``sources`` than the present ones."""
    said = []
    if figures["failed"]:
        said.append(f"failed, counted as wrong: {', '.join(figures['failed'])} (the reason stands in their answers)")
    others = sum(count for name, count in figures["sources"].items() if name != sources)
    if others:
        said.append(f"{others} of {figures['cases']} answers are those of another version: delete them for new ones")
    return said


def table(figures: Mapping[str, Any], title: str) -> str:
    """The shares with their intervals, a line each."""
    lines = [f"{title}: {figures['cases']} cases {figures['by_kind']}"]
    for name in (*FIGURES, *MORE, *(one for one in OF_PLACES if one in figures)):
        share = figures["intervals"].get(name)
        if share is None:
            number = figures[name]
            lines.append(f"  {name:32s} {'-' if number is None else f'{number:8.2f}'}")
        elif share["of"]:
            lines.append(
                f"  {name:32s} {share['value']:8.3f}  [{share['low95']:.3f}, {share['high95']:.3f}]"
                f"  {share['count']} of {share['of']}"
            )
    return "\n".join(lines)


def wrong(cases: Sequence[Scored]) -> str:
    """A line for every case that was not answered rightly: what was hidden and what was said."""
    lines = []
    for case in cases:
        said = " + ".join(effect["name"] for effect in case.answer["effects"]) or "-"
        rivals = ", ".join(f"{r['name']} ({r['evidence_gap']:.0f})" for r in case.answer["rivals"])
        hidden = " + ".join(effect["name"] for effect in case.key["effects"]) or "-"
        right = {
            "null": not case.detected,
            "mismatch": not case.detected,
            "single": case.first_class in case.truth and case.verdict != "not_in_library",
            "pair": set(case.truth) <= {effect["class"] for effect in case.effects},
            "open": case.verdict == "not_in_library",
        }[case.kind]
        if not right:
            hidden = hidden if case.kind != "open" else "outside the catalogue"
            beside = ", ".join(["weak"] * case.weak + case.imperfections)
            kind = f"{case.kind} ({beside})" if beside else case.kind
            lines.append(
                f"{case.case} {kind}: {hidden}; said {case.verdict}: {said}" + (f"; rivals {rivals}" if rivals else "")
            )
    return "\n".join(lines)
