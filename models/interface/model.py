"""A wall and a block on top between rubber layers as a `Model`: lanes and reference behind one interface."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import NDArray

from models import choices
from models.answers import answers
from models.base import Event, FloatArray, History, Mechanism, Parameter, Quantity, Values
from models.errors import InputError
from models.identification import Identification
from models.interface import declaration, modes
from models.interface.assembly import build
from models.interface.identification import IDENTIFICATION
from models.interface.layered import LayeredWall
from models.mechanisms import acting_on
from models.shaking import Shaking


@dataclass(frozen=True)
class Interface:
    """Two rigid blocks, a no-tension visco-elastic layer under each (Mordant, Denoel, Degee 2015, section 3).

    M(q) q'' + n(q, q', a, G) = Q(q, q') in q = (theta1, theta2, z1, z2), full nonlinear, with the exact
    contact length of each layer; see `models.interface.equation` and docs/errata.md for the paper's
    printed form. No sliding: ``needed_friction`` tells when that would fail.
    """

    name: str = "interface"
    title: str = "a wall and a block on top, a rubber layer under each"
    version: str = "4"
    parameters: tuple[Parameter, ...] = declaration.PARAMETERS
    alternatives: tuple[tuple[tuple[str, ...], ...], ...] = declaration.ALTERNATIVES
    outputs: tuple[Quantity, ...] = declaration.OUTPUTS
    derived: tuple[Quantity, ...] = declaration.DERIVED
    observables: tuple[Quantity, ...] = declaration.OBSERVABLES
    states: tuple[str, ...] = declaration.STATES
    integrators: tuple[str, ...] = ("lanes", "reference")
    identification: Identification | None = IDENTIFICATION
    takes_vertical: bool = True
    vertical_by_default: bool = True

    @property
    def options(self) -> Mapping[str, tuple[str, ...]]:
        return declaration.OPTIONS

    @property
    def mechanisms(self) -> Mapping[str, Mechanism]:
        return acting_on(self.name)

    def resolve_options(self, options: Mapping[str, str] | None) -> dict[str, str]:
        """Every option with its word, the default where none is given."""
        return choices.resolve_options(self, options)

    def _part(self, name: str) -> Any:
        """A module of this model's folder: ``lanes.run``, ``reference``, ``observe``."""
        return import_module(f"models.{self.name}.{name}")

    def check(self, values: Values, options: Mapping[str, str] | None = None) -> list[str]:
        """Layers that lack a number, and walls that cannot stand on them under their own weight."""
        try:
            wall = build(values, self.resolve_options(options), False, model=self.name)
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
        sunk = -modes.static_state(wall)
        for joint, sinking, thickness in (
            ("base", sunk[:, 2], wall.base_thickness),
            ("top", sunk[:, 3], wall.top_thickness),
        ):
            if wall.joints in ("both", joint) and np.any(sinking > thickness):
                worst = int(np.argmax(sinking - thickness))
                found.append(
                    f"under its load the {joint} layer is compressed by {sinking[worst] * 1e3:.3g} mm, more than its "
                    f"thickness of {thickness[worst] * 1e3:.3g} mm: make it stiffer or thicker"
                )
        return found

    def derive(self, values: Values, options: Mapping[str, str] | None = None) -> dict[str, FloatArray]:
        """Static state, natural frequencies, mode shapes and modal damping at rest, arrays ``(n,)``."""
        wall = build(values, self.resolve_options(options), False, model=self.name)
        return modes.derived(wall, self.natural_modes(wall))

    def natural_modes(self, wall: LayeredWall) -> modes.Modes:
        """Undamped modes in full contact."""
        return modes.at_rest(wall)

    def _shaken(self, values: Values, options: Mapping[str, str] | None, shaking: Shaking, size: int) -> LayeredWall:
        vertical = shaking.vertical is not None and shaking.vertical_acts
        wall = build(values, self.resolve_options(options), vertical, size, self.name)
        if wall.size != size:
            raise ValueError(f"values broadcast to {wall.size} lanes, {size} are asked for")
        return wall

    def evaluate(
        self,
        values: Values,
        shaking: Shaking,
        scale: FloatArray,
        *,
        outputs: Sequence[str],
        tail: float,
        options: Mapping[str, str] | None = None,
        integrator: str = "lanes",
    ) -> dict[str, NDArray[Any]]:
        """Outputs ``(n,)`` of n lanes under ``scale`` (n,) times the shaking; see `Model.evaluate`."""
        scale = np.atleast_1d(np.asarray(scale, float))
        wall = self._shaken(values, options, shaking, scale.size)
        choices.check_integrator(self, integrator)
        if integrator == "lanes":
            lanes = self._part("lanes.run")
            found = lanes.outputs(wall, lanes.run(wall, shaking, scale, tail=tail).result)
        else:
            reference = self._part("reference")
            each = [
                reference.run(wall.take(slice(k, k + 1)), shaking, float(scale[k]), tail=tail).outputs
                for k in range(scale.size)
            ]
            found = {q.name: np.array([one[q.name] for one in each]) for q in self.outputs}
        return answers(self.outputs, found, outputs)

    def trajectories(
        self,
        values: Values,
        shaking: Shaking,
        *,
        first: NDArray[np.int64],
        samples: int,
        initial: Mapping[str, FloatArray],
        options: Mapping[str, str] | None = None,
        scale: FloatArray | float = 1.0,
    ) -> dict[str, FloatArray]:
        """Observables ``(n, samples)`` of n lanes, each from its own sample ``first`` and state.

        ``initial`` holds arrays ``(n,)`` by the names of `states`; what it leaves out is as at rest.
        """
        n = first.size
        wall = self._shaken(values, options, shaking, n)
        last = np.minimum(first + samples - 1, shaking.horizontal.size - 1)
        ran = self._part("lanes.run").run(
            wall, shaking, np.broadcast_to(np.asarray(scale, float), (n,)), initial=initial, first=first, last=last,
            samples=samples, may_rest=False,
        )  # fmt: skip
        return self._observe(wall, ran.samples)

    def _observe(self, wall: LayeredWall, state: FloatArray) -> dict[str, FloatArray]:
        found: dict[str, FloatArray] = self._part("observe").observe(wall, state)
        return found

    def simulate(
        self,
        values: Values,
        shaking: Shaking,
        *,
        scale: float = 1.0,
        initial: Mapping[str, float] | None = None,
        duration: float | None = None,
        tail: float = 0.0,
        options: Mapping[str, str] | None = None,
        integrator: str = "lanes",
    ) -> History:
        """One run with its history at the samples of the shaking and of its quiet tail.

        ``duration`` (s) cuts the run or lengthens it beyond the shaking; the channels of a run that
        overturns stay where a body reached pi/2.
        """
        wall = self._shaken(values, options, shaking, 1)
        choices.check_integrator(self, integrator)
        end = shaking.duration + tail if duration is None else duration
        count = round(end / shaking.time_step) + 1
        time: FloatArray = np.arange(count, dtype=np.float64) * shaking.time_step
        choices.check_states(self, initial or {})
        if integrator == "lanes":
            lanes = self._part("lanes.run")
            ran = lanes.run(
                wall, shaking, np.array([scale]), tail=max(0.0, end - shaking.duration),
                initial={k: np.array([v]) for k, v in (initial or {}).items()},
                last=np.array([count - 1]), samples=count, log=20_000, may_rest=False,
            )  # fmt: skip
            state = ran.samples
            events = tuple(Event(*event) for event in ran.events[0])
            outputs = {k: float(v[0]) for k, v in lanes.outputs(wall, ran.result).items()}
        else:
            told = self._part("reference").run(wall, shaking, scale, initial=initial, duration=end)
            state = told.state.T[None, :count]
            events, outputs = told.events, dict(told.outputs)
        over = outputs["overturning_time"]
        if over == over:
            fallen = int(np.ceil(over / shaking.time_step - 1e-9))
            state[:, fallen:, :4] = state[:, max(fallen - 1, 0), None, :4]
            for body in (1, 2):
                if outputs[f"overturned_{body}"]:
                    state[:, fallen:, body - 1] = outputs[f"residual_rotation_{body}"]
            state[:, fallen:, 4:] = 0.0
        channels = {name: one[0] for name, one in self._observe(wall, state).items()}
        return History(time, channels, _with_onset(events), outputs)


def _with_onset(events: tuple[Event, ...]) -> tuple[Event, ...]:
    """The first uplift is the onset too."""
    for k, event in enumerate(events):
        if event.kind == "uplift":
            return (*events[:k], Event(event.time, "onset", event.body), *events[k:])
    return events


MODEL = Interface()
