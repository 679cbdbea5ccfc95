"""Damage to every file of a finished study, one at a time; commands that read it, then a run that mends it."""

from __future__ import annotations

import random
import shutil
import subprocess
import sys
from collections.abc import Callable
from functools import partial
from itertools import product
from pathlib import Path

from benchmarks.faults.commands import environment, run
from benchmarks.faults.row import Row
from benchmarks.faults.studies import NAME, compare_blocks, compare_cubes, digests, tiny_text
from models.errors import InputError
from study.open import open_study

Damage = Callable[[Path, Path, random.Random], None]
"""Of a file, given another one of the folder."""


def truncate(path: Path, other: Path, draw: random.Random) -> None:
    path.write_bytes(path.read_bytes()[: draw.randrange(path.stat().st_size)])


def flip(path: Path, other: Path, draw: random.Random) -> None:
    data = bytearray(path.read_bytes())
    for _ in range(draw.choice((1, 1, 8))):
        data[draw.randrange(len(data))] ^= 1 << draw.randrange(8)
    path.write_bytes(data)


def swap(path: Path, other: Path, draw: random.Random) -> None:
    one, two = path.read_bytes(), other.read_bytes()
    path.write_bytes(two)
    other.write_bytes(one)


def delete(path: Path, other: Path, draw: random.Random) -> None:
    path.unlink()


def replace(path: Path, other: Path, draw: random.Random) -> None:
    """By another file of the folder, or by what no program wrote."""
    path.write_bytes(draw.choice((other.read_bytes(), draw.randbytes(2000), b"", b"\0" * 5000)))


def link(path: Path, other: Path, draw: random.Random) -> None:
    """To another file, to nothing, or to itself."""
    path.unlink()
    path.symlink_to(draw.choice((other, path.with_name("nowhere"), path)))


def extend(path: Path, other: Path, draw: random.Random) -> None:
    with path.open("ab") as file:
        file.write(draw.randbytes(draw.randrange(1, 3000)))


DAMAGES: dict[str, Damage] = {
    "cut short": truncate, "bits flipped": flip, "swapped": swap, "deleted": delete, "replaced": replace,
    "a link": link, "grown": extend,
}  # fmt: skip
FILES = ("block", "manifest.json", "cube.nc", "study.toml")


def finished_study(work: Path) -> tuple[Path, Path]:
    """Plan and folder of a tiny finished study."""
    plan, results = work / "tiny.toml", work / "tiny"
    plan.write_text(tiny_text())
    if not (results / NAME / "cube.nc").exists():
        code, said = run("run", plan, "--results", results, "--scheduler", "synchronous")
        if code:
            raise RuntimeError(f"the undisturbed run fails: {said}")
    return plan, results / NAME


def chosen(folder: Path, file: str, draw: random.Random) -> tuple[Path, Path]:
    """The file to damage, and another one."""
    blocks = sorted((folder / "blocks").glob("*.nc"))
    one, other = draw.sample(blocks, 2)
    if file == "block":
        return one, draw.choice((other, other, folder / "manifest.json"))
    return folder / file, draw.choice((one, *(folder / name for name in FILES[1:] if name != file)))


def damaged(work: Path, n: int, draw: random.Random, row: Row, *, file: str, damage: Damage) -> None:
    """Damage, read by every command, run again, compare."""
    plan, reference = finished_study(work)
    whole = digests(reference, row)
    for _ in range(n):
        results = work / "damaged"
        shutil.rmtree(results, ignore_errors=True)
        folder = Path(shutil.copytree(reference, results / NAME))
        path, other = chosen(folder, file, draw)
        touched = {path.stem, other.stem}
        damage(path, other, draw)
        for words in (
            ("status", folder),
            ("check", folder, "--cells", "5"),
            ("export", folder, "--out", results / "c.csv"),
        ):
            row.heard(*run(*words))
        delivered(reference, folder, row)
        row.finished(*run("run", plan, "--results", results, "--scheduler", "synchronous"))
        kept = {key: digest for key, digest in whole.items() if key not in touched}
        compare_blocks(kept, digests(folder, row), row)
        compare_cubes(reference, folder, row)
        row.heard(*run("check", folder, "--cells", "5"))
        row.injections += 1


def delivered(reference: Path, folder: Path, row: Row) -> None:
    """What a reader of the damaged folder gets: the cube as it was, or a refusal."""
    try:
        open_study(folder)
    except InputError:
        return
    compare_cubes(reference, folder, row)


def cached_kernels(work: Path, n: int, draw: random.Random, row: Row, *, damage: Damage) -> None:
    """Files of machine code: a fresh process finds the damage and compiles anew; the answer is the same."""
    plan, reference = finished_study(work)
    for _ in range(n):
        results = work / "cached"
        shutil.rmtree(results, ignore_errors=True)
        code, said = fresh_run(plan, results, work / "cache")  # fills the cache where it has none
        row.finished(code, said)
        files = sorted(path for path in (work / "cache").rglob("*.nb?"))
        one, other = draw.sample(files, 2)
        damage(one, other, draw)
        shutil.rmtree(results)
        row.finished(*fresh_run(plan, results, work / "cache"))
        compare_cubes(reference, results / NAME, row)
        row.injections += 1


def fresh_run(plan: Path, results: Path, cache: Path) -> tuple[int, str]:
    """A run in an interpreter of its own, with a cache of kernels of its own."""
    words = [sys.executable, "-m", "rocking", "run", str(plan), "--results", str(results), "--scheduler", "synchronous"]
    cache.mkdir(mode=0o700, exist_ok=True)
    done = subprocess.run(words, capture_output=True, text=True, env={**environment(), "XDG_CACHE_HOME": str(cache)})
    return done.returncode, done.stdout + done.stderr


KINDS = {
    **{
        f"{file} {name}": (10, partial(damaged, file=file, damage=damage))
        for file, (name, damage) in product(FILES, DAMAGES.items())
    },
    **{f"cached kernel {name}": (2, partial(cached_kernels, damage=damage)) for name, damage in DAMAGES.items()},
}
