"""Kill runs with signal 9 at random moments and look for damage: ``make kill-test``.

For every model and scheduler: runs of one study are killed until the wanted number of kills hit while blocks
were being computed. After each kill every block's file must be readable and whole, no finished
block may be gone or changed; at the end the cube must equal, bit for bit, that of a run that nobody disturbed.
"""

from __future__ import annotations

import argparse
import hashlib
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from itertools import product
from pathlib import Path

from study.open import open_study
from study.store import BlockStore

SCHEDULERS = ("synchronous", "threads", "processes", "cluster")
PLAN = """
[study]
name = "killed"
model = "{model}"
[motion]
files = ["ridgecrest_2019_clc"]
[parameters]
{parameters}
[axes]
{axes}
pga = {{ linspace = [0.05, 0.77, {levels}], unit = "g" }}
[run]
block_seconds = 0.1
"""
BLOCK = 'height = "1.8 m"\nmass = "800 kg"'
WALL = """wall_height = "1.8 m"
wall_thickness = "0.138 m"
wall_density = "900 kg/m^3"
top_length = "2 m"
top_height = "0.6 m\""""
RUBBER = 'layer_thickness = "10 mm"\nlayer_modulus = "4.5 MPa"\ndamping_ratio = 0.0544'
BUILDING = """levels = 4
total_mass = "300 t"
storey_stiffness = 3e8
storey_damping = 1e6"""
WALLS = "aspect_ratio = {{ linspace = [{span}] }}\ntop_mass = {{ linspace = [500, 4000, {size}] }}"
BEARINGS = "bearing_stiffness = {{ geomspace = [{span}] }}\nbearing_damping = {{ linspace = [1e5, 9e5, {size}] }}"
MODELS = {
    "housner": (BLOCK, WALLS, "0.1, 0.4, 30", 37),
    "stacked": (WALL, WALLS, "0.2, 0.6, 10", 75),
    "interface": (f"{WALL}\n{RUBBER}", WALLS, "0.4, 1.2, 5", 25),
    "interface_linear": (f"{WALL}\n{RUBBER}", WALLS, "0.4, 1.2, 2", 4),
    "isolated": (BUILDING, BEARINGS, "1e6, 9e6, 6", 75),
}
"""Parameters, two axes, the span of the first, number of PGA: cells of like cost in all, a second or two."""
CLUSTER = """
import sys
from distributed import LocalCluster
if __name__ == "__main__":
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None, silence_logs=50) as cluster:
        print(cluster.scheduler_address, flush=True)
        sys.stdin.read()
"""


def plan_text(model: str, size: int) -> str:
    """A study of one model, the longer the more points ``size`` of its second axis."""
    parameters, axes, span, levels = MODELS[model]
    return PLAN.format(model=model, parameters=parameters, axes=axes.format(span=span, size=size), levels=levels)


@dataclass
class Finding:
    """What happened on one scheduler; ``damage`` is empty when nothing was lost."""

    scheduler: str
    kills: int = 0
    studies: int = 0
    blocks_seen: int = 0
    damage: list[str] = field(default_factory=list)


@contextmanager
def local_cluster() -> Iterator[str]:
    """Address of a dask cluster of two processes, in a process of its own."""
    with tempfile.TemporaryDirectory() as folder:
        script = Path(folder) / "cluster.py"
        script.write_text(CLUSTER)
        pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.DEVNULL}
        with subprocess.Popen([sys.executable, str(script)], text=True, env=_environment(), **pipes) as process:
            try:
                yield process.stdout.readline().strip()
            finally:
                process.stdin.close()
                process.wait(30)


def _environment() -> dict[str, str]:
    home = str(Path(__file__).resolve().parent.parent)
    path = os.pathsep.join(filter(None, [home, os.environ.get("PYTHONPATH", "")]))
    return {**os.environ, "PYTHONPATH": path}


def start_run(plan: Path, results: Path, scheduler: str) -> subprocess.Popen[bytes]:
    """``rocking run`` in a process group of its own; it hears Ctrl-C even if this program does not."""
    command = [sys.executable, "-m", "rocking", "run", str(plan), "--results", str(results)]
    command += ["--scheduler", scheduler, *(["--workers", "2"] if "://" not in scheduler else [])]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE}
    return subprocess.Popen(
        command,
        start_new_session=True,
        env=_environment(),
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
        **quiet,
    )


def finish(plan: Path, results: Path, scheduler: str) -> None:
    """Let a run come to its end; RuntimeError when it fails."""
    with start_run(plan, results, scheduler) as process:
        _, complaint = process.communicate(timeout=600)
        if process.returncode:
            raise RuntimeError(f"run on {scheduler} ended with {process.returncode}: {complaint.decode()}")


