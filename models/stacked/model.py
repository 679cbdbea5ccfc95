"""Two stacked blocks as a `Model`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from models.base import FloatArray, Values
from models.model import Model
from models.observed import Observed
from models.runs import Request, Run
from models.stacked import declaration
from models.stacked.identification import IDENTIFICATION
from models.stacked.observe import observe
from models.stacked.poses import poses
from models.stacked.stack import Stack, assemble


class Stacked(Model[Stack]):
    """Two rigid blocks, one on the other, on a rigid base (Psycharis 1990; Spanos, Roussis, Politis 2001).

    Eight configurations and rest; Lagrange's equations of the two-link pendulum in each
    (`models.stacked.equation`); impacts by projection in the kinetic metric (`models.stacked.reference.impact`);
    what follows an impact, an opening or a start from rest by one complementarity condition
    (`models.stacked.reference.choice`). No sliding and no lift-off: ``friction_demand`` shows where that would fail.
    A rotation_2 not given at the start equals rotation_1 (seated).
    """

    name = "stacked"
    title = "two stacked rigid blocks on a rigid base"
    version = "3"
    parameters = declaration.PARAMETERS
    alternatives = declaration.ALTERNATIVES
    options = declaration.OPTIONS
    outputs = declaration.OUTPUTS
    derived = declaration.DERIVED
    observables = declaration.OBSERVABLES
    states = declaration.STATES
    identification = IDENTIFICATION
    bodies = 2
    turns_base = ("table_pitch",)
    resumes_with = (
        "vertical_acceleration", "pivot_inset", "tilt", "eccentricity", "table_pitch", "restitution",
        "viscous_damping", "coulomb_damping",
    )  # fmt: skip

    def assemble(self, values: Values, options: Mapping[str, str], *, vertical: bool, size: int) -> Stack:
        return assemble(values, vertical, size)

    def check(self, values: Values, options: Mapping[str, str] | None = None) -> list[str]:
        """What has no meaning together: a density without thickness, a stack that does not stand by itself."""
        if found := super().check(values, options):
            return found
        stack = self.build(values, options)
        lean = stack.offset / stack.gravity
        for slope, what in (
            (stack.half_width / stack.centre, "wall and top block as one body"),
            (stack.half_width_2 / stack.centre_2, "top block"),
        ):
            falls = ~(np.abs(lean) < slope)
            if np.any(falls):
                worst = int(np.argmax(falls))
                found.append(
                    f"the {what} cannot stand at rest: with these pivots, mass centres and tilt it tips at "
                    f"{slope[worst]:.4f} g and gravity alone pushes with {abs(lean[worst]):.4f} g; make it "
                    "more stable or reduce the mechanism"
                )
        return found

    def derive(self, values: Values, options: Mapping[str, str] | None = None) -> dict[str, FloatArray]:
        """Slenderness angles (rad), R (m), p (s-1), e and onset accelerations (m s-2), arrays ``(n,)``."""
        stack = self.build(values, options)
        base = stack.gravity * stack.half_width / stack.centre
        top = stack.gravity * stack.half_width_2 / stack.centre_2
        given = stack.base_restitution
        e = np.where(np.isnan(given), stack.momentum_restitution, given) * stack.base_factor
        return {
            "alpha": stack.slenderness,
            "alpha_2": stack.slenderness_2,
            "radius": np.hypot(stack.half_width, stack.centre),
            "frequency_parameter": stack.frequency_parameter,
            "frequency_parameter_2": stack.frequency_parameter_2,
            "restitution_coefficient": e,
            "onset_acceleration": np.minimum(base, top),
            "onset_acceleration_base": base,
            "onset_acceleration_top": top,
        }

    def run_lanes(self, coefficients: Stack, request: Request) -> Run:
        from models.stacked.lanes.run import run

        return run(coefficients, request)

    def run_reference(self, coefficients: Stack, request: Request) -> Run:
        from models.stacked.reference.run import run

        return run(coefficients, request)

    def observe(self, coefficients: Stack, samples: FloatArray) -> Observed:
        return observe(coefficients, samples)

    def poses(self, coefficients: Stack, samples: FloatArray) -> Mapping[str, FloatArray]:
        return poses(coefficients, samples)

    def resume(
        self, states: FloatArray, outputs: Mapping[str, NDArray[Any]], initial: Mapping[str, FloatArray]
    ) -> dict[str, FloatArray]:
        """Rotations against the base, and their rates."""
        q1, q2, w1, w2 = states.T
        return {"rotation_1": q1, "rotation_2": q1 + q2, "rotation_rate_1": w1, "rotation_rate_2": w1 + w2}


MODEL = Stacked()
