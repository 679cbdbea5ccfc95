"""The answer of the diagnosis to one case folder, as plain data, written before any key is opened."""

from __future__ import annotations

import errno
import hashlib
import json
import os
import time
import traceback
from collections.abc import Callable, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from diagnosis.answer.result import Diagnosis, Effect
from grids.files import read_text
from models.errors import InputError

ROOMS = ("models", "grids", "diagnosis")
ROOT = Path(__file__).resolve().parents[2]
FILES = "files_sha256"
"""The entry of an answer that says to which files it is one."""
OF_THE_MACHINE = (errno.ENOMEM, errno.ENOSPC, errno.EDQUOT, errno.EMFILE, errno.EIO)
"""Errors of memory, disk and files that are open, which another start may not meet."""
ANSWER_AGAIN = "delete it, so that the case is answered again."
NOTHING: dict[str, Any] = {"effects": [], "rivals": [], "constancy": [], "located": [], "base": {}}

Answering = Callable[[Path], dict[str, Any]]


def fingerprint() -> str:
    """sha256 (12 digits) of the sources that an answer depends on."""
    digest = hashlib.sha256()
    for room in ROOMS:
        for path in sorted((ROOT / room).rglob("*.py")):
            digest.update(path.relative_to(ROOT).as_posix().encode())
            digest.update(path.read_bytes())
    return digest.hexdigest()[:12]


def diagnosed(folder: Path) -> dict[str, Any]:
    """What `diagnosis.diagnose` says of a case folder."""
    from diagnosis.answer.diagnose import diagnose
    from grids.recordings import read_recording
    from grids.specimen import read_specimen

    specimen = read_specimen(folder / "specimen.toml")
    training = [read_recording(folder / f"train_{k}.nc") for k in (1, 2)]
    return plain(diagnose(specimen, training, [read_recording(folder / "test_1.nc")]))


def plain(found: Diagnosis) -> dict[str, Any]:
    """The parts of a diagnosis that are scored or read afterwards."""

    def effect(one: Effect) -> dict[str, Any]:
        entry = asdict(one)
        entry["class"] = entry.pop("effect_class")
        return entry

    return {
        "verdict": found.verdict,
        "statement": found.statement,
        "effects": [effect(one) for one in found.effects],
        "rivals": [
            {"name": rival.name, "class": rival.effect_class, "evidence_gap": rival.evidence_gap}
            for rival in found.rivals
        ],
        "constancy": [asdict(one) for one in found.constancy],
        "located": [asdict(one) for one in found.located],
        "base": {name: asdict(value) for name, value in found.base.items()},
        "fit": {"train": asdict(found.train), "holdout": None if found.holdout is None else asdict(found.holdout)},
        "p_value": found.p_value,
        "null_band": found.null_band,
        "reference_peak": found.reference_peak,
        "screen": [asdict(one) for one in found.screen],
        "finished": found.finished and not found.skipped,
    }


def answer(folder: Path, path: Path, answering: Answering = diagnosed) -> dict[str, Any]:
    """The answer to ``folder``, from ``path`` if it is there already; else found, timed and written.

    A failure is an answer too: verdict ``failed`` and its traceback; one of the machine (memory, disk) is not written,
    so that the case is tried again. What Ctrl-C cut short is none: a
    KeyboardInterrupt, and nothing is written, or it would be kept for the final one. ``seconds`` are by the clock,
    ``processor_seconds`` those in which the process had a core: other work on the machine adds to the first alone.
    """
    if path.is_file():
        return read_json(path)
    files = file_hashes(folder)
    begin, used = time.perf_counter(), time.process_time()
    keep = True
    try:
        found = answering(folder)
    except Exception as error:
        keep = not (isinstance(error, MemoryError) or getattr(error, "errno", None) in OF_THE_MACHINE)
        found = {"verdict": "failed", "statement": traceback.format_exc(), **NOTHING}
    if not found.get("finished", True):
        raise KeyboardInterrupt
    taken = {"seconds": time.perf_counter() - begin, "processor_seconds": time.process_time() - used}
    whole = {**found, **taken, "sources": fingerprint(), FILES: files}
    if keep:
        write_json(path, whole)
    return whole


def file_hashes(folder: Path) -> dict[str, str]:
    """sha256 of every file of a case by name, without hidden ones, which a file manager may leave."""
    return {path.name: sha256(path) for path in sorted(folder.glob("[!.]*")) if path.is_file()}


def check_same(path: Path, kept: Mapping[str, Any], folder: Path) -> None:
    """Raise InputError unless the answer ``kept`` in ``path`` is one to the case ``folder`` as it is now.

    A file that was put beside those of the case since then is none of its own.
    """
    cure = "name another folder with --out, or delete it so that the case is answered again."
    if FILES not in kept:
        raise InputError(f"{path} does not say to which files it is the answer (an earlier version's): {cure}")
    then, now = kept[FILES], file_hashes(folder)
    if changed := [name for name, digest in then.items() if now.get(name) != digest]:
        raise InputError(f"{path} is the answer to another {changed[0]} than that in {folder}: {cure}")


def sha256(path: Path) -> str:
    """Of a file."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def write_json(path: Path, content: Mapping[str, Any]) -> None:
    """Whole or not at all."""
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_suffix(".partial")
    partial.write_text(json.dumps(content, indent=1), encoding="utf-8")
    os.replace(partial, path)


def read_json(path: Path, cure: str = ANSWER_AGAIN) -> dict[str, Any]:
    """The object of a file; InputError with the cure where it is damaged."""
    try:
        content = json.loads(read_text(path, "file"))
    except (json.JSONDecodeError, RecursionError) as error:
        raise InputError(f"{path} is not valid JSON ({error}); {cure}") from None
    if not isinstance(content, dict):
        raise InputError(f"{path} is no JSON object in braces; {cure}")
    return content
