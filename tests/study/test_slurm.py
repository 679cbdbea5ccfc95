"""The SLURM example, run against a stand-in: sbatch starts the job script here, scancel ends it, squeue lists it."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from benchmarks.faults.commands import ROOT, environment
from study.open import open_study
from study.run import run
from tests.study.cubes import assert_identical
from tests.study.plans import plan_text, small_plan

COMMANDS = {
    "sbatch": """#!/bin/sh
cp "$1" "$STAND_IN/$$.sh"
setsid sh "$STAND_IN/$$.sh" > "$STAND_IN/job.log" 2>&1 &
echo $! >> "$STAND_IN/jobs"
echo "Submitted batch job $!"
""",
    "scancel": """#!/bin/sh
for job in "$@"; do kill -TERM -- "-$job"; done
echo "$@" >> "$STAND_IN/cancelled"
""",
    "squeue": """#!/bin/sh
cat "$STAND_IN/jobs"
""",
}


@pytest.fixture
def slurm(tmp_path: Path) -> dict[str, str]:
    """An environment whose PATH begins with the stand-in for SLURM."""
    home = tmp_path / "slurm"
    home.mkdir()
    for name, script in COMMANDS.items():
        (home / name).write_text(script)
        (home / name).chmod(0o755)
    path = os.pathsep.join([str(home), os.environ["PATH"]])
    return {**environment(), "PATH": path, "STAND_IN": str(home), "JOBS": "2", "CORES": "1"}


@pytest.mark.slow
def test_the_example_runs_a_study_in_jobs(slurm: dict[str, str], tmp_path: Path) -> None:
    pytest.importorskip("dask_jobqueue", reason="dask-jobqueue is not installed (pip install rocking-study[cluster])")
    (tmp_path / "plan.toml").write_text(plan_text(block_seconds=0.01))
    command = [sys.executable, str(ROOT / "examples/cluster/slurm.py"), "plan.toml", "there"]
    done = subprocess.run(command, cwd=tmp_path, env=slurm, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr[-2000:] + (Path(slurm["STAND_IN"]) / "job.log").read_text()[-2000:]
    assert "168 cells in" in done.stdout
    home = Path(slurm["STAND_IN"])
    assert len((home / "jobs").read_text().split()) == 2
    assert set((home / "cancelled").read_text().split()) == set((home / "jobs").read_text().split())
    here = open_study(run(small_plan(), results=tmp_path / "here").folder)
    assert_identical(open_study(tmp_path / "there" / "small"), here)
