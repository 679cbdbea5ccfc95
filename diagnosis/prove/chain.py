"""The whole chain on a folder of concealed cases: answers first, hashed before the key is read, then scored.

A case is a folder ``case_NN`` with specimen.toml, train_1.nc, train_2.nc and test_1.nc; the key of all is
answers.json beside them, ``{"cases": {"case_NN": {"kind", "effects", "recordings", ...}}}``.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path
from typing import Any

from diagnosis.prove import figures, report
from diagnosis.prove.answers import Answering, answer, check_same, diagnosed, fingerprint, read_json, sha256, write_json
from diagnosis.prove.cases import check_answer, check_files, check_key
from diagnosis.prove.pool import in_turn, processes
from diagnosis.prove.scores import Scored
from grids.files import parse_toml, read_text
from models.errors import InputError

KEY = "answers.json"
RESTORE = "restore the key from where the cases come from."
HALVES = ("all", "odd", "even")
HASHES = "sha256.json"


def cases_in(folder: Path, half: str = "all", model: str | None = None) -> list[Path]:
    """The cases of a folder in order: of one half by their numbers, of one model if given. Raises InputError."""
    if half not in HALVES:
        raise InputError(f"half is '{half}': take one of {', '.join(HALVES)}.")
    if not (folder / KEY).is_file():
        raise InputError(f"no concealed cases in {folder}: give a folder with case_01, case_02 ... and {KEY}.")
    found = sorted(path for path in folder.glob("case_*") if path.is_dir())
    if half != "all":
        found = [path for path in found if _number(path) % 2 == (half == "odd")]
    if model is not None:
        found = [p for p in found if parse_toml(read_text(p / "specimen.toml", "specimen")).get("model") == model]
    if not found:
        raise InputError(f"no case of {folder} is left ({half}, {model or 'any model'}): choose others.")
    return found


def _number(path: Path) -> int:
    digits = path.name.rpartition("_")[2]
    if not digits.isdigit():
        raise InputError(f"{path}: a half is chosen by the number of a case; name it case_01, or take all.")
    return int(digits)


def prove(
    folder: Path,
    out: Path,
    *,
    half: str = "all",
    model: str | None = None,
    jobs: int = 2,
    minutes: float = 600.0,
    say: Callable[[str], None],
    answering: Answering = diagnosed,
) -> dict[str, Any]:
    """Answer the cases of ``folder``, hash the answers, open the key, score and draw.

    The key is not used for answering; its form is checked before the first case, as are the files of all cases.

    Answers lie in ``out``/answers, a file a case; those that are there are kept, so that it goes on where it stopped.
    No case begins after ``minutes``. Only when all are answered are they hashed (``out``/sha256.json) and scored
    (``out``/prove.json, wrong.txt and figures). Returns the figures, empty when cases are left. Raises InputError.
    """
    chosen = cases_in(folder, half, model)
    answers = out / "answers"
    # Only its form is looked at: a slip in the key must not show after hours of answering.
    check_key(folder / KEY, read_json(folder / KEY, RESTORE), [path.name for path in chosen])
    check_files(chosen)
    waiting = [path for path in chosen if not (answers / f"{path.name}.json").is_file()]
    for path in chosen:
        if path not in waiting:
            kept = answers / f"{path.name}.json"
            content = read_json(kept)
            check_answer(kept, content)
            check_same(kept, content, path)
    say(f"{len(chosen) - len(waiting)} of {len(chosen)} cases were answered before")
    begun: list[Path] = []
    with processes(jobs) as pool:

        def submit(path: Path) -> Future[dict[str, Any]]:
            begun.append(path)
            return pool.submit(answer, path, answers / f"{path.name}.json", answering)

        try:
            for path, done in in_turn(submit, waiting, jobs, minutes):
                found = done.result()
                why = f" ({found['statement'].strip().splitlines()[-1]})" if found["verdict"] == "failed" else ""
                say(f"{path.name}: {found['verdict']}{why}, {found['seconds']:.0f} s")
        except BrokenProcessPool:
            lost = ", ".join(path.name for path in begun if not (answers / f"{path.name}.json").is_file())
            raise InputError(
                f"a process was killed while it answered one of {lost} (is memory short?); answers are kept "
                f"in {answers}: start again, with --jobs 1 where memory is short."
            ) from None
    if left := [path for path in chosen if not (answers / f"{path.name}.json").is_file()]:
        say(f"{len(left)} cases are left: start again to go on")
        return {}
    hashes = {path.name: sha256(answers / f"{path.name}.json") for path in chosen}
    write_json(out / HASHES, hashes)
    keys = read_json(folder / KEY, RESTORE)["cases"]
    scored = [Scored(name, read_json(answers / f"{name}.json"), keys[name]) for name in hashes]
    numbers = {**report.summary(scored), **report.provenance(scored), "answers_sha256": hashes}
    write_json(out / "prove.json", numbers)
    (out / "wrong.txt").write_text(report.wrong(scored) + "\n", encoding="utf-8")
    figures.draw_all(scored, out)
    say(report.table(numbers, f"{folder.name}, {half}"))
    for warning in report.warnings(numbers, fingerprint()):
        say(warning)
    if wrong := report.wrong(scored):
        say(wrong)
    return numbers
