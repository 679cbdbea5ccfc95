"""Concealed cases of two rigid blocks, one on the other, by seed (`two_bodies`).

The program apart is `rigid_stack`. A motion is scaled so that the stack without the effect rocks well, and stands.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from benchmarks.diagnosis import bases, rigid_stack, shakings, suite, two_bodies
from benchmarks.diagnosis.bodies import HELD, Bodies, Motion, Values
from benchmarks.diagnosis.cases import Case
from benchmarks.diagnosis.effects import Hidden
from benchmarks.diagnosis.open_laws import Law
from benchmarks.diagnosis.scene import FloatArray, Unsuitable
from models.shaking import Shaking
from models.stacked.model import MODEL

TOLERANCE = {
    name: bases.TOLERANCE[name]
    for name in ("wall_length", "wall_height", "wall_mass", "top_length", "top_height", "top_mass")
}
REFITTED = {name: TOLERANCE[name] for name in ("wall_length", "wall_height", "top_length", "top_height")}
"""Parameters that a refit moves, with their relative tolerances."""
WINDOW = 0.7
"""s, of the windows of an effect's size, as of one block."""
NARROWEST = 0.6
"""Of the wall's length, that of the block."""
FEWEST_IMPACTS = 8
"""Of both joints."""

ROWS = (
    Hidden("restitution", "restitution", "factor_on_housner", (0.5, 1.1), 1.0),
    Hidden("pivot_inset", "contact_geometry", "inset_over_half_width", (0.35,)),
    Hidden("viscous_damping", "viscous_damping", "rate", (1.0,)),
    Hidden("coulomb_damping", "coulomb_damping", "over_m_g_b", (0.1,)),
    Hidden("tilt", "tilt", "tilt", (-0.05, 0.05)),
    Hidden("eccentricity", "eccentricity", "offset_over_half_width", (-0.2, 0.2)),
    Hidden(
        "table_pitch", "table_pitch", "pitch_per_acceleration", (-0.003, 0.003),
        shapes=lambda rng, _: {"low_pass_hz": float(rng.uniform(4.0, 20.0))},
    ),
    Hidden("gain", "gain", "gain", (-0.12, 0.12), sensor=True),
    Hidden("offset", "offset", "offset_over_peak", (-0.15, 0.15), sensor=True),
    Hidden("delay", "delay", "delay", (0.04,), sensor=True),
    Hidden("base_gain", "base_gain", "gain", (-0.15, 0.15), sensor=True),
    Hidden("accelerometer_offset", "tilt", "offset", (-0.5, 0.5), sensor=True),
)  # fmt: skip
"""Seven mechanisms and five instruments; without the vertical acceleration, which asks for a channel of its own."""
CATALOGUE = {row.name: row for row in ROWS}


@dataclass(frozen=True)
class StackDesign(suite.CaseDesign):
    """What a case of a stack is to hold."""


def designs(seed: int) -> list[suite.CaseDesign]:
    """All cases in mixed order."""
    return two_bodies.designs(BODIES, seed, StackDesign)


def make(design: suite.CaseDesign, seed: int) -> Case:
    """The case, the same for the same design and seed. Raises RuntimeError when no draw was suitable."""
    return two_bodies.make(BODIES, design, seed)


def _stack(rng: np.random.Generator) -> tuple[dict[str, float], dict[str, float]]:
    """Nominal and true values of a block on a wall."""
    nominal = bases.two_bodies(rng, NARROWEST)
    return nominal, bases.near(nominal, rng)


def _motion(true: Values, rng: np.random.Generator, low_pass: float) -> Motion:
    """A motion at a scale at which the stack without effects rocks well; the largest rotation (rad) of its wall."""
    source, unit = shakings.draw(rng, low_pass)
    unit = Shaking(unit.time_step, unit.horizontal)
    asked = ("peak_rotation_1", "peak_rotation_ratio", "impacts", "overturned")
    found = MODEL.evaluate(true, unit, bases.SCALES, outputs=asked, tail=0.0)
    ratio, lower = found["peak_rotation_ratio"], found["peak_rotation_1"] / MODEL.derive(true)["alpha"][0]
    good = (lower > bases.PEAK[0]) & (ratio < bases.PEAK[1]) & (found["impacts"] > FEWEST_IMPACTS)
    good = np.flatnonzero(good & (found["overturned"] == 0))
    if not good.size:
        raise Unsuitable
    chosen = int(rng.choice(good))
    return source, shakings.scaled(unit, float(bases.SCALES[chosen]), False), float(found["peak_rotation_1"][chosen])


def _apart(
    values: Values, mechanisms: Values, shaking: Shaking, law: Law | None, numbers: Sequence[float], largest: float,
    coarse: bool, kicks: FloatArray | None,
) -> dict[str, FloatArray]:  # fmt: skip
    """Of `rigid_stack`, which is precise at any step."""
    found = rigid_stack.run(values, shaking.horizontal, shaking.time_step, mechanisms, law, numbers, largest, kicks)
    return dict(zip(HELD, np.concatenate(found), strict=True))


BODIES = Bodies(
    MODEL,
    CATALOGUE,
    TOLERANCE,
    REFITTED,
    lambda values: WINDOW,
    _stack,
    _motion,
    _apart,
    rigid_stack.knows,
    impacts=True,
)
