"""The benchmark of the diagnosis on concealed cases of our own.

With white noise, with a laboratory's errors, with recordings that were processed, with effects that begin, of walls on
rubber, of stacks, or of wrong base models.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmarks.diagnosis import bases, beginnings, laboratory, report, runner, stacks, suite, walls
from diagnosis.prove.answers import Answering, diagnosed, write_json
from diagnosis.prove.figures import draw_confusion
from diagnosis.prove.report import wrong as wrong_answers
from diagnosis.prove.scores import Scored


@dataclass(frozen=True)
class Bench:
    """A suite of cases by seed, and the figures of its answers."""

    designs: Callable[[int], list[suite.CaseDesign]]
    figures: Callable[[Sequence[Scored]], dict[str, Any]]
    made_by: tuple[str, ...] = ()
    """Files of this folder that its cases depend on beside those of `suite.MAKERS`."""
    under: str = ""
    """Of cases of one model: the name under which their figures are written, with the keys of those of one block."""


OF_TWO_BODIES = ("two_bodies.py", "bodies.py", "body_size.py")
OF_STACKS = ("stacks.py", *OF_TWO_BODIES, "rigid_stack.py", "bases.py")
BENCHES = {
    "diagnosis": Bench(suite.suite, report.grouped),
    "laboratory": Bench(laboratory.suite, report.by_imperfection),
    "processed": Bench(laboratory.processed, report.by_imperfection),
    "beginnings": Bench(beginnings.suite, report.by_beginning),
    "walls": Bench(walls.designs, report.of_all, ("walls.py", *OF_TWO_BODIES, "fibre_wall.py"), "interface"),
    "stacks": Bench(stacks.designs, report.of_all, OF_STACKS, "stacked"),
    "bases": Bench(bases.designs, report.by_base, ("bases.py",)),
}


def bench(
    name: str,
    folder: Path,
    *,
    seed: int,
    cases: int | None,
    kind: str | None = None,
    minutes: float,
    jobs: int,
    run: str,
    say: Callable[[str], None],
    answering: Answering = diagnosed,
) -> dict[str, Any]:
    """Run the first ``cases`` of bench ``name`` at ``seed``, of one ``kind`` (default: all), score those answered.

    Cases lie in ``folder``/``name``/<seed>-<hash of their makers>/cases, answers in .../<run>; another ``run``
    answers the same cases anew. Every answer is on disk before a key is opened. Returns the figures, written to
    ``folder``/``name``.json (those of walls and of stacks under the name of their model) and, with the confusion matrix
    and a list of wrong answers, beside the answers.
    """
    chosen = BENCHES[name]
    designs = [design for design in chosen.designs(seed) if kind in (None, design.kind)][:cases]
    here = suite.place(folder, seed, name)
    if made_by := chosen.made_by:
        digest = hashlib.sha256(b"".join(Path(__file__).with_name(one).read_bytes() for one in made_by)).hexdigest()
        here = here.with_name(f"{here.name}-{digest[:8]}")
    runner.run_all(designs, seed, here / "cases", here / run, jobs=jobs, minutes=minutes, say=say, answering=answering)
    answered = [scored for _, scored in runner.answered(designs, here / "cases", here / run)]
    if not answered:
        say("no case was answered")
        return {}
    figures = {**chosen.figures(answered), "seed": seed, "run": run, "asked": len(designs)}
    for path in (folder / f"{name}.json", here / f"{run}.json"):
        write_json(path, {chosen.under: figures} if chosen.under else figures)
    draw_confusion(answered, here / f"{run}_confusion.png")
    wrong = wrong_answers(answered)
    (here / f"{run}_wrong.txt").write_text(wrong + "\n", encoding="utf-8")
    say(report.tables(figures))
    say(wrong)
    return figures
