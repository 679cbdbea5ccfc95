"""Make the recordings of this example: a wall between two rubber layers that soften as they are strained.

    python make_recordings.py

Within a test each layer is linear; from test to test its stiffness is what the largest strain so far, this test
included, has left of it (as in the Mullins effect):

    k = k0 [1 - SOFTENING (1 - exp(-largest strain/STRAIN))]

The damping ratio stays. Noise is 1 % of the peak of each rotation.
"""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import xarray as xr

import rocking
from grids.specimen import Specimen

HERE = Path(__file__).parent
STIFFNESS, DAMPING = 8e7, 0.05
"""Of both layers when new, N m-2, and 1."""
SOFTENING, STRAIN = 0.5, 0.3
STEP, LENGTH = 0.005, 6.0
TESTS = (0.3, 0.8, 0.8, 2.2, 0.8)
"""Largest acceleration of the table by test, m s-2: a level that lifts the wall is repeated after each stronger one."""
COLUMNS = """between_samples = "linear"
time = { column = "time", unit = "s" }

[columns]
base_acceleration_x = { column = "base_acceleration_x", unit = "m s-2" }
rotation_1 = { column = "rotation_1", unit = "rad" }
rotation_2 = { column = "rotation_2", unit = "rad" }
"""
ROUNDS = 6
"""Until stiffness and strain of a test belong together."""


def main() -> None:
    wall = rocking.read_specimen(HERE / "wall.toml")
    largest = dict.fromkeys(("base", "top"), 0.0)
    for number, pga in enumerate(TESTS, start=1):
        motion = rocking.read_motion("ridgecrest_2019_ccc", vertical=False).resampled(STEP).scaled_to_pga(pga)
        start = float(np.argmax(np.abs(motion.horizontal))) * STEP - 2.0
        motion = motion.cut(start, start + LENGTH)
        rise = np.minimum(np.arange(motion.horizontal.size) * STEP / 0.5, 1.0)
        motion = replace(motion, horizontal=motion.horizontal * rise)
        strained = dict(largest)
        for _ in range(ROUNDS):
            history = rocking.simulate(as_left(wall, strained), motion, duration=LENGTH)
            outputs = json.loads(history.attrs["outputs"])
            strained = {joint: max(before, outputs[f"peak_strain_{joint}"]) for joint, before in largest.items()}
        largest = strained
        print(f"test {number}: largest strains {largest}")
        write(HERE / f"test_{number}.csv", history, np.random.default_rng(number))


def as_left(wall: Specimen, strained: dict[str, float]) -> Specimen:
    """The wall with the stiffness that the largest strains have left its layers."""
    layers = {f"{j}_damping_ratio": DAMPING for j in strained}
    for joint, strain in strained.items():
        layers[f"{joint}_stiffness"] = STIFFNESS * (1.0 - SOFTENING * -np.expm1(-strain / STRAIN))
    return replace(wall, parameters={**wall.parameters, **layers}, calibrate={})


def write(path: Path, history: xr.Dataset, rng: np.random.Generator) -> None:
    columns = [history["time"].values, history["base_acceleration_x"].values]
    for name in ("rotation_1", "rotation_2"):
        true = history[name].values
        columns.append(true + 0.01 * np.max(np.abs(true)) * rng.normal(size=true.size))
    rows = [f"{t:.3f},{a:.6f},{one:.4e},{two:.4e}" for t, a, one, two in zip(*columns, strict=True)]
    head = "time,base_acceleration_x,rotation_1,rotation_2"
    path.write_text("\n".join([head, *rows]) + "\n", encoding="utf-8")
    path.with_suffix(".toml").write_text(COLUMNS, encoding="utf-8")


if __name__ == "__main__":
    main()
