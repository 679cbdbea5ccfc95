"""What is timed: each model with two blocks or a building, each rubber law, over the range of the rubber study."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

import models
from benchmarks.operations import count_operations
from models.base import FloatArray
from models.rubber import LAWS

NUMBERS = {
    "hardening": {"hardening.beta2": 3.0},
    "maxwell": {"maxwell.arm_stiffness_ratio": 0.5, "maxwell.relaxation_time": 0.05},
    "bouc_wen": {"bouc_wen.post_yield_ratio": 0.3, "bouc_wen.yield_compression": 1e-3, "bouc_wen.exponent": 2.0},
    "locking": {"locking.lock_strain": 0.7},
    "mullins": {"mullins.softening": 0.4, "mullins.strain": 0.3},
    "permanent_set": {"permanent_set.rate": 0.5, "permanent_set.strain_limit": 0.8},
}
"""Illustrative numbers of each law."""
STACKED_PLAN = """
model = "stacked"
[motion]
files = ["ridgecrest_2019_clc"]
[parameters]
wall_height = "1.8 m"
wall_mass = "300 kg"
top_mass = "500 kg"
top_length = "0.6 m"
top_height = "0.6 m"
[axes]
aspect_ratio = { linspace = [0.15, 0.6, 20] }
pga = { linspace = [0.1, 0.8, 1000], unit = "g" }
[run]
block_seconds = 0.3
"""
LAYERS_PLAN = """
model = "{model}"
[motion]
files = ["ridgecrest_2019_clc"]
[parameters]
wall_height = "1.8 m"
wall_thickness = "0.138 m"
wall_density = "900 kg/m^3"
top_length = "2 m"
top_height = "0.6 m"
top_mass = "5 t"
layer_thickness = "10 mm"
damping_ratio = 0.0544
{numbers}
[axes]
aspect_ratio = {{ linspace = [0.4, 1.2, 10] }}
layer_modulus = {{ geomspace = [{softest}, 20.0, {moduli}], unit = "MPa" }}
pga = {{ linspace = [0.05, 0.77, 20], unit = "g" }}
[run]
block_seconds = 0.3
"""
ISOLATED_PLAN = """
model = "isolated"
[motion]
files = ["ridgecrest_2019_clc"]
[parameters]
levels = 6
total_mass = "300 t"
storey_stiffness = "300 MN/m"
storey_damping = "1 MN s/m"
[axes]
bearing_stiffness = { geomspace = [1e6, 2e7, 20], unit = "N/m" }
bearing_damping = { geomspace = [2e4, 4e5, 5], unit = "N s/m" }
pga = { linspace = [0.05, 0.77, 100], unit = "g" }
[run]
block_seconds = 0.3
"""


@dataclass(frozen=True)
class Case:
    """``values(rng, n)``: parameters of n walls; ``numbers``: those of a rubber law; ``plan``: a study of the model.

    ``operations``: floating-point operations a lane-step where they can be counted.
    """

    name: str
    model: str
    values: Callable[[Any, int], dict[str, Any]]
    plan: str
    operations: int | None = None
    numbers: dict[str, float] = field(default_factory=dict)

    def walls(self, n: int, vertical: bool) -> tuple[Any, FloatArray]:
        """n of the model's own objects and their PGA in m s-2; the same for the same n."""
        rng = np.random.default_rng(0)
        values = {**self.values(rng, n), **self.numbers}
        pga = rng.uniform(0.05, 0.77, n) * 9.80665
        return models.get(self.model).build(values, vertical=vertical, size=n), pga


def stacks(rng: Any, n: int) -> dict[str, Any]:
    """Walls 1.8 m high, length/height .15 to .6, with a mass on top."""
    return {
        "wall_height": 1.8, "aspect_ratio": rng.uniform(0.15, 0.6, n), "wall_mass": 300.0,
        "top_mass": rng.uniform(100.0, 1000.0, n), "top_length": 0.6, "top_height": 0.6,
    }  # fmt: skip


def layered(rng: Any, n: int, softest: float = 1e6) -> dict[str, Any]:
    """Walls of studies/rubber_interface.toml."""
    return {
        "wall_height": 1.8, "wall_thickness": 0.138, "wall_density": 900.0, "top_length": 2.0, "top_height": 0.6,
        "layer_thickness": 0.01, "aspect_ratio": rng.uniform(0.4, 1.2, n), "top_mass": rng.uniform(1e3, 5e3, n),
        "layer_modulus": np.exp(rng.uniform(np.log(softest), np.log(2e7), n)),
        "damping_ratio": rng.uniform(0.0167, 0.1, n),
    }  # fmt: skip


def stiffer(rng: Any, n: int) -> dict[str, Any]:
    """From 4 MPa on: softer layers yield or creep under the heaviest wall."""
    return layered(rng, n, 4e6)


def buildings(rng: Any, n: int) -> dict[str, Any]:
    """Six levels of 300 t on bearings of 1 to 20 MN/m."""
    return {
        "levels": 6.0, "total_mass": 3e5, "storey_stiffness": 3e8, "storey_damping": 1e6, "rubber_thickness": 0.1,
        "bearing_stiffness": np.exp(rng.uniform(np.log(1e6), np.log(2e7), n)),
        "bearing_damping": np.exp(rng.uniform(np.log(2e4), np.log(4e5), n)),
    }  # fmt: skip


def operations(law: str) -> int:
    """Of one lane-step of the interface model."""
    from models.interface.fibres import COUNT
    from models.interface.lanes import along, fibres
    from models.interface.lanes.step import step_all

    if law == "linear":
        return count_operations(step_all, ("mixed", "laws"))
    once = sum(count_operations(part, ("mixed",)) for part in (step_all, fibres.predicted_strips, fibres.lengths))
    four = sum(count_operations(f, ()) for f in (along._begin(0), along._pass(LAWS[law], 0), along._end(0, False)))
    return once + 2 * (COUNT // 4) * four


def layers_plan(model: str, moduli: int, softest: float = 1.0, numbers: dict[str, float] | None = None) -> str:
    """A study of walls between layers, over ten aspect ratios, twenty PGA and so many moduli from ``softest`` MPa."""
    lines = "\n".join(f'"{name}" = {value}' for name, value in (numbers or {}).items())
    return LAYERS_PLAN.format(model=model, moduli=moduli, softest=softest, numbers=lines)


def cases() -> list[Case]:
    """All of them, the exact linear strip before the laws."""
    linear = Case(
        "interface.linear", "interface", layered, layers_plan("interface", 10), operations=operations("linear")
    )
    found = [Case("stacked", "stacked", stacks, STACKED_PLAN), linear]
    for law in LAWS:
        walls, softest = (stiffer, 4.0) if law in ("bouc_wen", "permanent_set") else (layered, 1.0)
        plan = layers_plan("interface", 3, softest, NUMBERS[law])
        found.append(
            Case(f"interface.{law}", "interface", walls, plan, operations=operations(law), numbers=NUMBERS[law])
        )
    found.append(Case("interface_linear", "interface_linear", layered, layers_plan("interface_linear", 3)))
    return [*found, Case("isolated", "isolated", buildings, ISOLATED_PLAN)]
