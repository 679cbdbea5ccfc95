"""Ctrl-C, killed workers and half-finished answers: none of them is ever stored as an answer."""

from __future__ import annotations

import os
import signal
import time
from pathlib import Path
from typing import Any

import pytest

from diagnosis.prove.answers import NOTHING, answer
from diagnosis.prove.pool import processes


def interrupted(folder: Path) -> dict[str, Any]:
    """What Ctrl-C at a terminal does: every process of its group gets the signal."""
    os.kill(os.getpid(), signal.SIGINT)
    time.sleep(0.2)
    return {"verdict": "nothing_missing", **NOTHING}


def slow(folder: Path) -> dict[str, Any]:
    (folder / "begun").touch()
    time.sleep(60.0)
    return {"verdict": "nothing_missing", **NOTHING}


def test_a_worker_leaves_ctrl_c_to_its_parent(tmp_path: Path) -> None:
    with processes(1) as pool:
        found = pool.submit(answer, tmp_path, tmp_path / "answers" / "1.json", interrupted).result()
    assert found["verdict"] == "nothing_missing"


def test_ctrl_c_ends_the_workers_at_once_and_writes_nothing(tmp_path: Path) -> None:
    begin = time.monotonic()
    with pytest.raises(KeyboardInterrupt), processes(1) as pool:
        pool.submit(answer, tmp_path, tmp_path / "answers" / "1.json", slow)
        while not (tmp_path / "begun").exists():
            time.sleep(0.05)
        raise KeyboardInterrupt
    assert time.monotonic() - begin < 50.0
    assert not (tmp_path / "answers").exists()


def test_an_unfinished_answer_is_not_written(tmp_path: Path) -> None:
    with pytest.raises(KeyboardInterrupt):
        answer(tmp_path, tmp_path / "1.json", lambda folder: {"verdict": "missing", **NOTHING, "finished": False})
    assert not (tmp_path / "1.json").exists()
