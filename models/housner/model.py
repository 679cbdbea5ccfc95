"""One rocking block as a `Model`: the three integrators behind one interface."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from models import choices
from models.base import Event, FloatArray, History, Mechanism, Parameter, Quantity, Values
from models.errors import InputError
from models.housner import declaration
from models.housner.block import Block, build
from models.shaking import Shaking

Initial = Mapping[str, float]


@dataclass(frozen=True)
class Housner:
    """Housner's rigid block on a rigid base (Bull. Seism. Soc. Am. 53, 1963), alone or with a mass on top.

    theta'' = -p^2 [ (G/g) sin(alpha s - theta) + (a/g) cos(alpha s - theta) ],  G = g + a_z,
    p^2 = M g R/I_O, s = sign(theta); rocking starts when |a| > G tan(alpha); an impact multiplies
    theta' by e. No sliding and no lift-off: ``needed_friction`` tells when that would fail.
    """

    name: str = "housner"
    title: str = "one rigid block on a rigid base"
    version: str = "1"
    parameters: tuple[Parameter, ...] = declaration.PARAMETERS
    alternatives: tuple[tuple[tuple[str, ...], ...], ...] = declaration.ALTERNATIVES
    outputs: tuple[Quantity, ...] = declaration.OUTPUTS
    derived: tuple[Quantity, ...] = declaration.DERIVED
    observables: tuple[Quantity, ...] = declaration.OBSERVABLES
    states: tuple[str, ...] = declaration.STATES
    integrators: tuple[str, ...] = ("lanes", "reference", "newmark")
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
        """What has no meaning together: no mass at all, impacts after which the block does not rock, mechanisms
        that do not act together."""
        block = build(values, False)
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
        block = build(values, False)
        given = block.restitution
        e = np.where(np.isnan(given), block.momentum_restitution, given) * block.restitution_factor
        return {
            "alpha": block.slenderness,
            "radius": block.radius,
            "frequency_parameter": block.frequency_parameter,
            "restitution_coefficient": e,
            "onset_acceleration": block.gravity * np.tan(block.slenderness),
        }

    def _block(self, values: Values, shaking: Shaking, size: int) -> Block:
        if shaking.vertical is None and np.any(values.get("vertical_acceleration.kappa", 0.0)):
            raise InputError(
                "vertical_acceleration.kappa needs the vertical motion of the base: give a motion that has one"
            )
        block = build(values, shaking.vertical is not None and shaking.vertical_acts, size)
        if block.size != size:
            raise ValueError(f"values broadcast to {block.size} lanes, {size} are asked for")
        for sentence in block.clashes():
            raise InputError(sentence)
        return block

    def _integrator(self, integrator: str, block: Block, options: Mapping[str, str] | None) -> bool:
        """Whether the formulation is linear, after checking that integrator and options go together."""
        choices.check_integrator(self, integrator)
        linear = self.words(options)["formulation"] == "linear"
        if not block.plain and (linear or integrator == "newmark"):
            which = "the linear formulation" if linear else "the integrator newmark"
            raise InputError(
                f"{which} knows only mechanisms that change pivots, gravity, the base motion or the impact; "
                "use the nonlinear formulation with lanes or reference for the others"
            )
        return linear

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
        block = self._block(values, shaking, scale.size)
        linear = self._integrator(integrator, block, options)
        if integrator == "lanes":
            from models.housner.lanes import run as lanes

            found = lanes.outputs(block, lanes.run(block, shaking, scale, tail=tail, linear=linear).result)
        elif integrator == "newmark":
            from models.housner import newmark

            found = dict(newmark.run(block, shaking, scale, tail=tail, linear=linear).outputs)
        else:
            from models.housner import reference

            each = [
                reference.run(block.take(slice(k, k + 1)), shaking, float(scale[k]), tail=tail, linear=linear).outputs
                for k in range(scale.size)
            ]
            kinds = {q.name: np.dtype(q.dtype) for q in self.outputs}
            found = {name: np.array([one[name] for one in each]).astype(kinds[name]) for name in kinds}
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

        ``initial`` holds arrays ``(n,)`` by the names of `states`, and for laws with a memory
        ``peak_rotation_1`` (rad) and ``impacts``, what happened before the window.
        """
        from models.housner.lanes import run as lanes

        n = first.size
        block = self._block(values, shaking, n)
        linear = self._integrator("lanes", block, options)
        last = np.minimum(first + samples - 1, shaking.horizontal.size - 1)
        ran = lanes.run(
            block, shaking, np.broadcast_to(np.asarray(scale, float), (n,)), linear=linear, initial=initial,
            first=first, last=last, samples=samples, fall=True,
        )  # fmt: skip
        assert ran.rotation is not None and ran.rate is not None
        return self.observe(block, ran.rotation, ran.rate, ran.shift)

    def observe(
        self, block: Block, rotation: FloatArray, rate: FloatArray, shift: FloatArray | None = None
    ) -> dict[str, FloatArray]:
        """The observables of rotations and rates; the first axis is that of the block's lanes.

        ``shift`` (m) is what sliding, bouncing or bending adds to the mass centre's displacement.
        """
        shape = (-1,) + (1,) * (rotation.ndim - 1)
        rho = block.corner_radius.reshape(shape)
        h = block.height.reshape(shape) - rho
        b = np.where(rotation >= 0.0, block.right.reshape(shape), block.left.reshape(shape)) - rho
        across = h * np.sin(rotation) + rho * rotation + np.sign(rotation) * b * (1.0 - np.cos(rotation))
        if shift is not None:
            across = across + shift
        return {
            "rotation_1": rotation,
            "rotation_rate_1": rate,
            "displacement_1_x": across,
            "contact_1": ((rotation == 0.0) & (rate == 0.0)).astype(float),
        }

    def simulate(
        self,
        values: Values,
        shaking: Shaking,
        *,
        scale: float = 1.0,
        initial: Initial | None = None,
        duration: float | None = None,
        tail: float = 0.0,
        options: Mapping[str, str] | None = None,
        integrator: str = "lanes",
    ) -> History:
        """One run with its history at the samples of the shaking and of its quiet tail.

        ``duration`` (s) cuts the run or lengthens it beyond the shaking; a run that overturns goes on
        to pi/2 and its channels stay there.
        """
        block = self._block(values, shaking, 1)
        linear = self._integrator(integrator, block, options)
        quiet = tail if duration is None else max(0.0, duration - shaking.duration)
        end = shaking.duration + quiet if duration is None else duration
        count = round(end / shaking.time_step) + 1
        time: FloatArray = np.arange(count, dtype=np.float64) * shaking.time_step
        start = dict(initial or {})
        choices.check_states(self, start)
        if integrator == "lanes":
            from models.housner.lanes import run as lanes

            ran = lanes.run(
                block, shaking, np.array([scale]), tail=quiet, linear=linear,
                initial={k: np.array([v]) for k, v in start.items()},
                samples=count, log=20_000, fall=True,
            )  # fmt: skip
            assert ran.rotation is not None and ran.rate is not None and ran.events is not None
            rotation, rate, shift = ran.rotation[0], ran.rate[0], ran.shift
            events = tuple(Event(t, kind) for t, kind in ran.events[0] if t <= end)
            outputs = {k: float(v[0]) for k, v in lanes.outputs(block, ran.result).items()}
        elif integrator == "reference":
            from models.housner import reference

            told = reference.run(
                block, shaking, scale, tail=quiet, linear=linear, initial=start, duration=end, follow=True
            )
            rotation, rate = told.rotation[:count].copy(), told.rate[:count].copy()
            shift = told.shift[None, :count]
            events, outputs = told.events, dict(told.outputs)
        else:
            from models.housner import newmark

            many = newmark.run(
                block, shaking, np.array([scale]), tail=quiet, linear=linear, initial=start, duration=end, follow=True
            )
            rotation, rate, shift = many.rotation[0, :count].copy(), many.rate[0, :count].copy(), None
            events, outputs = many.events[0], {k: float(v[0]) for k, v in many.outputs.items()}
        over = outputs["overturning_time"]
        if over == over:
            beyond = np.flatnonzero(np.abs(rotation) >= np.pi / 2)
            fallen = beyond[0] if beyond.size else count
            if beyond.size == 0:
                largest = int(np.argmax(np.abs(rotation)))
                fallen = largest + 1
            sign = np.sign(outputs["residual_rotation"])
            rotation[fallen:], rate[fallen:] = sign * np.pi / 2, 0.0
        channels = {name: one[0] for name, one in self.observe(block, rotation[None], rate[None], shift).items()}
        return History(time, channels, events, outputs)


MODEL = Housner()
