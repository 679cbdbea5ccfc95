"""Faults injected once each; ``make faults`` injects hundreds."""

from __future__ import annotations

import random
from collections.abc import Iterator
from pathlib import Path

import pytest

from benchmarks.faults import disk, files, together
from benchmarks.faults.row import Row

KINDS = {**files.KINDS, **disk.KINDS, **together.KINDS}
ONCE = (
    "block swapped",
    "cube.nc a link",
    "study.toml replaced",
    "disk full in the cube",
    "disk full in an export, netCDF",
    "disk full in a map",
    "disk full in a diagnosis",
    "a folder that may not be written",
    "three runs of one study at once",
    "clocks",
)


@pytest.fixture(scope="module")
def work(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("FAULTS_MODELS", "housner")
        yield tmp_path_factory.mktemp("faults")


@pytest.mark.parametrize("kind", ONCE)
def test_a_fault_does_no_harm(kind: str, work: Path) -> None:
    row = Row(kind)
    KINDS[kind][1](work, 1, random.Random(kind), row)
    assert row.injections == 1 and row.clean, row.notes


def test_tracebacks_and_silence_are_unclear() -> None:
    row = Row("words")
    row.heard(0, "written: x")
    row.heard(2, "error: x is no file")
    assert row.clean
    row.heard(1, "Traceback (most recent call last):")
    row.heard(2, "")
    assert row.unclear_messages == 2 and not row.clean
