"""A body or a chain of storeys on rubber bearings as a `Model`."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from models.base import FloatArray, Values
from models.isolated import declaration, modes
from models.isolated.assembly import assemble, complete
from models.isolated.chain import Chain
from models.isolated.identification import IDENTIFICATION
from models.isolated.observe import observe, poses
from models.model import Model
from models.runs import Request, Run


class Isolated(Model[Chain]):
    """A rigid body, or a chain of storeys, on rubber bearings in shear; horizontal shaking only.

    m_j x_j'' = -m_j a - F_j + F_(j+1),  F_1 = bearing(x_1, x_1'),  F_j = k_s (x_j - x_(j-1)) + c_s (x_j' - x_(j-1)'),
    j = 1 ... n from the slab above the bearings, x_j relative to the base, F_(n+1) = 0. The bearings carry the weight
    and never lift; nothing rocks or overturns. Without a force sensor only ratios to the mass are seen.
    """

    name = "isolated"
    title = "a body or a chain of storeys on rubber bearings in shear"
    version = "2"
    parameters = declaration.PARAMETERS
    alternatives = declaration.ALTERNATIVES
    options = declaration.OPTIONS
    outputs = declaration.OUTPUTS
    derived = declaration.DERIVED
    observables = declaration.OBSERVABLES
    states = declaration.STATES
    identification = IDENTIFICATION
    across_alone = True
    call_time = 8e-3
    takes_vertical = False

    def assemble(self, values: Values, options: Mapping[str, str], *, vertical: bool, size: int) -> Chain:
        return assemble(values, size)

    def complete(self, coefficients: Chain, options: Mapping[str, str]) -> Chain:
        return complete(coefficients, options)

    def derive(self, values: Values, options: Mapping[str, str] | None = None) -> dict[str, FloatArray]:
        """Mass, natural frequencies and modal damping at small strain, arrays ``(n,)``."""
        return modes.derived(self.build(values, options))

    def step_time(self, coefficients: Chain) -> float:
        return 1e-7

    def run_lanes(self, coefficients: Chain, request: Request) -> Run:
        from models.isolated.lanes.run import run

        return run(coefficients, request)

    def run_reference(self, coefficients: Chain, request: Request) -> Run:
        from models.isolated.reference.run import run

        return run(coefficients, request)

    def points(self, values: Values) -> Mapping[str, int]:
        return dict.fromkeys(declaration.BY_LEVEL, self.bodies_of(values))

    def bodies_of(self, values: Values) -> int:
        """The levels: body 1 is the slab above the bearings."""
        return int(np.max(values.get("levels", 1.0)))

    def observe(self, coefficients: Chain, samples: FloatArray) -> dict[str, FloatArray]:
        return observe(coefficients, samples)

    def poses(self, coefficients: Chain, samples: FloatArray) -> Mapping[str, FloatArray]:
        return poses(coefficients, samples)


MODEL = Isolated()
