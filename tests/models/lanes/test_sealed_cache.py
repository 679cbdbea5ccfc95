"""A damaged file of machine code is found, said and compiled anew."""

from __future__ import annotations

import logging
import os
import random
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

KERNEL = """
import numba, os, sys
from models.lanes.sealed_cache import compile_once, seal_cache
@numba.njit(cache=True)
def kernel(x):
    return 2.0 * x + 1.0
seal_cache(kernel)
compile_once(kernel)
kernel(3.0)
print(kernel(20.0), sum(kernel.stats.cache_hits.values()))
"""


@pytest.fixture
def kernel(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[], tuple[str, str]]:
    """Calls a kernel in a fresh process; its result with the number of kernels taken from files, and what it says."""
    script = tmp_path / "script.py"
    script.write_text(KERNEL)
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "cache"))
    monkeypatch.setenv("PYTHONPATH", str(Path(__file__).resolve().parents[3]))

    def call() -> tuple[str, str]:
        done = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, check=True)
        return done.stdout.strip(), done.stderr

    return call


def test_files_are_used_until_they_are_damaged(kernel: Callable[[], tuple[str, str]], tmp_path: Path) -> None:
    assert kernel() == ("41.0 0", "")
    assert kernel() == ("41.0 1", "")
    for suffix, damage in (
        ("nbi", lambda data: b""),
        ("nbc", lambda data: data[: len(data) // 2] + bytes([data[len(data) // 2] ^ 255]) + data[len(data) // 2 + 1 :]),
    ):
        (path,) = (tmp_path / "cache").rglob(f"*.{suffix}")
        path.write_bytes(damage(path.read_bytes()))
        result, said = kernel()
        assert result == "41.0 0" and "is damaged: compiled anew" in said
        assert kernel() == ("41.0 1", "")


def test_of_several_processes_one_compiles(tmp_path: Path) -> None:
    script = tmp_path / "script.py"
    script.write_text(KERNEL)
    environment = {
        **os.environ, "NUMBA_CACHE_DIR": str(tmp_path / "cache"), "PYTHONPATH": str(Path(__file__).resolve().parents[3])
    }  # fmt: skip
    at_once = [
        subprocess.Popen([sys.executable, str(script)], stdout=subprocess.PIPE, env=environment, text=True)
        for _ in range(4)
    ]
    assert sorted(one.communicate()[0].strip() for one in at_once) == ["41.0 0", "41.0 1", "41.0 1", "41.0 1"]


def test_no_flipped_bit_is_executed(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    from models.lanes.sealed_cache import SealedFiles

    files = SealedFiles(str(tmp_path), "kernel", "stamp")
    files.save("key", {"code": bytes(range(200))})
    draw = random.Random(5)
    for path in tmp_path.iterdir():
        whole = path.read_bytes()
        for _ in range(100):
            data = bytearray(whole)
            data[draw.randrange(len(data))] ^= 1 << draw.randrange(8)
            path.write_bytes(data)
            with caplog.at_level(logging.ERROR):
                assert files.load("key") is None
        path.write_bytes(whole)
    assert files.load("key") == {"code": bytes(range(200))}


def test_code_of_another_kernel_is_not_executed(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    """Exchanged files, and those of two processes that gave code for different types the same number."""
    from models.lanes.sealed_cache import SealedFiles

    one, other = (SealedFiles(str(tmp_path), name, "stamp") for name in ("one", "other"))
    one.save("float", "code of one"), other.save("float", "code of other")
    for suffix in ("nbi", "1.nbc"):
        first, second = tmp_path / f"one.{suffix}", tmp_path / f"other.{suffix}"
        first.rename(tmp_path / "aside"), second.rename(first), (tmp_path / "aside").rename(second)
        with caplog.at_level(logging.ERROR):
            assert one.load("float") is None and other.load("float") is None
        first.rename(tmp_path / "aside"), second.rename(first), (tmp_path / "aside").rename(second)
    assert (one.load("float"), other.load("float")) == ("code of one", "code of other")
    late = SealedFiles(str(tmp_path), "one", "stamp")
    late._save_data("one.1.nbc", ("one.nbi", "integer", "code for integers"))
    with caplog.at_level(logging.ERROR):
        assert one.load("float") is None


def test_code_that_cannot_be_kept_is_said(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    from models.lanes.sealed_cache import SealedFiles

    SealedFiles(str(tmp_path / "gone"), "kernel", "stamp").save("key", "code")
    assert "compiled again next time" in caplog.text
