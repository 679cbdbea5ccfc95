"""A wall along whose rotations states are carried to marks: as it was there, and as noisy sensors see it."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.signal import savgol_filter

STEP, COUNT, NOISE = 0.002, 3500, 0.01
MARKS = np.arange(500, 3001, 250)
AHEAD = 400
"""Samples of a window."""
WALL: dict[str, Any] = {
    "wall_length": 0.72, "wall_height": 1.8, "wall_mass": 161.0, "top_mass": 5000.0, "top_length": 0.72,
    "top_height": 0.6, "layer_thickness": 0.01, "base_stiffness": 4.0e7, "top_stiffness": 4.4e7, "base_damping": 8.7e5,
    "top_damping": 4.0e5,
}  # fmt: skip
RATES = ("rotation_rate_1", "rotation_rate_2")
HELD = ("rotation_1", "rotation_2", *RATES)


def recorded(channels: Any) -> np.ndarray:
    """Rotations (2, windows, samples) after the marks."""
    return np.array([[channels[name][k : k + AHEAD] for k in MARKS] for name in HELD[:2]])


def seen(channels: Any, kept: slice = slice(None)) -> dict[str, np.ndarray]:
    """Rotations with noise, smoothed, and their rates; of the samples ``kept``."""
    rng, motion = np.random.default_rng(1), {}
    for name, rate in zip(HELD[:2], RATES, strict=True):
        noisy = channels[name] + NOISE * np.max(np.abs(channels[name])) * rng.normal(size=COUNT)
        motion[name] = savgol_filter(noisy, 31, 3)[None, kept]
        motion[rate] = savgol_filter(noisy, 31, 3, deriv=1, delta=STEP)[None, kept]
    return motion