def kill_study(plan: Path, results: Path, scheduler: str, kills: int, draw: random.Random, finding: Finding) -> None:
    """Start and kill runs of one study until it is finished or ``kills`` is reached, then finish it."""
    folder = results / "killed"
    shutil.rmtree(folder, ignore_errors=True)
    finding.studies += 1
    known: dict[str, str] = {}
    while finding.kills < kills:
        with start_run(plan, results, scheduler) as process:
            before = _count(folder)
            # imports and the timed sample take a while: wait for some new blocks, then strike
            wanted = before + draw.randint(0, 3)
            while process.poll() is None and _count(folder) < wanted:
                time.sleep(0.002)
            time.sleep(draw.uniform(0.0, 0.2))
            ended = process.poll() is not None
            if not ended:
                _kill(process, draw)
        if ended:
            break
        finding.kills += 1
        known = _inspect(folder, known, finding)
    finish(plan, results, scheduler)
    _inspect(folder, known, finding)


def _count(folder: Path) -> int:
    return len(BlockStore(folder).finished())


def _kill(process: subprocess.Popen[bytes], draw: random.Random) -> None:
    """Kill the run alone, or with all its worker processes."""
    try:
        if draw.random() < 0.5:
            os.killpg(process.pid, signal.SIGKILL)
        else:
            process.kill()
    except ProcessLookupError:
        pass
    process.wait(30)


def _inspect(folder: Path, known: dict[str, str], finding: Finding) -> dict[str, str]:
    """Digest of every finished block's contents; damage is noted."""
    store = BlockStore(folder)
    digests = dict(known)
    for key in store.finished():
        try:
            _, outputs = store.read(key)
        except Exception as error:
            finding.damage.append(f"block {key}: {error}")
            continue
        parts = b"".join(name.encode() + values.tobytes() for name, values in sorted(outputs.items()))
        digest = hashlib.sha256(parts).hexdigest()
        if known.get(key, digest) != digest:
            finding.damage.append(f"block {key} changed")
        digests[key] = digest
    finding.damage += [f"block {key} is gone" for key in known.keys() - store.finished()]
    finding.blocks_seen = max(finding.blocks_seen, len(digests))
    return digests


def same_cube(one: Path, two: Path) -> list[str]:
    """Variables of two studies' cubes that differ in any bit."""
    first, second = open_study(one), open_study(two)
    differing = [str(name) for name in first.variables.keys() ^ second.variables.keys()]
    for name in first.variables.keys() & second.variables.keys():
        a, b = first[name].values, second[name].values
        same = a.tolist() == b.tolist() if a.dtype.kind in "OU" else a.tobytes() == b.tobytes()
        if not (same and a.shape == b.shape):
            differing.append(str(name))
    return differing


def kill_scheduler(scheduler: str, model: str, kills: int, work: Path, size: int = 20, seed: int = 0) -> Finding:
    """Kill runs of one model on one scheduler ``kills`` times; compare the cube with an undisturbed one."""
    finding, draw = Finding(scheduler), random.Random(seed)
    work = work / model
    work.mkdir(exist_ok=True)
    plan = work / "killed.toml"
    plan.write_text(plan_text(model, size))
    if not (work / "undisturbed" / "killed" / "cube.nc").exists():
        finish(plan, work / "undisturbed", "threads")
    while finding.kills < kills:
        if scheduler == "cluster":
            with local_cluster() as address:
                kill_study(plan, work / scheduler, address, kills, draw, finding)
        else:
            kill_study(plan, work / scheduler, scheduler, kills, draw, finding)
        differing = same_cube(work / "undisturbed" / "killed", work / scheduler / "killed")
        finding.damage += [f"{name} differs from the undisturbed cube" for name in differing]
    return finding


def main() -> int:
    """Print a table; exit code 1 when anything was damaged."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--kills", type=int, default=20)
    parser.add_argument("--scheduler", choices=SCHEDULERS, action="append")
    parser.add_argument("--model", choices=tuple(MODELS), action="append")
    parser.add_argument("--seed", type=int, default=int(time.time()))
    chosen = parser.parse_args()
    print(f"seed {chosen.seed}\n{'model':<16} {'scheduler':<12} {'kills':>5} {'studies':>7} {'blocks':>6}  damage")
    bad = 0
    with tempfile.TemporaryDirectory() as work:
        for model, scheduler in product(chosen.model or MODELS, chosen.scheduler or SCHEDULERS):
            found = kill_scheduler(scheduler, model, chosen.kills, Path(work), seed=chosen.seed)
            bad += len(found.damage)
            row = f"{model:<16} {scheduler:<12} {found.kills:>5} {found.studies:>7} {found.blocks_seen:>6}"
            print(f"{row}  {'; '.join(found.damage) or 'none'}", flush=True)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
