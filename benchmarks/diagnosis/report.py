"""What a run of the benchmark writes: results/bench/*.json, a table, the confusion matrix."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from benchmarks.diagnosis.scores import Scored, confusion, score
from benchmarks.diagnosis.suite import GROUPS

FIGURES = (
    "false_alarm", "class_first", "rivals_cover", "rivals_mean", "pairs_both", "interval_coverage",
    "open_recall", "open_false", "seconds_median",
)  # fmt: skip
MORE = (
    "mismatch_alarm", "detected", "class_first_strict", "class_first_detected", "class_first_weak",
    "rivals_cover_detected", "pairs_one", "base_coverage", "open_detected", "seconds_most",
)  # fmt: skip


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
    return {"cases": figures["cases"], "by_kind": figures["by_kind"], **numbers, "intervals": intervals}


def grouped(cases: Sequence[Scored]) -> dict[str, Any]:
    """The figures at 1 % noise and nominal size, the others by group, and by model."""

    def group(noise: float, relative_size: float) -> list[Scored]:
        return [
            case for case in cases
            if (case.key["noise_fraction_of_peak"], case.key["relative_size"]) == (noise, relative_size)
        ]  # fmt: skip

    def figures(chosen: Sequence[Scored]) -> dict[str, Any]:
        first, half, fine = ([c for c in group(g.noise, g.relative_size) if c in chosen] for g in GROUPS)
        with_half = summary(half, weak_too=True)  # at 3 % noise few ranges reach nominal size
        intervals = with_half.pop("intervals")
        return {
            **summary(first),
            "half_size_3_percent": {
                **{f"{name}_half": number for name, number in with_half.items()},
                "intervals": {f"{name}_half": share for name, share in intervals.items()},
            },
            "nominal_size_half_percent": summary(fine),
        }

    models = sorted({str(case.key["model"]) for case in cases})
    return {
        **figures(cases),
        "by_model": {model: figures([c for c in cases if c.key["model"] == model]) for model in models},
        **provenance(cases),
    }


def by_imperfection(cases: Sequence[Scored]) -> dict[str, Any]:
    """The figures of cases with a laboratory's errors: all, and counts by imperfection."""
    figures = summary(cases)
    parts = {}
    for name in sorted({name for case in cases for name in _imperfections(case)}):
        found = summary([case for case in cases if name in _imperfections(case)])
        counts = {key: [part["count"], part["of"]] for key, part in found["intervals"].items() if part["of"]}
        parts[name] = {"cases": found["cases"], "counts": counts}
    return {**figures, "by_imperfection": parts, **provenance(cases)}


def _imperfections(case: Scored) -> list[str]:
    """By name; of a mixture also ``mixture``."""
    names = list(case.key["imperfections"]["names"])
    return [*names, "mixture"] if len(names) > 1 else names


def provenance(cases: Sequence[Scored]) -> dict[str, Any]:
    """Cases by the sources that answered them, and those that failed."""
    return {
        "sources": dict(Counter(str(case.answer.get("sources")) for case in cases)),
        "failed": [case.case for case in cases if case.verdict == "failed"],
    }


def table(figures: Mapping[str, Any], title: str) -> str:
    """The shares with their intervals, a line each."""
    lines = [f"{title}: {figures['cases']} cases {figures['by_kind']}"]
    for name in (*FIGURES, *MORE):
        share = figures["intervals"].get(name)
        if share is None:
            number = figures[name]
            lines.append(f"  {name:24s} {'-' if number is None else f'{number:8.2f}'}")
        elif share["of"]:
            lines.append(
                f"  {name:24s} {share['value']:8.3f}  [{share['low95']:.3f}, {share['high95']:.3f}]"
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
            beside = ", ".join(["weak"] * case.weak + list(case.key.get("imperfections", {}).get("names", ())))
            kind = f"{case.kind} ({beside})" if beside else case.kind
            lines.append(
                f"{case.case} {kind}: {hidden}; said {case.verdict}: {said}" + (f"; rivals {rivals}" if rivals else "")
            )
    return "\n".join(lines)


def tables(figures: Mapping[str, Any]) -> str:
    """All tables of `grouped` or of `by_imperfection`."""
    if "by_imperfection" in figures:
        lines = [table(figures, "with a laboratory's errors")]
        for name, part in figures["by_imperfection"].items():
            counts = ", ".join(
                f"{key} {count} of {of}" for key, (count, of) in part["counts"].items() if key in FIGURES
            )
            lines.append(f"  {name:14s} {counts}")
        return "\n".join(lines)
    found = [table(figures, "1 % noise, nominal size")]
    for title, name in (("3 % noise, half size", "half_size_3_percent"), ("0.5 % noise", "nominal_size_half_percent")):
        part = figures[name]
        suffix = "_half" if name.startswith("half") else ""
        bare = {key.removesuffix("_half"): number for key, number in part.items() if key != "intervals"}
        bare["intervals"] = {key.removesuffix("_half"): share for key, share in part["intervals"].items()}
        if bare["cases"]:
            found.append(table(bare, f"{title} (keys end with {suffix!r})" if suffix else title))
    return "\n".join(found)


def draw_confusion(cases: Sequence[Scored], path: Path) -> None:
    """The confusion matrix of nulls, singles and open cases as a figure."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    rows, columns, counts = confusion(cases)
    figure, axes = pyplot.subplots(figsize=(0.35 * len(columns) + 3.5, 0.3 * len(rows) + 2.5))
    axes.imshow(counts, cmap="Blues", aspect="auto")
    for i, row in enumerate(counts):
        for j, count in enumerate(row):
            if count:
                axes.text(j, i, str(count), ha="center", va="center", fontsize=7,
                          color="white" if count > counts.max() / 2 else "black")  # fmt: skip
    axes.set_xticks(range(len(columns)), columns, rotation=90, fontsize=7)
    axes.set_yticks(range(len(rows)), rows, fontsize=7)
    axes.set_xlabel("class named first")
    axes.set_ylabel("class hidden")
    figure.tight_layout()
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=150)
    pyplot.close(figure)
