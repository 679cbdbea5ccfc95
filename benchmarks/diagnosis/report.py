"""Figures of the benches: by group of noise and size, by imperfection, by what begins."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

from benchmarks.diagnosis.bases import WRONG
from benchmarks.diagnosis.suite import GROUPS
from diagnosis.prove.report import FIGURES, OF_PLACES, provenance, summary, table
from diagnosis.prove.scores import Scored, Share


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


def of_all(cases: Sequence[Scored]) -> dict[str, Any]:
    """The figures of all cases together."""
    return {**summary(cases), **provenance(cases)}


def by_imperfection(cases: Sequence[Scored]) -> dict[str, Any]:
    """The figures of cases with a laboratory's errors: all, and counts by imperfection, of mixtures also together."""

    def of(case: Scored) -> list[str]:
        return [*case.imperfections, "mixture"] if len(case.imperfections) > 1 else case.imperfections

    names = sorted({name for case in cases for name in of(case)})
    parts = {name: _counts([case for case in cases if name in of(case)]) for name in names}
    return {**summary(cases), "by_imperfection": parts, **provenance(cases)}


def by_beginning(cases: Sequence[Scored]) -> dict[str, Any]:
    """The figures of effects that begin: all, and counts by what happens."""
    names = sorted({str(case.key["beginning"]) for case in cases if "beginning" in case.key})
    parts = {name: _counts([case for case in cases if case.key.get("beginning") == name]) for name in names}
    return {**summary(cases), "by_beginning": parts, **provenance(cases)}


def by_base(cases: Sequence[Scored]) -> dict[str, Any]:
    """By what a specimen is and is taken for: how often the right base model comes first, or one is called wrong."""
    parts = {}
    for name in sorted({str(case.key["group"]) for case in cases}):
        own = [case for case in cases if case.key["group"] == name]
        right = [case.first_class in case.truth for case in own if case.truth]
        wrong = [bool({*WRONG.values()} & {effect["name"] for effect in case.answer["effects"]}) for case in own]
        parts[name] = {"right_first" if right else "called_wrong": asdict(Share.of_flags(right or wrong))}
    return {**summary(cases), "by_base": parts, **provenance(cases)}


def _counts(cases: Sequence[Scored]) -> dict[str, Any]:
    found = summary(cases)
    counts = {key: [part["count"], part["of"]] for key, part in found["intervals"].items() if part["of"]}
    return {"cases": found["cases"], "counts": counts}


def tables(figures: Mapping[str, Any]) -> str:
    """All tables of `grouped`, `of_all`, `by_imperfection`, `by_beginning` or `by_base`."""
    if "by_base" in figures:
        lines = [table(figures, "wrong base models")]
        for name, part in figures["by_base"].items():
            for what, one in part.items():
                interval = f"({one['low95']:.3f}-{one['high95']:.3f})"
                lines.append(f"  {name:18s} {what.replace('_', ' ')} {one['count']} of {one['of']} {interval}")
        return "\n".join(lines)
    for key, title in (("by_imperfection", "with a laboratory's errors"), ("by_beginning", "effects that begin")):
        if key in figures:
            lines = [table(figures, title)]
            for name, part in figures[key].items():
                shown = (item for item in part["counts"].items() if item[0] in (*FIGURES, *OF_PLACES))
                lines.append(f"  {name:32s} " + ", ".join(f"{one} {count} of {of}" for one, (count, of) in shown))
            return "\n".join(lines)
    found = [table(figures, "1 % noise, nominal size")]
    for title, name in (("3 % noise, half size", "half_size_3_percent"), ("0.5 % noise", "nominal_size_half_percent")):
        if name not in figures:
            continue
        part = figures[name]
        suffix = "_half" if name.startswith("half") else ""
        bare = {key.removesuffix("_half"): number for key, number in part.items() if key != "intervals"}
        bare["intervals"] = {key.removesuffix("_half"): share for key, share in part["intervals"].items()}
        if bare["cases"]:
            found.append(table(bare, f"{title} (keys end with {suffix!r})" if suffix else title))
    return "\n".join(found)
