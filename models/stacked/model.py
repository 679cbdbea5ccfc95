"""Two stacked blocks as a `Model`: the compiled lanes and the plain reference behind one interface."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from models import choices
from models.base import Event, FloatArray, History, Mechanism, Parameter, Quantity, Values
from models.shaking import Shaking
from models.stacked import account, declaration
from models.stacked.observe import initial_state, observe, settled_history
from models.stacked.stack import Stack, build

MOST_LOGGED = 50_000
"""Events kept of one history."""


@dataclass(frozen=True)
class Stacked:
    """Two rigid blocks, one on the other, on a rigid base (Psycharis 1990; Spanos, Roussis, Politis 2001).

    Eight configurations and rest; Lagrange's equations of the two-link pendulum in each
    (`models.stacked.equation`); impacts by projection in the kinetic metric (`models.stacked.impact`);
    what follows an impact, an opening or a start from rest by one complementarity condition
    (`models.stacked.choice`). No sliding and no lift-off: ``needed_friction`` tells when that would fail.
    """

    name: str = "stacked"
    title: str = "two stacked rigid blocks on a rigid base"
    version: str = "1"
    parameters: tuple[Parameter, ...] = declaration.PARAMETERS
    alternatives: tuple[tuple[tuple[str, ...], ...], ...] = declaration.ALTERNATIVES
    outputs: tuple[Quantity, ...] = declaration.OUTPUTS
    derived: tuple[Quantity, ...] = declaration.DERIVED
    observables: tuple[Quantity, ...] = declaration.OBSERVABLES
    states: tuple[str, ...] = declaration.STATES
    integrators: tuple[str, ...] = ("lanes", "reference")
    chaotic: bool = True
    takes_vertical: bool = True
    vertical_by_default: bool = False

    @property
    def options(self) -> Mapping[str, tuple[str, ...]]:
        return declaration.OPTIONS

    @property
    def mechanisms(self) -> Mapping[str, Mechanism]:
        from models.mechanisms import acting_on

        return acting_on(self.name)

    def words(self, options: Mapping[str, str] | None) -> dict[str, str]:
        """Every option with its word, the default where none is given."""
        return choices.words(self, options)

    def check(self, values: Values, options: Mapping[str, str] | None = None) -> list[str]:
        """What has no meaning together: a density without thickness, a stack that does not stand by itself."""
        if "wall_density" in values and bool(np.any(np.isnan(values.get("wall_thickness", np.nan)))):
            return ["wall_density gives a mass only with wall_thickness: give both, or wall_mass"]
        stack = build(values, False)
        lean = stack.offset / stack.gravity
        found = []
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
        stack = build(values, False)
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

    def _stack(self, values: Values, shaking: Shaking, size: int) -> Stack:
        stack = build(values, shaking.vertical is not None and shaking.vertical_acts, size)
        if stack.size != size:
            raise ValueError(f"values broadcast to {stack.size} lanes, {size} are asked for")
        return stack

    def _linear(self, integrator: str, options: Mapping[str, str] | None) -> bool:
        """Whether the formulation is linear, after checking the words."""
        choices.check_integrator(self, integrator)
        return self.words(options)["formulation"] == "linear"

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
        stack = self._stack(values, shaking, scale.size)
        linear = self._linear(integrator, options)
        if integrator == "lanes":
            from models.stacked.lanes import run as lanes

            table = lanes.run(stack, shaking, scale, tail=tail, linear=linear).account
        else:
            from models.stacked import reference

            each = [
                reference.run(stack.take([k]), shaking, float(scale[k]), tail=tail, linear=linear).account
                for k in range(scale.size)
            ]
            table = np.array(each)
        found = account.outputs(stack, table)
        return {name: found[name] for name in outputs}

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

        ``initial`` holds arrays ``(n,)`` by the names of `states`.
        """
        from models.stacked.lanes import run as lanes

        n = first.size
        stack = self._stack(values, shaking, n)
        ran = lanes.run(
            stack, shaking, np.broadcast_to(np.asarray(scale, float), (n,)), linear=self._linear("lanes", options),
            initial=initial_state(initial, n), first=first,
            last=np.minimum(first + samples - 1, shaking.horizontal.size - 1), samples=samples, fall=True,
        )  # fmt: skip
        assert ran.trace is not None
        return observe(stack, settled_history(ran.trace, ran.account))

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

        ``initial`` by the names of `states`; a rotation_2 not given equals rotation_1 (seated).
        ``duration`` (s) cuts the run or lengthens it beyond the shaking; a run that overturns goes on
        to pi/2 and its channels stay there.
        """
        stack = self._stack(values, shaking, 1)
        linear = self._linear(integrator, options)
        quiet = tail if duration is None else max(0.0, duration - shaking.duration)
        end = shaking.duration + quiet if duration is None else duration
        count = round(end / shaking.time_step) + 1
        choices.check_states(self, initial or {})
        start = initial_state(initial or {}, 1)
        if integrator == "lanes":
            from models.stacked.lanes import run as lanes

            last = None if duration is None or quiet else np.array([count - 1])
            ran = lanes.run(
                stack, shaking, np.array([scale]), tail=quiet, linear=linear, initial=start, last=last,
                samples=count, log=MOST_LOGGED, fall=True,
            )  # fmt: skip
            assert ran.trace is not None and ran.events is not None
            table, trace, events = ran.account, ran.trace, ran.events[0]
        else:
            from models.stacked import reference

            found = reference.run(
                stack, shaking, scale, linear=linear, duration=end, follow=True,
                initial={name: float(value[0]) for name, value in start.items()},
            )  # fmt: skip
            table, trace, events = found.account[None], found.history.T[None, :count], found.events
        channels = observe(stack, settled_history(trace, table))
        outputs = {name: float(value[0]) for name, value in account.outputs(stack, table).items()}
        kept: tuple[Event, ...] = tuple(event for event in events if event.time <= end)
        time = np.arange(count, dtype=np.float64) * shaking.time_step
        return History(time, {name: c[0] for name, c in channels.items()}, kept, outputs)


MODEL = Stacked()
"""What `models.get` returns."""
