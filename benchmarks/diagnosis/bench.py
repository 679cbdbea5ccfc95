"""The benchmark of the diagnosis on concealed cases of our own."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from benchmarks.diagnosis import report, runner
from benchmarks.diagnosis.answers import Answering, diagnosed
from benchmarks.diagnosis.files import write_json
from benchmarks.diagnosis.suite import place, suite


def bench(
    folder: Path,
    *,
    seed: int,
    cases: int | None,
    minutes: float,
    jobs: int,
    run: str,
    say: Callable[[str], None],
    answering: Answering = diagnosed,
) -> dict[str, object]:
    """Run the first ``cases`` of the suite of ``seed`` (default: all), score what is answered, write it.

    Cases lie in ``folder``/diagnosis/<seed>-<hash of their makers>/cases, answers in .../<run>; another
    ``run`` answers the same cases anew. Every answer is on disk before a key is opened. Returns the figures, written to
    ``folder``/diagnosis.json and, with the confusion matrix and a list of wrong answers, beside the answers.
    """
    wishes = suite(seed)[:cases]
    here = place(folder, seed)
    runner.run_all(wishes, seed, here / "cases", here / run, jobs=jobs, minutes=minutes, say=say, answering=answering)
    answered = [scored for _, scored in runner.answered(wishes, here / "cases", here / run)]
    figures = {**report.grouped(answered), "seed": seed, "run": run, "asked": len(wishes)}
    if not answered:
        say("no case was answered")
        return figures
    write_json(folder / "diagnosis.json", figures)
    write_json(here / f"{run}.json", figures)
    report.draw_confusion(answered, here / f"{run}_confusion.png")
    wrong = report.wrong(answered)
    (here / f"{run}_wrong.txt").write_text(wrong + "\n", encoding="utf-8")
    say(report.table(figures, "1 % noise, nominal size"))
    for title, name in (("3 % noise, half size", "half_size_3_percent"), ("0.5 % noise", "nominal_size_half_percent")):
        part = figures[name]
        suffix = "_half" if name.startswith("half") else ""
        bare = {key.removesuffix("_half"): number for key, number in part.items() if key != "intervals"}
        bare["intervals"] = {key.removesuffix("_half"): share for key, share in part["intervals"].items()}
        if bare["cases"]:
            say(report.table(bare, f"{title} (keys end with {suffix!r})" if suffix else title))
    say(wrong)
    return figures
