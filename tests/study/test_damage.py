"""Damage to a study's folder is found, said and mended: never a wrong cell, never a finished block given up."""

from __future__ import annotations

import json
import os
import random
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
import xarray as xr

from grids.plan import parse_plan
from models.errors import InputError
from study.check import check
from study.manifest import DamagedManifest, Manifest
from study.open import open_study
from study.run import Report, run
from study.seal import is_intact, seal
from study.state import state
from tests.study.cubes import assert_identical
from tests.study.plans import plan_text, small_plan

Damage = Callable[[Path], object]


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, xr.Dataset]:
    """A study of seven blocks."""
    import study.run

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(study.run, "cells_per_block", lambda plan, sample, workers: 24)
        report = run(small_plan(), results=tmp_path_factory.mktemp("finished"), scheduler="synchronous")
    assert report.blocks == 7
    return report.folder, open_study(report.folder)


@pytest.fixture
def folder(finished: tuple[Path, xr.Dataset], tmp_path: Path) -> Path:
    return Path(shutil.copytree(finished[0], tmp_path / "small"))


def again(folder: Path) -> Report:
    return run(small_plan(), results=folder.parent, scheduler="synchronous")


def blocks(folder: Path) -> list[Path]:
    return sorted((folder / "blocks").glob("*.nc"))


def flip(path: Path, at: int, bit: int = 0) -> None:
    data = bytearray(path.read_bytes())
    data[at] ^= 1 << bit
    path.write_bytes(data)


def shorten(path: Path) -> None:
    path.write_bytes(path.read_bytes()[:-7])


DAMAGES: dict[str, Damage] = {
    "copied": lambda folder: shutil.copy(blocks(folder)[0], blocks(folder)[1]),
    "cut short": lambda folder: shorten(blocks(folder)[2]),
    "empty": lambda folder: blocks(folder)[3].write_bytes(b""),
    "header": lambda folder: flip(blocks(folder)[4], 20),
    "checksum": lambda folder: flip(blocks(folder)[5], -1),
    "other program's": lambda folder: blocks(folder)[6].write_bytes(b"CDF\x01" + bytes(400)),
}


@pytest.mark.parametrize("damage", DAMAGES)
def test_a_damaged_block_is_computed_anew_and_said(
    finished: tuple[Path, xr.Dataset], folder: Path, damage: str
) -> None:
    DAMAGES[damage](folder)
    assert "damaged blocks: 1" in str(state(folder))
    with pytest.raises(InputError, match=r"damaged blocks: 1.*run the plan again"):
        check(folder)
    report = again(folder)
    assert (report.computed, report.reused) == (1, 6)
    assert "blocks not as they had been written, computed anew: 1" in str(report)
    assert_identical(open_study(folder), finished[1])


def test_no_flipped_bit_passes(finished: tuple[Path, xr.Dataset], folder: Path) -> None:
    """Any bit of a block's file; the checksum needs no library that trusts the file."""
    path = blocks(folder)[0]
    whole = path.read_bytes()
    draw = random.Random(3)
    for _ in range(300):
        path.write_bytes(whole)
        flip(path, draw.randrange(len(whole)), draw.randrange(8))
        assert not is_intact(path, path.stem)
    path.write_bytes(whole)
    assert is_intact(path, path.stem) and not is_intact(path, blocks(folder)[1].stem)


def swap_keys(folder: Path, sealed: bool) -> None:
    """Two keys exchanged in the manifest; ``sealed``: by somebody who mends its checksum too."""
    from study.manifest import checksum

    path = folder / "manifest.json"
    record = json.loads(path.read_text())
    one, other = sorted(record["blocks"])[:2]
    record["blocks"][one], record["blocks"][other] = record["blocks"][other], record["blocks"][one]
    if sealed:
        del record["sha256"]
        record["sha256"] = checksum(record)
    path.write_text(json.dumps(record))


MANIFESTS: dict[str, Damage] = {
    "lost": lambda folder: (folder / "manifest.json").unlink(),
    "cut short": lambda folder: shorten(folder / "manifest.json"),
    "not text": lambda folder: (folder / "manifest.json").write_bytes(b"\xff\xfe"),
    "nested": lambda folder: (folder / "manifest.json").write_text("[" * 100_000),
    "keys swapped": lambda folder: swap_keys(folder, sealed=False),
    "keys swapped and sealed": lambda folder: swap_keys(folder, sealed=True),
}


