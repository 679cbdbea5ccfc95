"""What each property of a laboratory's recordings does to a calibration: tables and figure of docs/laboratory.md.

    PYTHONPATH=. python docs/make_laboratory_page.py

One block is shaken by strong parts of the shipped records, moved by a program that shares nothing with the models
(`benchmarks.diagnosis.truth`), recorded with one property changed at a time, and calibrated: how well is its
coefficient of restitution known then? Writes ``docs/_static/laboratory.png`` and ``docs/tables/laboratory.md``.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from benchmarks.diagnosis import instruments, shakings, truth
from benchmarks.diagnosis.imperfections import Imperfections
from diagnosis.errors.model import calibrated
from diagnosis.fit.intervals import estimates
from diagnosis.fit.setup import measure
from grids.motions import read_motion
from grids.motions.locate import list_shipped
from grids.recordings import Recording
from grids.specimen import parse_specimen
from models.base import FloatArray
from study.figures.style import COLOURS

HERE = Path(__file__).parent
FIGURE, TABLE = HERE / "_static" / "laboratory.png", HERE / "tables" / "laboratory.md"
WIDTH, HEIGHT, GRAVITY = 0.3, 1.4, 9.80665
RESTITUTION = 1.0 - 1.5 * math.sin(math.atan2(WIDTH, HEIGHT)) ** 2
"""Housner's: rocking of a rectangle without bouncing."""
SPECIMEN = f"""
title = "a masonry pier"
model = "housner"
[parameters]
width = {WIDTH}
height = {HEIGHT}
mass = 700.0
[tolerance]
width = 0.005
height = 0.005
[calibrate]
restitution = [0.7, 1.0]
"""
SEEDS = range(4)
STRENGTHS = (1.9, 2.3, 1.7, 2.6)
"""PGA over the onset acceleration, recording by recording."""
STRONG = (10.0, 12.0)
"""Share of the squared acceleration (%) at which a part of a record begins, and its length (s)."""
BASE_NOISE = 0.003


@dataclass(frozen=True)
class Laboratory:
    """How it records; noise and drift over the peak of the rotation, ``rest`` s of stillness before and after."""

    sampling_hz: float = 200.0
    noise: float = 0.01
    rest: float = 2.0
    recordings: int = 2
    errors: Imperfections = field(default_factory=Imperfections)


STANDARD = Laboratory()
CHANGES: dict[str, list[tuple[str, Laboratory]]] = {
    "sampling": [(f"{x:g} Hz", replace(STANDARD, sampling_hz=x)) for x in (50.0, 100.0, 200.0, 500.0)],
    "white noise of the rotation": [(f"{x:.1%}", replace(STANDARD, noise=x)) for x in (0.002, 0.005, 0.01, 0.03)],
    "colour of that noise (1 %)": [
        ("white", STANDARD),
        ("half 1/f", replace(STANDARD, errors=Imperfections(pink_share=0.5))),
        ("AR(1), .9", replace(STANDARD, errors=Imperfections(ar1_share=1.0, ar1_coefficient=0.9))),
    ],
    "scatter of impacts": [
        (f"{x:.1%}", replace(STANDARD, errors=Imperfections(scatter=x))) for x in (0.0, 0.005, 0.01, 0.02)
    ],
    "drift of the rotation": [
        (f"{x:.1%}", replace(STANDARD, errors=Imperfections(drift=x))) for x in (0.0, 0.002, 0.005, 0.02)
    ],
    "low-pass of the rotation": [
        (f"{x:g} Hz", replace(STANDARD, errors=Imperfections(sensors={"filter": {"corner_hz": x, "order": 2.0}})))
        for x in (60.0, 30.0, 15.0)
    ],
    "AC coupling of the base": [
        (f"{x:g} Hz", replace(STANDARD, errors=Imperfections(sensors={"base_filter": {"high_pass_hz": x}})))
        for x in (0.02, 0.1, 0.3)
    ],
    "rest before and after": [(f"{x:g} s", replace(STANDARD, rest=x)) for x in (0.0, 0.5, 2.0, 5.0)],
    "recordings": [(str(x), replace(STANDARD, recordings=x)) for x in (1, 2, 4)],
}  # fmt: skip


@dataclass(frozen=True)
class Known:
    """Of the coefficient of restitution: half the 95 % interval, and the error of the estimate over it."""

    half: float
    error: float


def main() -> None:
    found = {
        (what, value): [known(laboratory, seed) for seed in SEEDS]
        for what, values in CHANGES.items()
        for value, laboratory in values
    }
    TABLE.write_text(table(found), encoding="utf-8")
    figure(found)
    print(TABLE.read_text(encoding="utf-8"))


