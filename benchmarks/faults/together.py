"""Two runs at once, clocks that jump, and a worker with other code."""

from __future__ import annotations

import os
import random
import shutil
import time
from pathlib import Path

from benchmarks.faults.commands import ROOT, Command, cluster, run
from benchmarks.faults.files import finished_study
from benchmarks.faults.kills import SIZE, undisturbed, write_plan
from benchmarks.faults.row import Row
from benchmarks.faults.studies import NAME, compare_blocks, compare_cubes, digests


def two_runs(work: Path, n: int, draw: random.Random, row: Row, size: int = SIZE) -> None:
    """Several runs of one study started within a moment: one works, the others say so."""
    plan = write_plan(work, "housner", size)
    reference, results = undisturbed(plan, work), work / "two_runs"
    for _ in range(n):
        shutil.rmtree(results, ignore_errors=True)
        words = ("run", plan, "--results", results, "--scheduler", "threads")
        commands = []
        for _ in range(3):
            commands.append(Command(*words))
            time.sleep(draw.uniform(0.0, 0.4))
        ends = [command.end() for command in commands]
        for code, said in ends:
            row.heard(code, said)
        if not any(code == 0 for code, _ in ends):
            row.unreadable += 1
            row.notes.append("none of the runs came to its end")
        row.finished(*run(*words))
        compare_cubes(reference, results / NAME, row)
        row.injections += 1


def clocks(work: Path, n: int, draw: random.Random, row: Row) -> None:
    """Times of files years before or after now, as of a clock that was set or another machine's."""
    plan, reference = finished_study(work)
    for _ in range(n):
        results = work / "clocks"
        shutil.rmtree(results, ignore_errors=True)
        folder = Path(shutil.copytree(reference, results / NAME))
        for block in draw.sample(sorted((folder / "blocks").glob("*.nc")), 2):
            block.unlink()
        (folder / "blocks" / ".half.0.tmp").write_bytes(b"half")
        for path in folder.rglob("*"):
            moment = time.time() + draw.uniform(-1e9, 1e9)
            os.utime(path, (moment, moment))
        known = digests(folder, row)
        row.finished(*run("run", plan, "--results", results, "--scheduler", "synchronous"))
        compare_blocks(known, digests(folder, row), row)
        compare_cubes(reference, folder, row)
        row.injections += 1


def other_code(work: Path, n: int, draw: random.Random, row: Row, size: int = SIZE) -> None:
    """A worker whose sources differ in one line: refused with a sentence, and nothing is stored."""
    other = work / "other_code"
    if not other.exists():
        for room in ("models", "grids", "study", "diagnosis", "rocking"):
            shutil.copytree(ROOT / room, other / room, ignore=shutil.ignore_patterns("__pycache__"))
        with (other / "models" / "errors.py").open("a") as file:
            file.write("\n# another version\n")
    plan, results = write_plan(work, "housner", size), work / "other_results"
    with cluster(other) as found:
        for _ in range(n):
            shutil.rmtree(results, ignore_errors=True)
            code, said = run("run", plan, "--results", results, "--scheduler", found.address)
            row.heard(code, said)
            row.injections += 1
            if code != 2 or "another version" not in said or digests(results / NAME, row):
                row.wrong_cells += 1
                row.notes.append(f"exit code {code}: {said.strip()[-300:]}")


KINDS = {
    "three runs of one study at once": (10, two_runs),
    "clocks": (10, clocks),
    "another version of the code on the workers": (3, other_code),
}
