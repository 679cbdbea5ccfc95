"""A wall and a block on top between rubber layers as a `Model`."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from models.base import Event, FloatArray, Values
from models.errors import InputError
from models.interface import declaration, modes
from models.interface.assembly import assemble, build
from models.interface.identification import IDENTIFICATION
from models.interface.layered import LayeredWall
from models.interface.observe import observe
from models.model import Model
from models.runs import Request, Run


class Interface(Model[LayeredWall]):
    """Two rigid blocks, a no-tension visco-elastic layer under each (Mordant, Denoel, Degee 2015, section 3).

    M(q) q'' + n(q, q', a, G) = Q(q, q') in q = (theta1, theta2, z1, z2), full nonlinear, with the exact
    contact length of each layer; see `models.interface.reference.equation` and docs/errata.md for the paper's
    printed form. No sliding: ``friction_demand`` tells when that would fail.
    """

    name = "interface"
    title = "a wall and a block on top, a rubber layer under each"
    version = "4"
    parameters = declaration.PARAMETERS
    alternatives = declaration.ALTERNATIVES
    options = declaration.OPTIONS
    outputs = declaration.OUTPUTS
    derived = declaration.DERIVED
    observables = declaration.OBSERVABLES
    states = declaration.STATES
    identification = IDENTIFICATION
    vertical_by_default = True

    def assemble(self, values: Values, options: Mapping[str, str], *, vertical: bool, size: int) -> LayeredWall:
        return assemble(values, options, vertical, size)

    def build(
        self, values: Values, options: Mapping[str, str] | None = None, *, vertical: bool = False, size: int = 1
    ) -> LayeredWall:
        """The walls with mechanisms, and with the rubber laws that ``options`` name."""
        return build(values, self.resolve_options(options), vertical, size, self.name)

    def check(self, values: Values, options: Mapping[str, str] | None = None) -> list[str]:
        """Layers that lack a number, and walls that cannot stand on them under their own weight."""
        try:
            wall = self.build(values, options)
        except InputError as error:
            return [str(error)]
        lowest = modes.at_rest(wall).squares[:, 0]
        if np.any(~(lowest > 0.0)):
            worst = int(np.argmax(~(lowest > 0.0)))
            return [
                f"the layers are too soft to hold the wall upright (k_b = {wall.base_stiffness[worst]:.3g}, "
                f"k_t = {wall.top_stiffness[worst]:.3g} N m-2): make them stiffer or the wall longer"
            ]
        found = []
        compression = -modes.static_state(wall)
        for joint, compressed, thickness in (
            ("base", compression[:, 2], wall.base_thickness),
            ("top", compression[:, 3], wall.top_thickness),
        ):
            if wall.joints in ("both", joint) and np.any(compressed > thickness):
                worst = int(np.argmax(compressed - thickness))
                found.append(
                    f"under its load the {joint} layer is compressed by {compressed[worst] * 1e3:.3g} mm, more than "
                    f"its thickness of {thickness[worst] * 1e3:.3g} mm: make it stiffer or thicker"
                )
        return found

    def derive(self, values: Values, options: Mapping[str, str] | None = None) -> dict[str, FloatArray]:
        """Static state, natural frequencies, mode shapes and modal damping at rest, arrays ``(n,)``."""
        wall = self.build(values, options)
        return modes.derived(wall, self.natural_modes(wall))

    def natural_modes(self, wall: LayeredWall) -> modes.Modes:
        """Undamped modes in full contact."""
        return modes.at_rest(wall)

    def run_lanes(self, coefficients: LayeredWall, request: Request) -> Run:
        from models.interface.lanes.run import outputs, run

        return by_lanes(run, outputs, coefficients, request)

    def run_reference(self, coefficients: LayeredWall, request: Request) -> Run:
        from models.interface.reference.run import run

        return by_reference(run, coefficients, request)

    def observe(self, coefficients: LayeredWall, samples: FloatArray) -> dict[str, FloatArray]:
        return observe(coefficients, samples)

    def settle(self, run: Run, time_step: float) -> FloatArray:
        """States that stay where a body reached pi/2."""
        samples = run.samples.copy()
        for lane in np.flatnonzero(run.outputs["overturned"]):
            fallen = int(np.ceil(run.outputs["overturning_time"][lane] / time_step - 1e-9))
            samples[lane, fallen:, :4] = samples[lane, max(fallen - 1, 0), :4]
            for body in (1, 2):
                if run.outputs[f"overturned_{body}"][lane]:
                    samples[lane, fallen:, body - 1] = run.outputs[f"residual_rotation_{body}"][lane]
            samples[lane, fallen:, 4:] = 0.0
        return samples


def by_lanes(run: Callable[..., Any], outputs: Callable[..., Any], wall: LayeredWall, request: Request) -> Run:
    """What the kernel that ``run`` calls makes of a request."""
    ran = run(
        wall, request.shaking, request.scale, tail=request.tail, initial=request.initial, first=request.first,
        last=request.last, samples=request.samples, log=request.log, may_rest=not request.history,
    )  # fmt: skip
    events = tuple(_with_onset(tuple(Event(*event) for event in lane)) for lane in ran.events)
    return Run(outputs(wall, ran.result), ran.samples, events, ran.steps)


def by_reference(run: Callable[..., Any], wall: LayeredWall, request: Request) -> Run:
    """What the reference ``run`` makes of a request of one lane."""
    ran = run(
        wall, request.shaking, float(request.scale[0]), tail=request.tail, initial=request.start,
        duration=request.until if request.history else None,
    )  # fmt: skip
    return Run.of_one(ran.outputs, ran.state.T, _with_onset(ran.events))


def _with_onset(events: tuple[Event, ...]) -> tuple[Event, ...]:
    """The first uplift is the onset too."""
    for k, event in enumerate(events):
        if event.kind == "uplift":
            return (*events[:k], Event(event.time, "onset", event.body), *events[k:])
    return events


MODEL = Interface()
