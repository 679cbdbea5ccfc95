"""A full disk at random byte counts, and folders that may not be written.

A limit on the size of files stands for the full disk: to the program and to the libraries below it both are a
write that is refused in the middle of a file.
"""

from __future__ import annotations

import ctypes
import random
import shutil
import sys
from functools import partial
from pathlib import Path

from benchmarks.faults.commands import run
from benchmarks.faults.files import finished_study
from benchmarks.faults.row import Row
from benchmarks.faults.studies import NAME, compare_blocks, compare_cubes, digests


def full_while_running(work: Path, n: int, draw: random.Random, row: Row, *, last: str) -> None:
    """Full in any file up to the largest one of ``last``: plan, manifest, a block or the cube."""
    plan, reference = finished_study(work)
    largest = max(path.stat().st_size for path in reference.glob(last))
    for _ in range(n):
        results = work / "full"
        shutil.rmtree(results, ignore_errors=True)
        words = ("run", plan, "--results", results, "--scheduler", draw.choice(("synchronous", "threads")))
        code, said = run(*words, largest_file=draw.randrange(largest))
        row.heard(code, said)
        if code and str(results) not in said:
            row.unclear_messages += 1
            row.notes.append(f"names no place: {said.strip()[-300:]}")
        known = digests(results / NAME, row) if (results / NAME).exists() else {}
        row.finished(*run(*words))
        compare_blocks(known, digests(results / NAME, row), row)
        compare_cubes(reference, results / NAME, row)
        row.injections += 1


def full_while_writing(
    work: Path, n: int, draw: random.Random, row: Row, *, words: tuple[str, ...], name: str, most: int
) -> None:
    """Full in a file that a command makes of a study: refused with its place, and no half file is left."""
    _, reference = finished_study(work)
    for _ in range(n):
        out = work / name
        out.unlink(missing_ok=True)
        given = out if out.suffix in (".csv", ".nc") else out.parent  # figures are named by the command
        code, said = run(words[0], reference, *words[1:], "--out", given, largest_file=draw.randrange(most))
        row.heard(code, said)
        row.injections += 1
        if code == 0 or out.exists() or out.name not in said:
            row.unclear_messages += code == 0 or out.name not in said
            row.unreadable += out.exists()
            row.notes.append(
                f"exit code {code}, file {'there' if out.exists() else 'not there'}: {said.strip()[-300:]}"
            )


def write_example(folder: str) -> None:
    """Write an answer of a diagnosis as the command does."""
    from diagnosis.report import write_answer
    from tests.diagnosis.report.example import diagnosis, recordings, specimen

    *train, test = recordings()
    try:
        write_answer(diagnosis(), specimen(), train, [test], folder)
    except OSError as error:
        print(f"error: {error}")
        sys.exit(2)


def full_while_answering(work: Path, n: int, draw: random.Random, row: Row) -> None:
    """Full in a file of a diagnosis: whatever is there is whole."""
    whole, folder = work / "answer", work / "answer_cut"
    row.finished(*run(whole, work=write_example))
    sizes = {path.relative_to(whole): path.stat().st_size for path in whole.rglob("*") if path.is_file()}
    for _ in range(n):
        shutil.rmtree(folder, ignore_errors=True)
        code, said = run(folder, largest_file=draw.randrange(max(sizes.values())), work=write_example)
        row.heard(code, said)
        row.injections += 1
        left = {path.relative_to(folder): path.stat().st_size for path in folder.rglob("*") if path.is_file()}
        # provenance holds a time and so a few bytes more or less
        half = [name for name, size in left.items() if name not in sizes or abs(size - sizes[name]) > 64]
        row.unreadable += len(half)
        row.notes += [f"{name} is half written" for name in half]
        if code == 0 or str(folder) not in said:
            row.unclear_messages += 1
            row.notes.append(f"exit code {code}: {said.strip()[-300:]}")


CAPABILITIES_VERSION, DAC_OVERRIDE = 0x20080522, 1 << 1
"""Of Linux: the layout of what is handed over; the right to write where permissions refuse it."""


def obey_permissions() -> None:
    """Give up the right of a superuser to write everywhere; to anybody else nothing changes."""
    libc = ctypes.CDLL(None, use_errno=True)
    header, rights = (ctypes.c_uint32 * 2)(CAPABILITIES_VERSION, 0), (ctypes.c_uint32 * 6)()
    refused = libc.capget(header, rights)
    rights[0] &= ~DAC_OVERRIDE  # effective
    rights[1] &= ~DAC_OVERRIDE  # permitted
    if refused or libc.capset(header, rights):
        raise OSError(ctypes.get_errno(), "cannot give up a capability")


def run_obeying_permissions(*words: str) -> None:
    from benchmarks.faults.commands import _command_line

    obey_permissions()
    _command_line(*words)


def read_only(work: Path, n: int, draw: random.Random, row: Row) -> None:
    """A folder of results, of a study or of its blocks that may not be written."""
    plan, reference = finished_study(work)
    for _ in range(n):
        results = work / "read_only"
        shutil.rmtree(results, ignore_errors=True)
        folder = Path(shutil.copytree(reference, results / NAME))
        for block in draw.sample(sorted((folder / "blocks").glob("*.nc")), 2):
            block.unlink()
        known = digests(folder, row)
        closed = draw.choice((results, folder, folder / "blocks"))
        closed.chmod(0o555)
        code, said = run("run", plan, "--results", results, "--scheduler", "synchronous", work=run_obeying_permissions)
        row.heard(code, said)
        if code and str(results) not in said:
            row.unclear_messages += 1
            row.notes.append(f"names no place: {said.strip()[-300:]}")
        closed.chmod(0o755)
        compare_blocks(known, digests(folder, row), row)
        row.finished(*run("run", plan, "--results", results, "--scheduler", "synchronous"))
        compare_cubes(reference, folder, row)
        row.injections += 1


KINDS = {
    "disk full in a block": (30, partial(full_while_running, last="blocks/*.nc")),
    "disk full in the cube": (30, partial(full_while_running, last="cube.nc")),
    "disk full in an export, csv": (
        20, partial(full_while_writing, words=("export",), name="part.csv", most=5000),
    ),
    "disk full in an export, netCDF": (
        20, partial(full_while_writing, words=("export",), name="part.nc", most=5000),
    ),
    "disk full in a map": (
        10,
        partial(
            full_while_writing, words=("map", "--x", "aspect_ratio", "--y", "pga"), name="maps/overturning_map.png",
            most=5000,
        ),
    ),
    "disk full in a diagnosis": (20, full_while_answering),
    "a folder that may not be written": (12, read_only),
}  # fmt: skip
