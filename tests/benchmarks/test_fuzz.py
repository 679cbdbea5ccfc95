"""Inputs that once did harm, read again, and a few fresh ones for every reader; ``make fuzz`` reads 200 000."""

from __future__ import annotations

import random
import signal
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from benchmarks.fuzz import campaign
from benchmarks.fuzz.mutate import MOST_BYTES, mutate
from benchmarks.fuzz.readers import Reader, readers

CORPUS = Path(__file__).resolve().parents[1] / "corpus"
"""A folder a reader, a file an input."""
NAMES = (
    *(f"motion {kind}" for kind in ("AT2", "V2A", "V1", "CSV", "CSV, its TOML", "npz", "netCDF")),
    *(f"recording {kind}" for kind in ("CSV", "CSV, its TOML", "netCDF")),
    *("plan", "specimen", "law in a table", "outcomes", "outcomes, their table"),
    *("manifest", "block", "cube", "cube without its seal"),
)
FEW = {"cube without its seal": 1, "cube": 8}
"""Inputs for those of which each takes a process."""


@pytest.fixture
def alarm() -> Iterator[campaign.Alarm]:
    old = signal.getsignal(signal.SIGALRM)
    yield campaign.Alarm()
    signal.signal(signal.SIGALRM, old)


@pytest.fixture(scope="module")
def by_name() -> dict[str, Reader]:
    return {reader.name: reader for reader in readers()}


def test_every_reader_is_here(by_name: dict[str, Reader]) -> None:
    assert tuple(by_name) == NAMES


@pytest.mark.parametrize("name", NAMES)
def test_a_mutated_file_is_content_or_a_sentence(
    name: str, by_name: dict[str, Reader], tmp_path: Path, alarm: campaign.Alarm
) -> None:
    reader, draw = by_name[name], random.Random(name)
    campaign.prepare(reader, tmp_path)
    assert all(campaign.attempt(reader, tmp_path, seed, alarm) == ("", "accepted") for seed in reader.seeds[:1])
    kept = CORPUS / name.replace(" ", "_").replace(",", "")
    once = [path.read_bytes() for path in sorted(kept.glob("*"))]
    fresh = [mutate(draw.choice(reader.seeds), reader.seeds, draw, reader.binary) for _ in range(FEW.get(name, 60))]
    for data in once + fresh:
        wrong, where = campaign.attempt(reader, tmp_path, data, alarm)
        assert not wrong, f"{where}\n{data[:500]!r}"


@pytest.mark.parametrize("binary", [False, True])
def test_mutations_differ_and_stay_small(binary: bool) -> None:
    seeds, draw = (b"time_step = 0.01\n[columns]\nx = 1\n" * 20, b"a,b\n1,2\n"), random.Random(1)
    found = {mutate(draw.choice(seeds), seeds, draw, binary) for _ in range(500)}
    assert len(found) > 400 and max(map(len, found)) <= MOST_BYTES


def harmful(read: Callable[[Path], Any]) -> Reader:
    return Reader("harmful", "x", (b"x",), read)


def test_the_harness_sees_harm(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, alarm: campaign.Alarm) -> None:
    def fails(folder: Path) -> Any:
        raise KeyError("x")

    def takes_memory(folder: Path) -> Any:
        return len(b"x" * 400_000_000) and None

    silent = replace(harmful(lambda folder: 1), check=lambda result: "accepted although it has changed")
    for reader, wrong in (
        (harmful(fails), "tracebacks"),
        (silent, "silent"),
        (harmful(takes_memory), "over_memory"),
    ):
        assert campaign.attempt(reader, tmp_path, b"x", alarm)[0] == wrong
    assert campaign.attempt(harmful(lambda folder: None), tmp_path, b"x", alarm) == ("", "accepted")
    monkeypatch.setattr(campaign, "LONGEST", 0.1)
    assert campaign.attempt(harmful(lambda folder: _busy(5.0)), tmp_path, b"x", alarm)[0] == "hangs"
    monkeypatch.setattr(campaign, "WAITS", 1.0)
    assert campaign.attempt(harmful(lambda folder: time.sleep(20)), tmp_path, b"x", alarm)[0] == "hangs"


def _busy(seconds: float) -> None:
    begun = time.monotonic()
    while time.monotonic() - begun < seconds:
        pass
