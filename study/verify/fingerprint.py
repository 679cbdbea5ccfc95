"""A fingerprint of every model: outputs of fixed cells under a shipped record, as they were when it was taken.

The oracles say whether the equations are solved; the fingerprint says whether this machine, with its processor and
its versions, gives the numbers that others get. Take it anew (``python -m study.verify.fingerprint``) when a model's
version changes.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

import models
from grids.motions import read_motion
from study.verify.base import Line, agreeing_digits
from study.verify.rubber import SHORT

FILE = Path(__file__).with_name("fingerprint.json")
RECORD, SECONDS, TAIL = "ridgecrest_2019_clc", (12.0, 24.0), 1.0
LANES = 16
REQUIRED = 6.0
"""Digits: an impact multiplies what rounding leaves, and the cells have a few of them."""

RAMP = np.linspace(0.0, 1.0, LANES)
BLOCK = {"height": 1.8, "aspect_ratio": 0.15 + 0.2 * RAMP, "mass": 800.0}
STACK = {
    "wall_height": 1.8, "aspect_ratio": 0.2 + 0.2 * RAMP, "wall_mass": 900.0, "top_mass": 2500.0, "top_length": 0.6,
    "top_height": 0.6,
}  # fmt: skip
BUILDING = {
    "levels": 4, "total_mass": 3e5, "storey_stiffness": 3e8, "storey_damping": 1e6, "rubber_thickness": 0.15,
    "bearing_stiffness": 1e6 + 8e6 * RAMP, "bearing_damping": 3e5,
}  # fmt: skip
CELLS: dict[str, tuple[dict[str, Any], tuple[float, float], tuple[str, ...]]] = {
    "housner": (BLOCK, (0.9, 1.6), ("onset_time", "peak_rotation", "uplift_duration", "dissipated_energy")),
    "stacked": (STACK, (0.9, 1.3), ("onset_time", "peak_rotation", "uplift_duration", "dissipated_energy")),
    "interface": (
        {**SHORT, "layer_modulus": 3e6 + 1e7 * RAMP}, (0.2, 0.4),
        ("onset_time", "peak_rotation", "uplift_duration", "minimum_contact_base"),
    ),
    "interface_linear": (
        {**SHORT, "wall_length": 1.2 + 0.8 * RAMP}, (0.1, 0.25), ("onset_time", "peak_rotation", "uplift_duration"),
    ),
    "isolated": (BUILDING, (0.5, 1.5), ("peak_bearing_displacement", "peak_level_acceleration", "dissipated_energy")),
}  # fmt: skip
"""Parameters, the range of factors on the record, and outputs, by model."""


def answers(model: str) -> dict[str, list[float]]:
    """The outputs of the cells of a model."""
    values, (low, high), outputs = CELLS[model]
    shaking = read_motion(RECORD, vertical=False).cut(*SECONDS).shaking()
    found = models.get(model).evaluate(
        values, shaking, np.linspace(low, high, LANES), outputs=[*outputs, "status"], tail=TAIL
    )
    return {name: np.asarray(found[name], float).tolist() for name in (*outputs, "status")}


def lines(model: str) -> Iterator[Line]:
    """One line an output: the digits that agree in the worst of its cells."""
    stored = json.loads(FILE.read_text("utf-8"))[model]
    version = models.get(model).version
    if stored["version"] != version:
        why = f"the fingerprint is of version {stored['version']}, the model is version {version}"
        yield Line(model, "fingerprint", RECORD, 0.0, REQUIRED, why)
        return
    found = answers(model)
    for name, expected in stored["outputs"].items():
        known = [np.nan if value is None else value for value in expected]
        digits = min(map(agreeing_digits, found[name], known))
        yield Line(model, f"fingerprint: {name} of {LANES} cells", RECORD, digits, REQUIRED)


def take() -> None:
    """Write the fingerprint of this machine."""
    record = {}
    for model in CELLS:
        outputs = {k: [None if np.isnan(x) else x for x in v] for k, v in answers(model).items()}
        record[model] = {"version": models.get(model).version, "outputs": outputs}
    FILE.write_text(json.dumps(record, indent=1) + "\n")


if __name__ == "__main__":
    take()
