"""The block's cases of a folder of concealed recordings, answered first, then scored with their key."""

from __future__ import annotations

import multiprocessing
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

from benchmarks.diagnosis import report
from benchmarks.diagnosis.answers import Answering, answer, diagnosed, sha256
from benchmarks.diagnosis.files import read_json, write_json
from benchmarks.diagnosis.runner import one_thread
from benchmarks.diagnosis.scores import Scored
from grids.data_folder import data_folder
from grids.files import parse_toml
from models.errors import InputError

MODEL = "housner"


def folders(place: Path, half: str) -> list[Path]:
    """The cases of one half whose specimen is one block, in order; the number's parity decides."""
    chosen = [p for p in sorted(place.glob("case_*")) if int(p.name.rpartition("_")[2]) % 2 == (half == "odd")]
    return [p for p in chosen if parse_toml((p / "specimen.toml").read_text(encoding="utf-8"))["model"] == MODEL]


def concealed(
    place: Path | None,
    half: str,
    out: Path,
    *,
    jobs: int,
    minutes: float,
    run: str,
    say: Callable[[str], None],
    answering: Answering = diagnosed,
) -> dict[str, Any]:
    """Answer the ``half`` ('odd' or 'even') of ``place``, hash the answers, open the key, score.

    Writes ``out``/concealed_<half>.json. It goes on where it stopped and scores only when all are answered.
    """
    if place is None:
        data = data_folder()
        place = None if data is None else data / "recordings" / "concealed"
    if place is None or not (place / "answers.json").is_file():
        raise InputError(f"no concealed recordings in {place}: give --folder, or set ROCKING_DATA")
    answers = out / "concealed" / run
    waiting = folders(place, half)
    end = time.monotonic() + 60.0 * minutes
    one_thread()
    with ProcessPoolExecutor(jobs, mp_context=multiprocessing.get_context("spawn")) as pool:
        while waiting and time.monotonic() < end:
            batch, waiting = waiting[:jobs], waiting[jobs:]
            paths = [answers / f"{folder.name}.json" for folder in batch]
            found = pool.map(answer, batch, paths, [answering] * len(batch))
            for folder, said in zip(batch, found, strict=True):
                say(f"{folder.name}: {said['verdict']}, {said['seconds']:.0f} s")
    if waiting:
        say(f"{len(waiting)} cases are left: start again to go on")
        return {}
    hashes = {f.name: sha256(answers / f"{f.name}.json") for f in folders(place, half)}
    write_json(answers / f"{half}.sha256.json", hashes)

    keys = read_json(place / "answers.json")["cases"]
    scored = [Scored(name, read_json(answers / f"{name}.json"), keys[name]) for name in hashes]
    figures = {**report.summary(scored), "half": half, "run": run, "answers_sha256": hashes}
    write_json(out / f"concealed_{half}.json", figures)
    say(report.table(figures, f"concealed recordings, {half} cases of one block"))
    say(report.wrong(scored))
    return figures
