"""Make the three CSV files of this example: a simulated block on a shake table, and what hides in it.

    python make_recordings.py

The block is that of ``block.toml``, but its lower edges have crumbled: it rocks on points inside its
corners. A logger writes time in ms, the table in g, and an inclinometer that was mounted back to
front in degrees. Noise is 0.3 % of the peak of each channel. Nothing else differs from the model.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

import rocking

HERE = Path(__file__).parent
INSET = 0.05
"""Of the half width: what the diagnosis has to find."""
STEP = 0.005
GRAVITY = 9.80665
RUNS = (("shake_1", "ridgecrest_2019_ccc", 4.2, 1), ("shake_2", "ridgecrest_2019_clc", 3.4, 2),
        ("shake_3", "ridgecrest_2019_clc", 4.4, 3))  # fmt: skip
"""File, motion, largest acceleration (m s-2), seed of the noise."""
BEFORE, LENGTH = 2.5, 8.0
"""s: start before the largest acceleration, and length."""
RISE = 0.5
"""s over which the table starts to move."""


def main() -> None:
    nominal = rocking.read_specimen(HERE / "block.toml")
    worn = replace(nominal, mechanisms={"pivot_inset": {"inset_over_half_width": INSET}})
    for name, source, pga, seed in RUNS:
        motion = rocking.read_motion(source, vertical=False).resampled(STEP).scaled_to_pga(pga)
        start = float(np.argmax(np.abs(motion.horizontal))) * STEP - BEFORE
        motion = motion.cut(start, start + LENGTH)
        rise = np.minimum(np.arange(motion.horizontal.size) * STEP / RISE, 1.0)
        motion = replace(motion, horizontal=motion.horizontal * rise)
        history = rocking.simulate(worn, motion, duration=LENGTH, integrator="reference")
        rng = np.random.default_rng(seed)
        channels = [noisy(history[c].values, rng) for c in ("base_acceleration_x", "rotation_1")]
        columns = [1e3 * history["time"].values, channels[0] / GRAVITY, -np.degrees(channels[1])]
        write(HERE / f"{name}.csv", columns)


def noisy(values: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    return values + rng.normal(0.0, 0.003 * np.max(np.abs(values)), values.size)


def write(path: Path, columns: list[np.ndarray]) -> None:
    head = ["Logger DL-8, 200 Hz", f"Run {path.stem}", "t [ms];table X [g];tilt S1 [deg]"]
    rows = [f"{t:.0f};{table:.5f};{tilt:.4f}" for t, table, tilt in zip(*columns, strict=True)]
    path.write_text("\n".join([*head, *rows]) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
