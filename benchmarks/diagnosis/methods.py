"""The competitors' ways beside the diagnosis, on the same own cases, in one table."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from benchmarks.diagnosis import from_rest, report, runner, weak_form
from benchmarks.diagnosis.suite import place, suite
from diagnosis.prove.answers import Answering, write_json

METHODS: dict[str, Answering] = {
    "from rest, least squares, BIC": from_rest.answer,
    "weak-form sparse regression": weak_form.answer,
}
COLUMNS = (
    "false_alarm", "class_first", "rivals_cover", "rivals_mean", "pairs_both", "interval_coverage", "seconds_median",
)  # fmt: skip


def compare(
    out: Path,
    *,
    seed: int,
    cases: int | None,
    jobs: int,
    minutes: float,
    run: str,
    say: Callable[[str], None],
) -> dict[str, Any]:
    """Every method on the first ``cases`` of the suite of ``seed``; the diagnosis from the answers of ``run``.

    Only cases that all methods answered count. Writes ``out``/diagnosis_methods.json.
    """
    here = place(out, seed)
    designs = suite(seed)[:cases]
    folders = {"windows, score test, refit (diagnosis)": here / run}
    for method, answering in METHODS.items():
        folders[method] = here / answering.__module__.rpartition(".")[2]
        say(f"{method}:")
        runner.run_all(
            designs, seed, here / "cases", folders[method],
            jobs=jobs, minutes=minutes / len(METHODS), say=say, answering=answering,
        )  # fmt: skip
    answered = {
        method: {design.label: scored for design, scored in runner.answered(designs, here / "cases", folder)}
        for method, folder in folders.items()
    }
    answered = {method: found for method, found in answered.items() if found}
    common = set.intersection(*(set(found) for found in answered.values()))
    figures = {method: report.grouped([found[label] for label in sorted(common)]) for method, found in answered.items()}
    write_json(out / "diagnosis_methods.json", {"seed": seed, "cases": len(common), "methods": figures})
    say(f"{len(common)} cases that every method answered; 1 % noise, nominal size:")
    say(" " * 40 + "".join(f"{name:>19s}" for name in COLUMNS))
    for method, found in figures.items():
        numbers = [found[name] for name in COLUMNS]
        say(f"{method:40s}" + "".join(f"{'-' if n is None else format(n, '.2f'):>19s}" for n in numbers))
    return figures
