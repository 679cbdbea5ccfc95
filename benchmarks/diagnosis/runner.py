"""Runs cases on several processes within a time, and goes on where it stopped."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Future
from pathlib import Path

from benchmarks.diagnosis import bases, stacks, walls
from benchmarks.diagnosis import cases as blocks
from benchmarks.diagnosis.files import write_case
from benchmarks.diagnosis.suite import CaseDesign
from diagnosis.prove.answers import Answering, answer, diagnosed, read_json
from diagnosis.prove.pool import in_turn, processes
from diagnosis.prove.scores import Scored


def run_case(design: CaseDesign, seed: int, cases: Path, answers: Path, answering: Answering = diagnosed) -> str:
    """Make the case unless it is there, answer it unless that is done; the answer's verdict."""
    folder, _ = made(design, seed, cases)
    return str(answer(folder, answers / f"{design.label}.json", answering)["verdict"])


def made(design: CaseDesign, seed: int, cases: Path) -> tuple[Path, Path]:
    """Folder and key of a case, made unless it is there."""
    folder, key = cases / design.label, cases / "keys" / f"{design.label}.json"
    if not key.is_file():
        makers = {walls.WallDesign: walls.make, stacks.StackDesign: stacks.make, bases.BaseDesign: bases.make}
        write_case(makers.get(type(design), blocks.make)(design, seed), folder, key)
    return folder, key


def run_all(
    designs: Sequence[CaseDesign],
    seed: int,
    cases: Path,
    answers: Path,
    *,
    jobs: int,
    minutes: float,
    say: Callable[[str], None],
    answering: Answering = diagnosed,
) -> None:
    """Run the cases in order; none is begun after ``minutes``. ``answering`` must be a module's function."""
    waiting = [w for w in designs if not (answers / f"{w.label}.json").is_file()]
    say(f"{len(designs) - len(waiting)} of {len(designs)} cases were answered before")
    with processes(jobs) as pool:

        def submit(design: CaseDesign) -> Future[str]:
            return pool.submit(run_case, design, seed, cases, answers, answering)

        for design, done in in_turn(submit, waiting, jobs, minutes):
            say(f"{design.label} {design.kind} {' + '.join(design.names)}: {_outcome(done)}")


def _outcome(done: Future[str]) -> str:
    try:
        return done.result()
    except Exception as error:  # the case that failed is reported, the others go on
        return f"not made: {type(error).__name__}: {error}"


def answered(designs: Sequence[CaseDesign], cases: Path, answers: Path) -> list[tuple[CaseDesign, Scored]]:
    """Every case that has an answer, beside its key."""
    found = []
    for design in designs:
        path = answers / f"{design.label}.json"
        if path.is_file():
            key = read_json(cases / "keys" / f"{design.label}.json")
            found.append((design, Scored(design.label, read_json(path), key)))
    return found
