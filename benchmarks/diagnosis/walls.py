"""Concealed cases of a wall and a block on top between rubber layers, by seed (`two_bodies`).

The program apart is `fibre_wall`. A motion is scaled so that the wall without the effect turns 1.5 to 8 times as far as
it does when its base begins to lift.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from benchmarks.diagnosis import fibre_wall, shakings, suite, two_bodies
from benchmarks.diagnosis.bodies import HELD, Bodies, Motion, Values
from benchmarks.diagnosis.cases import Case
from benchmarks.diagnosis.effects import Hidden
from benchmarks.diagnosis.open_laws import Law
from benchmarks.diagnosis.scene import FloatArray, Unsuitable
from models.interface.model import MODEL
from models.shaking import Shaking

TOLERANCE = {
    "wall_length": 0.005, "wall_height": 0.005, "wall_mass": 0.01, "top_length": 0.005, "top_height": 0.005,
    "top_mass": 0.005, "layer_thickness": 0.01,
}  # fmt: skip
RANGES = {
    "base_stiffness": (1.5e7, 1.6e8), "top_stiffness": (1.5e7, 1.6e8), "base_damping": (1.0e4, 1.0e7),
    "top_damping": (1.0e4, 1.0e7),
}  # fmt: skip
REFITTED = {"wall_length": 0.005, "wall_height": 0.005, **dict.fromkeys(RANGES, np.inf)}
"""Parameters that a refit moves, with their relative tolerances."""
OVER_UPLIFT = (1.5, 8.0)
SCALES = np.geomspace(0.3, 6.0, 24)
COARSE = 32
"""Fibres with which the size of a law outside the catalogue is sought."""

ROWS = (
    Hidden(
        "maxwell", "maxwell", "arm_stiffness_ratio", (1.5,),
        shapes=lambda rng, _: {"relaxation_time": float(np.exp(rng.uniform(np.log(0.02), np.log(0.3))))},
    ),
    Hidden("hardening", "hardening", "beta2", (80.0,)),
    Hidden("mullins", "mullins", "softening", (0.7,), shapes=lambda rng, _: {"strain": float(rng.uniform(0.1, 0.5))}),
    Hidden(
        "bouc_wen", "bouc_wen", "post_yield_ratio", (0.2,), 1.0,
        shapes=lambda rng, _: {
            "yield_compression": float(rng.uniform(5e-4, 3e-3)), "exponent": float(rng.choice([1.0, 2.0])),
        },
    ),
    Hidden("pivot_inset", "contact_geometry", "inset_over_half_width", (0.35,)),
    Hidden("one_sided_stiffness", "one_sided_stiffness", "right_over_left", (0.5, 2.0), 1.0),
    Hidden("added_stiffness", "added_stiffness", "couple_stiffness", (-1e6, 5e6)),
    Hidden("viscous_damping", "viscous_damping", "couple_damping", (5e5,)),
    Hidden("coulomb_damping", "coulomb_damping", "over_m_g_b", (0.1,)),
    Hidden("interface_shear", "interface_shear", "shear_over_normal", (0.05,), math.inf, inverse=True),
    Hidden("tilt", "tilt", "tilt", (-0.05, 0.05)),
    Hidden("eccentricity", "tilt", "offset_top", (-0.2, 0.2)),
    Hidden("offset", "offset", "offset_over_peak", (-0.15, 0.15), sensor=True),
    Hidden("delay", "delay", "delay", (0.04,), sensor=True),
    Hidden("accelerometer_offset", "tilt", "offset", (-0.5, 0.5), sensor=True),
)  # fmt: skip
"""Without gains: beside a refit, one of 12 % leaves 1 to 3 times the noise, one of the base of 15 % .4 to 2."""
CATALOGUE = {row.name: row for row in ROWS}


@dataclass(frozen=True)
class WallDesign(suite.CaseDesign):
    """What a case of a wall is to hold."""


def designs(seed: int) -> list[suite.CaseDesign]:
    """All cases in mixed order."""
    return two_bodies.designs(BODIES, seed, WallDesign)


def make(design: suite.CaseDesign, seed: int) -> Case:
    """The case, the same for the same design and seed. Raises RuntimeError when no draw was suitable."""
    return two_bodies.make(BODIES, design, seed)


def _wall(rng: np.random.Generator) -> tuple[dict[str, float], dict[str, float]]:
    """Nominal and true values of a wall of hollow masonry, .7 to 2.2 m long, under a heavy top."""
    length = round(float(rng.uniform(0.7, 2.2)), 2)
    height = round(float(rng.uniform(1.5, 2.4)), 2)
    nominal = {
        "wall_length": length, "wall_height": height, "wall_mass": round(124.0 * length * height, 0),
        "top_length": length, "top_height": round(float(rng.uniform(0.4, 0.7)), 2),
        "top_mass": round(float(rng.uniform(3000.0, 6000.0)), -2), "layer_thickness": 0.01,
    }  # fmt: skip
    true = {name: value * (1.0 + TOLERANCE[name] * float(rng.normal())) for name, value in nominal.items()}
    layers = {f"{joint}_stiffness": float(np.exp(rng.uniform(np.log(3e7), np.log(8e7)))) for joint in ("base", "top")}
    true |= layers
    omega = 2.0 * np.pi * float(MODEL.derive({**true, "base_damping": 0.0, "top_damping": 0.0})["frequency_1"][0])
    for joint in ("base", "top"):
        true[f"{joint}_damping"] = 2.0 * float(rng.uniform(0.03, 0.1)) * layers[f"{joint}_stiffness"] / omega
    if not all(low < true[name] < high for name, (low, high) in RANGES.items()):
        raise Unsuitable
    return nominal, true


def _motion(true: Mapping[str, float], rng: np.random.Generator, low_pass: float) -> Motion:
    """A motion at a scale at which the wall without effects lifts well; its largest rotation (rad)."""
    source, unit = shakings.draw(rng, low_pass)
    unit = Shaking(unit.time_step, unit.horizontal)
    found = MODEL.evaluate(true, unit, SCALES, outputs=("peak_rotation_1", "overturned"), tail=0.0)
    ratio = found["peak_rotation_1"] / MODEL.derive(true)["uplift_rotation"][0]
    good = np.flatnonzero((ratio > OVER_UPLIFT[0]) & (ratio < OVER_UPLIFT[1]) & (found["overturned"] == 0))
    if not good.size:
        raise Unsuitable
    chosen = int(rng.choice(good))
    return source, shakings.scaled(unit, float(SCALES[chosen]), False), float(found["peak_rotation_1"][chosen])


def _apart(
    values: Values, mechanisms: Values, shaking: Shaking, law: Law | None, numbers: Sequence[float], largest: float,
    coarse: bool, kicks: FloatArray | None,
) -> dict[str, FloatArray]:  # fmt: skip
    """Of `fibre_wall`, on whose layers nothing strikes that could scatter."""
    try:
        found = fibre_wall.run(
            values, shaking.horizontal, shaking.time_step, mechanisms, law, numbers, largest,
            COARSE if coarse else fibre_wall.FIBRES,
        )  # fmt: skip
    except np.linalg.LinAlgError as error:  # it fell, far
        raise Unsuitable from error
    return dict(zip(HELD, (*found, *np.gradient(found, shaking.time_step, axis=1)), strict=True))


def _window(values: Values) -> float:
    """s: one and a half of the slowest periods."""
    return max(0.4, 1.5 / float(MODEL.derive(values)["frequency_1"][0]))


BODIES = Bodies(
    MODEL, CATALOGUE, TOLERANCE, REFITTED, _window, _wall, _motion, _apart, fibre_wall.knows, calibrated=RANGES
)
