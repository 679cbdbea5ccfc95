"""Walls between rubber layers: the state at rest, small motions, and an elastic wall that keeps its energy."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import Any

import numpy as np

import models
from models.shaking import Shaking
from study.verify.base import Oracle

SHORT = {
    "wall_length": 0.72, "wall_height": 1.8, "wall_thickness": 0.138, "wall_density": 900.0, "top_mass": 5000.0,
    "top_length": 2.0, "top_height": 0.6, "layer_thickness": 0.01, "layer_modulus": 4.5e6, "damping_ratio": 0.0544,
    "gravity": 9.81,
}  # fmt: skip
LONG = {**SHORT, "wall_length": 2.0, "damping_ratio": 0.0167}
FREQUENCIES = {
    ("interface", "short"): (1.35130, 6.38983, 10.59931, 119.10733),
    ("interface", "long"): (6.3723, 17.5377, 29.4294, 119.975),
    ("interface_linear", "short"): (1.3507, 6.3889, 10.5993, 119.107),
    ("interface_linear", "long"): (6.3713, 17.5377, 29.4280, 119.975),
}
"""Hz, of the Jacobian at rest, gravity included."""
DERIVED = "derived, twice"


def derived(model: str, wall: Mapping[str, float], name: str) -> float:
    return float(models.get(model).derive(wall)[name][0])


def first_period(model: str) -> float:
    """Frequency in Hz of a small free swing without dashpots, over four of its periods."""
    wall: dict[str, Any] = {k: v for k, v in SHORT.items() if k != "damping_ratio"}
    wall |= {"base_damping": 0.0, "top_damping": 0.0}
    found, chosen = derived(model, wall, "frequency_1"), models.get(model)
    shape = [derived(model, wall, f"mode_1_rotation_{k}") for k in (1, 2)]
    initial = {f"rotation_{k}": 1e-6 * shape[k - 1] / max(map(abs, shape)) for k in (1, 2)}
    step = 0.25 / found / 200
    run = chosen.simulate(wall, Shaking.silence(4.2 / found, step), initial=initial)
    swing, time = run.channels["rotation_1"], run.time
    down = np.flatnonzero((swing[:-1] > 0.0) & (swing[1:] <= 0.0))
    zero = time[down] + step * swing[down] / (swing[down] - swing[down + 1])
    return float((zero.size - 1) / (zero[-1] - zero[0]))


def oracles() -> list[Oracle]:
    walls = {"short": SHORT, "long": LONG}
    found = [
        Oracle(model, f"natural frequency {k + 1} of the {name} wall, Hz", DERIVED, value, 4.0 if value > 100 else 4.2,
               partial(derived, model, walls[name], f"frequency_{k + 1}"))
        for (model, name), values in FREQUENCIES.items() for k, value in enumerate(values)
    ]  # fmt: skip
    of = partial(Oracle, "interface")
    found += [
        of("compression of the base layer at rest, m", "(m1 + m2) g/(2 k b)", 1.1323e-3, 4.0,
           partial(derived, "interface", SHORT, "static_compression_base")),
        of("compression of the top layer at rest, m", "m2 g/(2 k b)", 1.0970e-3, 4.0,
           partial(derived, "interface", SHORT, "static_compression_top")),
        of("rotation at which the base starts to open", "W/(2 k b^2)", 3.145e-3, 3.5,
           partial(derived, "interface", SHORT, "uplift_rotation")),
    ]  # fmt: skip
    return found + [
        Oracle(model, "frequency of a small swing, by its kernel, Hz", "its own Jacobian",
               derived(model, SHORT | {"damping_ratio": 0.0}, "frequency_1"), 3.0, partial(first_period, model))
        for model in ("interface", "interface_linear")
    ]  # fmt: skip
