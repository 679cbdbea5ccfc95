"""Processes and a dask cluster, and kills: the runs are processes of their own, as a user starts them."""

from __future__ import annotations

import json
import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
import xarray as xr

import models
from benchmarks.kill_test import MODELS, Finding, finish, kill_study, local_cluster, plan_text, same_cube, start_run
from models.errors import InputError
from study.open import open_study
from study.run import run
from tests.study.cubes import assert_identical
from tests.study.plans import small_plan


@pytest.fixture(scope="module")
def cluster() -> Iterator[str]:
    """Address of a cluster of two processes."""
    with local_cluster() as address:
        yield address


@pytest.fixture(scope="module")
def plan(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A study of one or two seconds in blocks of a tenth."""
    path = tmp_path_factory.mktemp("plan") / "killed.toml"
    path.write_text(plan_text("housner", 10))
    return path


@pytest.fixture(scope="module")
def undisturbed(plan: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    results = tmp_path_factory.mktemp("undisturbed")
    run(plan, results=results, scheduler="synchronous")
    return results / "killed"


def test_a_cluster_leaves_no_trace(cluster: str, tmp_path: Path) -> None:
    """A client in this process: no warning about anything left open."""
    here = open_study(run(small_plan(), results=tmp_path / "here").folder)
    there = run(small_plan(block_seconds=0.005), results=tmp_path / "there", scheduler=cluster)
    assert there.computed == there.blocks > 1
    assert_identical(open_study(there.folder), here)


def test_every_model_is_killed() -> None:
    assert set(MODELS) == set(models.MODELS)


@pytest.mark.parametrize("scheduler", ["threads", "processes", "cluster"])
def test_killed_runs_lose_no_finished_block(
    scheduler: str, plan: Path, undisturbed: Path, tmp_path: Path, request: pytest.FixtureRequest
) -> None:
    """One kill a scheduler here; twenty each with ``make kill-test``."""
    address = request.getfixturevalue("cluster") if scheduler == "cluster" else scheduler
    finding = Finding(scheduler)
    kill_study(plan, tmp_path, address, 1, random.Random(scheduler), finding)
    assert not finding.damage
    assert not same_cube(undisturbed, tmp_path / "killed")


@pytest.mark.parametrize("model", [name for name in MODELS if name != "housner"])
def test_the_other_models_lose_nothing_either(model: str, tmp_path: Path) -> None:
    """Killed once on threads and finished: the bits of blocks of another size, one after the other."""
    plan, finding = tmp_path / "killed.toml", Finding("threads")
    plan.write_text(plan_text(model, 6))
    kill_study(plan, tmp_path / "threads", "threads", 1, random.Random(model), finding)
    assert finding.kills == 1 and not finding.damage
    plan.write_text(plan_text(model, 6).replace("block_seconds = 0.1", "block_seconds = 30"))
    whole = run(plan, results=tmp_path / "whole", scheduler="synchronous")
    assert whole.blocks < finding.blocks_seen
    assert not same_cube(whole.folder, tmp_path / "threads" / "killed")


def test_ctrl_c_stops_cleanly(plan: Path, undisturbed: Path, tmp_path: Path) -> None:
    """Signal 2 to the whole group, as a terminal sends it: exit code 130, then the run continues."""
    with start_run(plan, tmp_path, "processes") as process:
        while process.poll() is None and not list(tmp_path.glob("killed/blocks/*.nc")):
            time.sleep(0.01)
        os.killpg(process.pid, signal.SIGINT)
        _, complaint = process.communicate(timeout=60)
    assert process.returncode == 130, complaint.decode()
    assert "Traceback" not in complaint.decode() and "finished blocks are kept" in complaint.decode()
    assert not list((tmp_path / "killed" / "blocks").glob(".*.tmp"))
    finish(plan, tmp_path, "processes")
    assert not same_cube(undisturbed, tmp_path / "killed")


def test_a_silent_address_is_one_sentence(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("study.schedulers.CONNECT_SECONDS", 1)
    with pytest.raises(InputError, match=r"no dask cluster answers at 'tcp://127\.0\.0\.1:1'"):
        run(small_plan(), results=tmp_path, scheduler="tcp://127.0.0.1:1")


def test_plan_and_cube_are_read_without_numba_matplotlib_or_dask() -> None:
    code = "import sys, json, study.open, study.manifest, study.store; print(json.dumps(sorted(sys.modules)))"
    loaded = json.loads(subprocess.run([sys.executable, "-c", code], capture_output=True, check=True).stdout)
    assert not {"numba", "matplotlib", "distributed"} & set(loaded)


def test_identical_means_identical(undisturbed: Path) -> None:
    """The comparison that the other tests rest on sees one changed bit."""
    one = open_study(undisturbed)
    two: xr.Dataset = one.copy(deep=True)
    two["impacts"].values[0, 0, 0] += 1
    with pytest.raises(AssertionError):
        assert_identical(one, two)
