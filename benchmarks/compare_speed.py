"""Lane-steps a second of every model and law in two trees of the code, in turn in one run.

    python -m benchmarks.compare_speed OLD NEW [--only interface] [--pairs 15] [--seconds 0.4]

OLD and NEW are folders that hold `models/`. The cells are those of `benchmarks.fingerprint`, repeated until one
evaluation takes about ``--seconds`` of processor time; a pair of evaluations is one in each tree, whose order
alternates. Printed: the rate of both, the median of new over old, and the interval that holds the median of such
ratios with 95 % (order statistics of the pairs), so that other programs on the machine hardly count.
"""

from __future__ import annotations

import argparse
import os
import pickle
import subprocess
import sys
import zlib
from pathlib import Path
from typing import Any

import numpy as np
from scipy.stats import binom

from benchmarks.fingerprint import DURATION, STEP, TAIL, chosen, drawn, random_motion
from models.model import Model

WORKER = Path(__file__).parent / "speed_worker.py"


class Tree:
    """A process that evaluates cells with the models of one folder."""

    def __init__(self, folder: Path) -> None:
        environment = {**os.environ, "PYTHONPATH": str(folder.resolve()), "OMP_NUM_THREADS": "1"}
        self.process = subprocess.Popen(
            [sys.executable, "-P", str(WORKER)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=environment
        )

    def evaluate(self, work: Any) -> tuple[float, int]:
        """Processor time in s, and lane-steps."""
        assert self.process.stdin is not None and self.process.stdout is not None
        pickle.dump(work, self.process.stdin)
        self.process.stdin.flush()
        seconds, steps = pickle.load(self.process.stdout)
        return seconds, steps


def cells(model: Model, variant: str, times: int) -> Any:
    """The cells of a fingerprint, each ``times`` times, as a worker takes them."""
    values, options = drawn(model, variant)
    tiled = {name: np.tile(value, times) for name, value in values.items()}
    motion = random_motion(np.random.default_rng(zlib.crc32(model.name.encode())))
    vertical = motion.vertical if variant.startswith("vertical") else None
    shaking = (STEP, motion.horizontal, vertical, variant == "vertical")
    return model.name, tiled, options, shaking, tiled.pop("scale"), TAIL


def interval(ratios: np.ndarray) -> tuple[float, float]:
    """Two of the ratios between which their median lies with at least 95 %."""
    ordered = np.sort(ratios)
    outside = max(0, int(binom.ppf(0.025, ratios.size, 0.5)) - 1)
    return float(ordered[outside]), float(ordered[-1 - outside])


def compare(old: Tree, new: Tree, model: Model, variant: str, pairs: int, seconds: float) -> str:
    """One line: both rates, and their ratio with its interval."""
    for tree in (old, new):
        tree.evaluate(cells(model, variant, 1))
    times = max(1, round(seconds / max(old.evaluate(cells(model, variant, 4))[0] / 4, 1e-4)))
    work = cells(model, variant, times)
    rates = np.zeros((pairs, 2))
    for k in range(pairs):
        for which in (0, 1) if k % 2 else (1, 0):
            took, steps = (old, new)[which].evaluate(work)
            rates[k, which] = steps / took
    before, after = np.median(rates, axis=0) / 1e6
    low, high = interval(rates[:, 1] / rates[:, 0])
    ratio = float(np.median(rates[:, 1] / rates[:, 0]))
    return f"{before:8.2f} {after:8.2f} M/s   ratio {ratio:.3f} [{low:.3f}, {high:.3f}]{' SLOWER' * (high < 0.98)}"


def main() -> None:
    """A line for every model and variant."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old", type=Path)
    parser.add_argument("new", type=Path)
    parser.add_argument("--only", help="a part of MODEL.VARIANT")
    parser.add_argument("--pairs", type=int, default=15)
    parser.add_argument("--seconds", type=float, default=0.4)
    given = parser.parse_args()
    print(f"{DURATION:g} s of motion and {TAIL:g} s of quiet; old, new, lane-steps a second of processor time")
    old, new = Tree(given.old), Tree(given.new)
    for model, variant in chosen(given.only):
        said = compare(old, new, model, variant, given.pairs, given.seconds)
        print(f"{model.name + '.' + variant:45} {said}", flush=True)


if __name__ == "__main__":
    main()
