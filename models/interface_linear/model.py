"""The paper's linear equations of two blocks on rubber, corrected, as a `Model`."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from models.base import FloatArray
from models.interface import modes, standing
from models.interface.layered import LayeredWall
from models.interface.model import Interface
from models.interface_linear import declaration, equation
from models.interface_linear.identification import IDENTIFICATION
from models.interface_linear.observe import observe
from models.interface_linear.poses import poses
from models.runs import Prescribed, Request, Run
from models.shaking import Shakings


class InterfaceLinear(Interface):
    """Two rigid blocks on rubber, linear between switches (Mordant, Denoel, Degee 2015, Eq. 6, corrected).

    M q'' + C q' + K q = f in q = (theta1, theta2, z1, z2), each joint in full contact, or in contact on half
    its length once z + b |r| > 0; dashpot law A. Exact in each configuration; see
    `models.interface_linear.equation` and docs/errata.md. For small rotations: the frozen half contact
    stiffens where the exact contact of `interface` softens, so these walls hardly overturn.
    """

    name = "interface_linear"
    title = "the paper's linear wall and block on rubber layers (Eq. 6, corrected)"
    version = "3"
    options = declaration.OPTIONS
    outputs = declaration.OUTPUTS
    identification = IDENTIFICATION
    bodies = 2
    turns_base = ()
    steps_chosen = False
    resumes_with = ("vertical_acceleration", "pivot_inset", "tilt")

    def resolve_options(self, options: Mapping[str, str] | None) -> dict[str, str]:
        """Every option of `interface` with its word: `joints` as chosen, the others as the paper has them."""
        return {**declaration.FIXED, **super().resolve_options(options)}

    def natural_modes(self, wall: LayeredWall) -> modes.Modes:
        return equation.at_rest(wall)

    def rest(self, wall: LayeredWall) -> FloatArray:
        return equation.rest(wall)

    def cannot_stand(self, coefficients: LayeredWall) -> list[standing.Unable]:
        leaning = bool(np.any(coefficients.offset))
        level = coefficients.replace(offset=0.0) if leaning else coefficients
        return [*standing.cannot_stand(level), *([equation.lifted(coefficients)] if leaning else [])]

    def run_lanes(self, coefficients: LayeredWall, request: Request) -> Run:
        from models.interface_linear.lanes.run import run

        return run(coefficients, request)

    def run_reference(self, coefficients: LayeredWall, request: Request) -> Run:
        from models.interface_linear.reference.run import run

        return run(coefficients, request)

    def carry_lanes(
        self,
        coefficients: LayeredWall,
        shakings: Shakings,
        along: Prescribed,
        initial: Mapping[str, FloatArray],
    ) -> dict[str, FloatArray]:
        from models.interface_linear.lanes.carried import carry

        return carry(coefficients, shakings, along, initial)

    def observe(self, coefficients: LayeredWall, samples: FloatArray) -> Mapping[str, FloatArray]:
        return observe(coefficients, samples)

    def poses(self, coefficients: LayeredWall, samples: FloatArray) -> Mapping[str, FloatArray]:
        return poses(coefficients, samples)


MODEL = InterfaceLinear()