@pytest.mark.parametrize("damage", MANIFESTS)
def test_a_damaged_manifest_is_made_anew_and_no_block_is_given_up(
    finished: tuple[Path, xr.Dataset], folder: Path, damage: str
) -> None:
    MANIFESTS[damage](folder)
    lost = blocks(folder)[2]
    lost.unlink()
    report = again(folder)
    assert (report.computed, report.reused) == (1, 6)
    assert "finished blocks kept: 6" in str(report)
    assert_identical(open_study(folder), finished[1])
    assert again(folder).repaired == ()


def test_a_lost_manifest_is_told_from_a_folder_without_a_study(folder: Path, tmp_path: Path) -> None:
    (folder / "manifest.json").unlink()
    with pytest.raises(InputError, match=r"manifest.json is lost: run the plan again"):
        state(folder)
    os.mkfifo(folder / "manifest.json")
    with pytest.raises(InputError, match=r"manifest.json is lost: run the plan again"):
        state(folder)
    (tmp_path / "empty").mkdir()
    with pytest.raises(InputError, match="holds no study"):
        state(tmp_path / "empty")


def test_blocks_of_another_plan_are_not_given_up_without_a_manifest(folder: Path) -> None:
    (folder / "manifest.json").unlink()
    with pytest.raises(InputError, match="computed for another plan"):
        run(small_plan(mass="900 kg"), results=folder.parent)
    assert len(blocks(folder)) == 7


def test_a_manifest_that_leads_outside_is_damaged(folder: Path) -> None:
    path = folder / "manifest.json"
    path.write_text(path.read_text().replace(blocks(folder)[0].stem, "../../../evil"))
    with pytest.raises(DamagedManifest):
        Manifest.load(folder)
    again(folder)
    assert not list(folder.parent.rglob("evil*"))


def test_a_changed_cube_is_refused_and_written_anew(finished: tuple[Path, xr.Dataset], folder: Path) -> None:
    cube = folder / "cube.nc"
    flip(cube, cube.stat().st_size // 2)
    with pytest.raises(InputError, match="has changed since it was written"):
        open_study(folder)
    again(folder)
    assert_identical(open_study(folder), finished[1])


@pytest.mark.parametrize("content", [b"\xff\xfe no text", b"[study", b"", None])
def test_a_damaged_plan_is_a_sentence_and_kept_anew(folder: Path, content: bytes | None) -> None:
    plan = folder / "study.toml"
    whole = plan.read_bytes()
    plan.unlink() if content is None else plan.write_bytes(content)
    with pytest.raises(InputError, match=r"study\.toml.*[Rr]un the plan again"):
        check(folder)
    assert again(folder).computed == 0
    assert plan.read_bytes() == whole and not check(folder, cells=3).differing


def test_a_lock_that_is_a_link_is_refused(folder: Path, tmp_path: Path) -> None:
    precious = tmp_path / "precious.txt"
    precious.write_text("mine")
    (folder / ".lock").unlink(missing_ok=True)
    (folder / ".lock").symlink_to(precious)
    with pytest.raises(OSError):
        again(folder)
    assert precious.read_text() == "mine"


def test_reasons_of_failure_may_be_unreadable(folder: Path) -> None:
    (folder / "failed").mkdir(exist_ok=True)
    (folder / "failed" / "abc.txt").write_bytes(b"\xff no text")
    assert "no text" in str(state(folder))


def test_a_seal_covers_name_and_bytes(tmp_path: Path) -> None:
    path = tmp_path / "file"
    path.write_bytes(bytes(range(256)) * 10_000)
    assert not is_intact(path, "a")
    seal(path, "a")
    assert is_intact(path, "a") and not is_intact(path, "b")


def test_a_cube_older_than_its_plan_is_not_checked_against_it(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A run that extends a study and is stopped leaves the cube of before."""
    wider = parse_plan(plan_text(pga="linspace = [0.05, 0.8, 16], unit = 'g'"), Path.cwd())
    monkeypatch.setattr("study.check.load_plan", lambda folder: wider)
    with pytest.raises(InputError, match=r"older than study\.toml"):
        check(folder)