def known(laboratory: Laboratory, seed: int) -> Known:
    """What a calibration knows of the restitution from one draw of the laboratory's errors."""
    rng = np.random.default_rng(seed)
    recordings = [recorded(laboratory, k, rng) for k in range(laboratory.recordings)]
    specimen = parse_specimen(SPECIMEN)
    fitted = estimates(calibrated(specimen, measure(specimen, recordings))[0])["restitution"]
    half = 0.5 * (fitted.high95 - fitted.low95)
    return Known(half, (fitted.estimate - RESTITUTION) / half)


def recorded(laboratory: Laboratory, k: int, rng: np.random.Generator) -> Recording:
    """Recording ``k``: the block under one of the shipped records, as the laboratory sees it."""
    base = shaken(k, laboratory.rest)
    step = shakings.STEP / shakings.FINE
    kicks = laboratory.errors.kicks(truth.MOST_IMPACTS, rng)
    rotation = truth.run(WIDTH, HEIGHT, GRAVITY, base, step, kicks=kicks).rotation
    peak, sensors = float(np.max(np.abs(rotation))), laboratory.errors.sensors
    duration = step * (base.size - 1)
    seen = {
        "base_acceleration_x": instruments.base(base, step, sensors),
        "rotation_1": instruments.response(rotation, base, step, sensors, peak),
    }
    sampled = {n: instruments.logged(x, step, laboratory.sampling_hz, duration) for n, x in seen.items()}
    sampling = 1.0 / laboratory.sampling_hz
    noisy = sampled["rotation_1"]
    noisy = noisy + laboratory.errors.noise(noisy, sampling, laboratory.noise, peak, rng)
    measured = sampled["base_acceleration_x"]
    measured = measured + BASE_NOISE * float(np.max(np.abs(measured))) * rng.normal(size=measured.size)
    channels = {"base_acceleration_x": measured, "rotation_1": noisy}
    return Recording(f"run_{k + 1}", sampling, sampling * np.arange(noisy.size), channels)


def shaken(k: int, rest: float) -> FloatArray:
    """Base acceleration (m s-2) on the fine grid: the strong part of a shipped record between two rests."""
    names = list_shipped()
    motion = read_motion(names[k % len(names)])
    begins, length = STRONG
    energy = np.cumsum(motion.horizontal**2)
    begin = motion.time_step * float(np.searchsorted(energy, begins / 100.0 * energy[-1]))
    motion = motion.cut(max(0.0, begin - 1.0), begin + length).resampled(shakings.STEP)
    horizontal = motion.horizontal * np.hanning(motion.horizontal.size) ** 0.25
    scale = STRENGTHS[k] * GRAVITY * WIDTH / HEIGHT / float(np.max(np.abs(horizontal)))
    return shakings.fine(np.pad(scale * horizontal, round(rest / shakings.STEP) + 1))


def table(found: dict[tuple[str, str], list[Known]]) -> str:
    lines = ["| property | value | half of the 95 % interval | inside it |", "| --- | --- | --- | --- |"]
    for (what, value), draws in found.items():
        inside = sum(abs(one.error) <= 1.0 for one in draws)
        lines.append(f"| {what} | {value} | {np.median([d.half for d in draws]):.2%} | {inside} of {len(draws)} |")
    return "\n".join(lines) + "\n"


def figure(found: dict[tuple[str, str], list[Known]]) -> None:
    """Half widths by property and value, in one row of panels on one axis."""
    fig, axes = plt.subplots(3, 3, figsize=(8.4, 6.8), sharey=True)
    for axis, what in zip(axes.flat, CHANGES, strict=True):
        values = [value for name, value in found if name == what]
        for at, value in enumerate(values):
            draws = found[what, value]
            axis.plot([at] * len(draws), [100.0 * d.half for d in draws], "o", color=COLOURS[0], alpha=0.6, ms=4)
            outside: Iterable[Known] = (d for d in draws if abs(d.error) > 1.0)
            for d in outside:
                axis.plot(at, 100.0 * d.half, "x", color=COLOURS[1], ms=9)
        axis.set_title(what, fontsize=9)
        axis.set_xticks(range(len(values)), values, fontsize=8)
        axis.set_xlim(-0.5, len(values) - 0.5)
        axis.grid(axis="y", alpha=0.3)
    axes[1, 0].set_ylabel("half of the 95 % interval of the restitution [%]")
    fig.tight_layout()
    fig.savefig(FIGURE, dpi=150)


if __name__ == "__main__":
    main()
