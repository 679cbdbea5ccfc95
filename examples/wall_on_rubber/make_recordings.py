"""Make the recordings of this example: a simulated wall between two rubber layers, and what hides in its rubber.

    PYTHONPATH=. python examples/wall_on_rubber/make_recordings.py       # from the root of the project

The wall is moved by `benchmarks.diagnosis.fibre_wall`, a program that shares nothing with the models: fibres in other
coordinates, another rule of integration. It is that of ``wall.toml`` within its tolerances, but its rubber relaxes: a
spring and a dashpot in series (a Maxwell arm) stand beside spring and dashpot of each layer. Noise is 1 % of the peak
of each rotation and .3 % of that of the table. Nothing else differs from the model.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

import rocking
from benchmarks.diagnosis import fibre_wall

HERE = Path(__file__).parent
WALL = {
    "wall_length": 1.003, "wall_height": 1.794, "wall_mass": 225.5, "top_length": 1.0, "top_height": 0.5,
    "top_mass": 3990.0, "layer_thickness": 0.01,
    "base_stiffness": 5.2e7, "top_stiffness": 4.3e7, "base_damping": 3.2e5, "top_damping": 2.4e5,
}  # fmt: skip
"""The true wall: m, kg, stiffness (N m-2) and dashpot (N s m-2) of each layer per metre of length."""
RUBBER = {"maxwell.arm_stiffness_ratio": 0.5, "maxwell.relaxation_time": 0.08}
"""What the diagnosis has to find: stiffness of the arm over that of the layer, relaxation time (s)."""
STEP, STILL, LENGTH, BEFORE, RISE = 0.005, 1.5, 8.0, 2.5, 0.5
"""s: of the logger; rest before the table moves, which tells what the sensors do by themselves; how long it moves; its
start before the largest acceleration of the record; while it starts and stops."""
RUNS = (("shake_1", "ridgecrest_2019_ccc", 2.2, 1), ("shake_2", "ridgecrest_2019_clc", 2.6, 2),
        ("shake_3", "ridgecrest_2019_clc", 3.6, 3))  # fmt: skip
"""File, motion, largest acceleration (m s-2), seed of the noise."""
COLUMNS = """between_samples = "linear"
time = { column = "time", unit = "s" }

[columns]
base_acceleration_x = { column = "base_acceleration_x", unit = "m s-2" }
rotation_1 = { column = "rotation_1", unit = "rad" }
rotation_2 = { column = "rotation_2", unit = "rad" }
"""


def main() -> None:
    for name, source, pga, seed in RUNS:
        table = on_the_table(source, pga)
        rotations = fibre_wall.run(WALL, table, STEP, RUBBER)
        print(f"{name}: the wall turns by up to {1e3 * np.max(np.abs(rotations[0])):.1f} mrad")
        write(HERE / f"{name}.csv", table, rotations, np.random.default_rng(seed))


def on_the_table(source: str, pga: float) -> np.ndarray:
    """Acceleration (m s-2) of the table: the strong part of a motion scaled to ``pga``, after a rest."""
    motion = rocking.read_motion(source, vertical=False).resampled(STEP).scaled_to_pga(pga)
    start = float(np.argmax(np.abs(motion.horizontal))) * STEP - BEFORE
    motion = motion.cut(start, start + LENGTH)
    rise = np.minimum(np.arange(motion.horizontal.size) * STEP / RISE, 1.0)
    return np.concatenate([np.zeros(round(STILL / STEP)), motion.horizontal * np.minimum(rise, rise[::-1])])


def write(path: Path, table: np.ndarray, rotations: np.ndarray, rng: np.random.Generator) -> None:
    """A CSV of what the instruments read, beside it which column is what."""
    channels = [noisy(table, 0.003, rng), *(noisy(rotation, 0.01, rng) for rotation in rotations)]
    rows = [
        f"{k * STEP:.3f},{a:.6f},{one:.4e},{two:.4e}" for k, (a, one, two) in enumerate(zip(*channels, strict=True))
    ]
    path.write_text("\n".join(["time,base_acceleration_x,rotation_1,rotation_2", *rows]) + "\n", encoding="utf-8")
    path.with_suffix(".toml").write_text(COLUMNS, encoding="utf-8")


def noisy(values: np.ndarray, share: float, rng: np.random.Generator) -> np.ndarray:
    return values + share * np.max(np.abs(values)) * rng.normal(size=values.size)


if __name__ == "__main__":
    main()
