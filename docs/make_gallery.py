"""The gallery of reports: four cases with known truth, diagnosed, one page each in ``docs/gallery/``.

    python docs/make_gallery.py [NAME ...]

The recordings are simulated with fixed seeds: by the model's plain reference where the effect is in
the library, by a small program of this file where it is not. Noise is 1 % of the peak of a response
and 0.3 % of that of the base.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

import rocking
from diagnosis.report.page import report_page
from diagnosis.report.pictures import pictures
from grids.motions import Motion
from grids.recordings import Recording
from grids.specimen import Specimen

GALLERY = Path(__file__).parent / "gallery"
STEP, BEFORE, LENGTH = 0.005, 4.0, 12.0
"""s: sampling, start before the largest acceleration, length of a recording."""
RISE = 0.5
"""s over which the table starts to move."""
FRICTION = 0.05
"""Of the couple m g b: what a guide takes on one side."""
FloatArray = NDArray[np.float64]
Couple = Callable[[float, float], float]


@dataclass(frozen=True)
class Case:
    """One page: what hides in the recordings and, for a law outside the library, its couple over M g b."""

    title: str
    mechanisms: dict[str, dict[str, float]] = field(default_factory=dict)
    couple: Couple | None = None
    seed: int = 1


def rubs_on_the_left(rotation: float, rate: float) -> float:
    """Dry friction, while the block leans to the left only."""
    return -FRICTION * np.tanh(rate / 0.01) if rotation < 0.0 else 0.0


CASES = {
    "one_effect": Case("Block in a loose frame", {"viscous_damping": {"rate": 0.25}}, seed=11),
    "two_effects": Case(
        "Block on a table out of level", {"tilt": {"tilt": 0.008}, "restitution": {"factor_on_housner": 0.93}}, seed=12
    ),
    "nothing_missing": Case("Block as built", seed=13),
    "outside_the_library": Case("Block that rubs on one side", couple=rubs_on_the_left, seed=14),
}
RECORDINGS = (("train_1", "ridgecrest_2019_ccc", 4.2), ("train_2", "ridgecrest_2019_clc", 3.4),
              ("test_1", "ridgecrest_2019_clc", 4.4))  # fmt: skip
"""Name, motion, largest acceleration (m s-2)."""


def specimen(case: Case) -> Specimen:
    """What the laboratory knows: nothing of what hides."""
    return Specimen(
        title=case.title,
        model="housner",
        parameters={"width": 0.25, "height": 1.1, "mass": 165.0},
        tolerance={"width": 0.005, "height": 0.005},
    )


def table_motion(source: str, pga: float) -> Motion:
    """A stretch of a shipped motion about its peak, starting gently."""
    motion = rocking.read_motion(source, vertical=False).resampled(STEP).scaled_to_pga(pga)
    start = float(np.argmax(np.abs(motion.horizontal))) * STEP - BEFORE
    cut = motion.cut(start, start + LENGTH)
    rise = np.minimum(np.arange(cut.horizontal.size) * STEP / RISE, 1.0)
    return replace(cut, horizontal=cut.horizontal * rise)


def recording(case: Case, k: int) -> Recording:
    """One recording with noise; where nothing of the library hides, the law's own program makes it."""
    name, source, pga = RECORDINGS[k]
    motion = table_motion(source, pga)
    if case.couple is None:
        truth = replace(specimen(case), mechanisms=case.mechanisms)
        history = rocking.simulate(truth, motion, duration=LENGTH, integrator="reference")
        time, rotation = history["time"].values, history["rotation_1"].values
    else:
        time = np.arange(motion.horizontal.size) * STEP
        rotation = rocked(case.couple, time, motion.horizontal)
    rng = np.random.default_rng([case.seed, k])
    base = motion.horizontal[: time.size]
    channels = {
        "base_acceleration_x": base + rng.normal(0.0, 0.003 * np.max(np.abs(base)), base.size),
        "rotation_1": rotation + rng.normal(0.0, 0.01 * np.max(np.abs(rotation)), rotation.size),
    }
    return Recording(name, STEP, time, channels, source={"file": f"{name}.nc"})


def rocked(couple: Couple, time: FloatArray, base: FloatArray) -> FloatArray:
    """Rotation of the block with an extra couple, from rest: Housner's equation by DOP853, impact by impact."""
    width, height, gravity = 0.25, 1.1, 9.80665
    alpha, radius = np.arctan2(width, height), np.hypot(width, height) / 2.0
    p2, kept = 0.75 * gravity / radius, 1.0 - 1.5 * np.sin(alpha) ** 2
    rotation = np.zeros(time.size)
    fine = np.arange(0.0, time[-1], STEP / 1000)
    lifts = np.abs(np.interp(fine, time, base)) > gravity * np.tan(alpha)
    start, rate = 0.0, 0.0
    while True:
        if abs(rate) < 2e-3 * np.sqrt(p2) * alpha:
            ahead = np.flatnonzero(lifts & (fine >= start))
            if not ahead.size:
                return rotation
            start, rate = float(fine[ahead[0]]), 0.0
        side = np.sign(rate) if rate else -np.sign(np.interp(start, time, base))

        def motion(t: float, y: FloatArray, side: float = side) -> list[float]:
            lean = alpha * side - y[0]
            push = np.interp(t, time, base) / gravity
            extra = np.sin(alpha) * couple(y[0], y[1])
            return [y[1], -p2 * (np.sin(lean) + push * np.cos(lean) - extra)]

        def down(t: float, y: FloatArray, side: float = side) -> float:
            return float(side * y[0])

        down.terminal, down.direction = True, -1.0  # type: ignore[attr-defined]
        ran = solve_ivp(
            motion, (start, time[-1]), [side * 1e-9, rate], "DOP853", events=down, dense_output=True,
            rtol=1e-8, atol=1e-10, max_step=STEP,
        )  # fmt: skip
        inside = (time >= start) & (time <= ran.t[-1])
        if inside.any():
            rotation[inside] = ran.sol(time[inside])[0]
        if ran.status != 1:
            return rotation
        start, rate = float(ran.t[-1]), kept * float(ran.y[1, -1])


def make(name: str) -> Path:
    """Diagnose a case and write its page."""
    case = CASES[name]
    *train, test = [recording(case, k) for k in range(len(RECORDINGS))]
    found = rocking.diagnose(specimen(case), train, [test])
    drawn = pictures(found, specimen(case), (*train, test))
    GALLERY.mkdir(exist_ok=True)
    path = GALLERY / f"{name}.html"
    path.write_text(report_page(found, specimen(case), train, [test], drawn), encoding="utf-8")
    print(f"{path.name}: {found.statement}")
    return path


if __name__ == "__main__":
    for chosen in sys.argv[1:] or CASES:
        make(chosen)
