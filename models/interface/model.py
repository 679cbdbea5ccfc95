"""A wall and a block on top between rubber layers as a `Model`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from models.base import FloatArray, Values
from models.interface import declaration, modes, standing
from models.interface.assembly import assemble, complete
from models.interface.effects import BENDS
from models.interface.effects import STATES as OTHER_STATES
from models.interface.identification import IDENTIFICATION
from models.interface.layered import LayeredWall
from models.interface.observe import observe
from models.interface.poses import poses
from models.interface.tangent import unstressed
from models.model import Model
from models.runs import Prescribed, Request, Run
from models.shaking import Shakings


class Interface(Model[LayeredWall]):
    """Two rigid blocks, a no-tension visco-elastic layer under each (Mordant, Denoel, Degee 2015, section 3).

    M(q) q'' + n(q, q', a, G) = Q(q, q') in q = (theta1, theta2, z1, z2), full nonlinear, with the exact
    contact length of each layer; see `models.interface.reference.equation` and docs/errata.md for the paper's
    printed form. Without the mechanism `sliding`, ``friction_demand`` tells when the joints could not hold.
    """

    name = "interface"
    title = "a wall and a block on top, a rubber layer under each"
    version = "6"
    parameters = declaration.PARAMETERS
    alternatives = declaration.ALTERNATIVES
    options = declaration.OPTIONS
    outputs = declaration.OUTPUTS
    derived = declaration.DERIVED
    observables = declaration.OBSERVABLES
    states = declaration.STATES
    identification = IDENTIFICATION
    bodies = 2
    call_time = 2e-2
    not_placed = ("wall_flexibility",)
    steps_chosen = True
    turns_base: tuple[str, ...] = ("table_pitch",)
    vertical_by_default = True
    resumes_with: tuple[str, ...] | None = (
        "vertical_acceleration", "pivot_inset", "hardening", "locking", "tilt", "eccentricity", "table_pitch",
        "contact_length", "added_stiffness", "one_sided_stiffness", "viscous_damping", "coulomb_damping",
        "sliding", "wall_flexibility", "table_force",
    )  # fmt: skip

    def assemble(self, values: Values, options: Mapping[str, str], *, vertical: bool, size: int) -> LayeredWall:
        return assemble(values, options, vertical, size)

    def complete(self, coefficients: LayeredWall, options: Mapping[str, str]) -> LayeredWall:
        return complete(coefficients, options)

    def cannot_stand(self, coefficients: LayeredWall) -> list[standing.Unable]:
        return standing.cannot_stand(coefficients)

    def derive(self, values: Values, options: Mapping[str, str] | None = None) -> dict[str, FloatArray]:
        """Static state, natural frequencies, mode shapes and modal damping at rest, arrays ``(n,)``."""
        wall = self.build(values, options)
        return modes.derived(wall, self.natural_modes(wall), self.rest(wall))

    def natural_modes(self, wall: LayeredWall) -> modes.Modes:
        """Undamped modes in full contact."""
        return modes.at_rest(wall)

    def rest(self, wall: LayeredWall) -> FloatArray:
        """q ``(n, 4)`` at rest under gravity, relaxed."""
        return modes.static_state(wall)

    def steps_a_sample(self, values: Values, time_step: float, options: Mapping[str, str] | None = None) -> int:
        from models.interface.lanes.run import substeps

        wall = self.build(values, options)
        return int(np.max(substeps(wall, modes.at_rest(wall).squares, time_step)))

    def step_time(self, coefficients: LayeredWall) -> float:
        from models.interface.lanes.run import step_time

        return step_time(coefficients)

    def run_lanes(self, coefficients: LayeredWall, request: Request) -> Run:
        from models.interface.lanes.run import run

        return run(coefficients, replace(request, step=self.step))

    def run_reference(self, coefficients: LayeredWall, request: Request) -> Run:
        from models.interface.reference.run import run

        return run(coefficients, request)

    def declared(
        self, values: Values, names: Sequence[str], options: Mapping[str, str] | None = None
    ) -> Mapping[str, FloatArray]:
        """The stiffness of the unstressed layers, from their slope under the static load."""
        return unstressed(self.build(values, options), values, names)

    def carry_lanes(
        self,
        coefficients: LayeredWall,
        shakings: Shakings,
        along: Prescribed,
        initial: Mapping[str, FloatArray],
    ) -> dict[str, FloatArray]:
        from models.interface.lanes.carried import carry

        return carry(coefficients, shakings, along, initial, self.step)

    def observe(self, coefficients: LayeredWall, samples: FloatArray) -> Mapping[str, FloatArray]:
        return observe(coefficients, samples)

    def poses(self, coefficients: LayeredWall, samples: FloatArray) -> Mapping[str, FloatArray]:
        return poses(coefficients, samples)

    def resume(
        self, states: FloatArray, outputs: Mapping[str, NDArray[Any]], initial: Mapping[str, FloatArray]
    ) -> dict[str, FloatArray]:
        """The states, with effects those of the other coordinates, too."""
        found = dict(zip((*self.states, *OTHER_STATES), states.T, strict=False))
        return found | {name: found[name] - found[lower] for name, lower in BENDS.items() if name in found}

    def settle(self, run: Run, time_step: float) -> FloatArray:
        """States that stay where a body reached pi/2."""
        samples = run.samples.copy()
        for lane in np.flatnonzero(run.outputs["overturned"]):
            fallen = int(np.ceil(run.outputs["overturning_time"][lane] / time_step - 1e-9))
            samples[lane, fallen:, :4] = samples[lane, max(fallen - 1, 0), :4]
            for body in (1, 2):
                if run.outputs[f"overturned_{body}"][lane]:
                    samples[lane, fallen:, body - 1] = run.outputs[f"residual_rotation_{body}"][lane]
            samples[lane, fallen:, 4:8] = 0.0
            if samples.shape[2] > 8:
                samples[lane, fallen:, 8:12] = samples[lane, max(fallen - 1, 0), 8:12]
                samples[lane, fallen:, 12:] = 0.0
        return samples


MODEL = Interface()
