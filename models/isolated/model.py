"""A body or a chain of storeys on rubber bearings as a `Model`: lanes and reference behind one interface."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from models import choices
from models.answers import answers
from models.base import Event, FloatArray, History, Mechanism, Parameter, Quantity, Values
from models.errors import InputError
from models.identification import Identification
from models.isolated import declaration, modes
from models.isolated.assembly import build, complaints
from models.isolated.chain import Chain
from models.isolated.identification import IDENTIFICATION
from models.isolated.observe import observe
from models.mechanisms import acting_on
from models.shaking import Shaking


@dataclass(frozen=True)
class Isolated:
    """A rigid body, or a chain of storeys, on rubber bearings in shear; horizontal shaking only.

    m_j x_j'' = -m_j a - F_j + F_(j+1),  F_1 = bearing(x_1, x_1'),  F_j = k_s (x_j - x_(j-1)) + c_s (x_j' - x_(j-1)'),
    j = 1 ... n from the slab above the bearings, x_j relative to the base, F_(n+1) = 0. The bearings carry the weight
    and never lift; nothing rocks or overturns. Without a force sensor only ratios to the mass are seen.
    """

    name: str = "isolated"
    title: str = "a body or a chain of storeys on rubber bearings in shear"
    version: str = "2"
    parameters: tuple[Parameter, ...] = declaration.PARAMETERS
    alternatives: tuple[tuple[tuple[str, ...], ...], ...] = declaration.ALTERNATIVES
    outputs: tuple[Quantity, ...] = declaration.OUTPUTS
    derived: tuple[Quantity, ...] = declaration.DERIVED
    observables: tuple[Quantity, ...] = declaration.OBSERVABLES
    states: tuple[str, ...] = declaration.STATES
    integrators: tuple[str, ...] = ("lanes", "reference")
    identification: Identification | None = IDENTIFICATION
    takes_vertical: bool = False
    vertical_by_default: bool = False

    @property
    def options(self) -> Mapping[str, tuple[str, ...]]:
        return declaration.OPTIONS

    @property
    def mechanisms(self) -> Mapping[str, Mechanism]:
        return acting_on(self.name)

    def resolve_options(self, options: Mapping[str, str] | None) -> dict[str, str]:
        """Every option with its word, the default where none is given."""
        return choices.resolve_options(self, options)

    def check(self, values: Values, options: Mapping[str, str] | None = None) -> list[str]:
        """What describes no building: levels without a mass, a law without its parameters, and so on."""
        found = complaints(values)
        if not found:
            try:
                build(values, self.resolve_options(options))
            except InputError as error:
                found.append(str(error))
        return found

    def derive(self, values: Values, options: Mapping[str, str] | None = None) -> dict[str, FloatArray]:
        """Mass, natural frequencies and modal damping at small strain, arrays ``(n,)``."""
        return modes.derived(build(values, self.resolve_options(options)))

    def _chain(self, values: Values, options: Mapping[str, str] | None, size: int) -> Chain:
        chain = build(values, self.resolve_options(options), size)
        if chain.size != size:
            raise ValueError(f"values broadcast to {chain.size} lanes, {size} are asked for")
        return chain

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
        chain = self._chain(values, options, scale.size)
        choices.check_integrator(self, integrator)
        found: Mapping[str, FloatArray]
        if integrator == "lanes":
            from models.isolated.lanes import run as lanes

            found = lanes.run(chain, shaking, scale, tail=tail).result
        else:
            from models.isolated import reference

            each = [
                reference.run(chain.take(slice(k, k + 1)), shaking, float(scale[k]), tail=tail).outputs
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
        """Observables ``(n, samples)``, by level ``(n, levels, samples)``, of n chains of one length.

        Each lane runs from its own sample ``first`` and its state by the names of `states`; see `Model.trajectories`.
        """
        from models.isolated.lanes import run as lanes

        n = first.size
        chain = self._chain(values, options, n)
        if np.any(chain.levels != chain.levels[0]):
            raise ValueError("trajectories need chains of one length in a call")
        last = np.minimum(first + samples - 1, shaking.horizontal.size - 1)
        ran = lanes.run(
            chain, shaking, np.broadcast_to(np.asarray(scale, float), (n,)), initial=initial, first=first, last=last,
            samples=samples, may_rest=False,
        )  # fmt: skip
        return observe(chain, ran.samples)

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

        ``duration`` (s) cuts the run or lengthens it beyond the shaking. Channels by level are ``(levels, n_times)``.
        """
        chain = self._chain(values, options, 1)
        choices.check_integrator(self, integrator)
        end = shaking.duration + tail if duration is None else duration
        count = round(end / shaking.time_step) + 1
        time: FloatArray = np.arange(count, dtype=np.float64) * shaking.time_step
        choices.check_states(self, initial or {})
        if integrator == "lanes":
            from models.isolated.lanes import run as lanes

            ran = lanes.run(
                chain, shaking, np.array([scale]), initial={k: np.array([v]) for k, v in (initial or {}).items()},
                last=np.array([count - 1]), samples=count, may_rest=False,
            )  # fmt: skip
            rested = float(ran.result["rest_time"][0])
            events: tuple[Event, ...] = (Event(rested, "rest"),) if rested == rested else ()
            outputs = {q.name: float(ran.result[q.name][0]) for q in self.outputs}
            state = ran.samples
        else:
            from models.isolated import reference

            told = reference.run(chain, shaking, scale, initial=initial, duration=end)
            state, events, outputs = told.samples[None, :count], told.events, told.outputs
        channels = {name: one[0] for name, one in observe(chain, state).items()}
        return History(time, channels, events, outputs)


MODEL = Isolated()
