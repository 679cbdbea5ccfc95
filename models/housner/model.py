"""One rocking block as a `Model`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from models.base import FloatArray, Values
from models.errors import InputError
from models.housner import declaration
from models.housner.block import Block, assemble
from models.housner.identification import IDENTIFICATION
from models.model import Model
from models.observed import Observed
from models.placing import masses
from models.runs import Request, Run


class Housner(Model[Block]):
    """Housner's rigid block on a rigid base (Bull. Seism. Soc. Am. 53, 1963), alone or with a mass on top.

    theta'' = -p^2 [ (G/g) sin(alpha s - theta) + (a/g) cos(alpha s - theta) ],  G = g + a_z,
    p^2 = M g R/I_O, s = sign(theta); rocking starts when |a| > G tan(alpha); an impact multiplies
    theta' by e. No sliding and no lift-off: ``friction_demand`` shows where that would fail.
    """

    name = "housner"
    title = "one rigid block on a rigid base"
    version = "4"
    parameters = declaration.PARAMETERS
    alternatives = declaration.ALTERNATIVES
    options = declaration.OPTIONS
    outputs = declaration.OUTPUTS
    derived = declaration.DERIVED
    observables = declaration.OBSERVABLES
    states = declaration.STATES
    identification = IDENTIFICATION
    integrators = ("lanes", "reference", "newmark")
    bodies = 1
    not_placed = ("bounce", "wall_flexibility")
    moves_pivots = ("crushing",)
    turns_base = ("table_pitch",)
    resumes_with = declaration.RESUMES_WITH

    def assemble(self, values: Values, options: Mapping[str, str], *, vertical: bool, size: int) -> Block:
        return assemble(values, vertical, size)

    def check(self, values: Values, options: Mapping[str, str] | None = None) -> list[str]:
        """What has no meaning together: no mass at all, impacts after which the block does not rock, mechanisms
        that do not act together."""
        block = self.build(values, options)
        found = block.clashes()
        if np.any(~(block.mass > 0.0)):
            found.append("mass and top_mass are both 0 kg: give at least one of them")
            return found
        # a mechanism's factor on e is meant for fits too; Housner's own e must be positive
        free = np.isnan(block.restitution) & ~(block.momentum_restitution > 0.0)
        if np.any(free):
            worst = int(np.argmax(free))
            slope = np.degrees(block.slenderness[worst])
            found.append(
                f"the restitution coefficient of angular momentum is {block.momentum_restitution[worst]:.3f} "
                f"(alpha = {slope:.2f} deg): such a block does not rock; make it more slender or give restitution"
            )
        return found

    def derive(self, values: Values, options: Mapping[str, str] | None = None) -> dict[str, FloatArray]:
        """alpha (rad), R (m), p (s-1), e, onset acceleration (m s-2), arrays ``(n,)``."""
        block = self.build(values, options)
        given = block.restitution
        e = np.where(np.isnan(given), block.momentum_restitution, given) * block.restitution_factor
        return {
            "alpha": block.slenderness,
            "radius": block.radius,
            "frequency_parameter": block.frequency_parameter,
            "restitution_coefficient": e,
            "onset_acceleration": block.gravity * np.tan(block.slenderness),
        }

    def run(self, integrator: str, coefficients: Block, request: Request) -> Run:
        """All lanes; the integrator ``newmark`` is the paper's."""
        for sentence in coefficients.clashes():
            raise InputError(sentence)
        if not coefficients.plain and (request.linear or integrator == "newmark"):
            which = "the linear formulation" if request.linear else "the integrator newmark"
            raise InputError(
                f"{which} knows only mechanisms that change pivots, gravity, the base motion or the impact; "
                "use the nonlinear formulation with lanes or reference for the others"
            )
        if integrator != "newmark":
            return super().run(integrator, coefficients, request)
        from models.housner.reference.newmark import run

        return run(coefficients, request)

    def run_lanes(self, coefficients: Block, request: Request) -> Run:
        from models.housner.lanes.run import run

        return run(coefficients, request)

    def run_reference(self, coefficients: Block, request: Request) -> Run:
        from models.housner.reference.run import run

        return run(coefficients, request)

    def observe(self, coefficients: Block, samples: FloatArray) -> Observed:
        """The observables of theta, theta' and what sliding, bouncing or bending adds to the displacement (m)."""
        rotation, rate, shift = np.moveaxis(samples, -1, 0)

        def displacement() -> FloatArray:
            rho = coefficients.corner_radius[:, None]
            h = coefficients.height[:, None] - rho
            b = np.where(rotation >= 0.0, coefficients.right[:, None], coefficients.left[:, None]) - rho
            across = h * np.sin(rotation) + rho * rotation + np.sign(rotation) * b * (1.0 - np.cos(rotation))
            return np.asarray(across + shift)

        return Observed(
            {
                "rotation_1": lambda: rotation,
                "rotation_rate_1": lambda: rate,
                "displacement_1_x": displacement,
                "contact_1": lambda: ((rotation == 0.0) & (rate == 0.0)).astype(float),
            }
        )

    def poses(self, coefficients: Block, samples: FloatArray) -> Mapping[str, FloatArray]:
        """The underside turns about the pivot it stands on, rolls on a rounded corner, and slides."""
        rotation, _, shift = np.moveaxis(samples, -1, 0)
        rho = coefficients.corner_radius[:, None]
        half = 0.5 * (coefficients.right + coefficients.left)[:, None] - rho
        beside = 0.5 * (coefficients.left - coefficients.right)

        def across() -> FloatArray:
            rolled = rho * (rotation - np.sin(rotation))
            return np.asarray(rolled + np.sign(rotation) * half * (1.0 - np.cos(rotation)) + shift)

        return Observed(
            {
                "underside_1_x": across,
                "underside_1_z": lambda: half * np.abs(np.sin(rotation)) + rho * (1.0 - np.cos(rotation)),
                "underside_1_height": lambda: np.zeros_like(rotation),
                **masses(rotation, (coefficients.mass, beside, coefficients.height)),
            }
        )

    def resume(
        self, states: FloatArray, outputs: Mapping[str, NDArray[Any]], initial: Mapping[str, FloatArray]
    ) -> dict[str, FloatArray]:
        """Rotation and rate, the largest rotation so far and since the last impact, and the impacts so far."""
        earlier = {name: initial.get(name, np.zeros(states.shape[0])) for name in ("peak_rotation_1", "impacts")}
        return {
            "rotation_1": states[:, 0],
            "rotation_rate_1": states[:, 1],
            "peak_rotation_1": np.maximum(earlier["peak_rotation_1"], outputs["peak_rotation"]),
            "swing_peak_1": np.asarray(outputs["swing_peak"], dtype=np.float64),
            "impacts": earlier["impacts"] + outputs["impacts"],
        }

    def settle(self, run: Run, time_step: float) -> FloatArray:
        """States in which a block that has overturned lies at pi/2."""
        samples = run.samples.copy()
        for lane in np.flatnonzero(run.outputs["overturned"]):
            size = np.abs(samples[lane, :, 0])
            beyond = np.flatnonzero(size >= np.pi / 2)
            fallen = int(beyond[0]) if beyond.size else int(np.argmax(size)) + 1
            samples[lane, fallen:, 0] = np.sign(run.outputs["residual_rotation"][lane]) * np.pi / 2
            samples[lane, fallen:, 1] = 0.0
        return samples


MODEL = Housner()
