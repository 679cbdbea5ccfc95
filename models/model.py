"""The one base of all models: what is the same for each of them stands here, once."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from typing import Any, Generic, Protocol

import numpy as np
from numpy.typing import NDArray
from typing_extensions import TypeVar  # typing has no default of a parameter before Python 3.13

from models.answers import among, answers, unanswered
from models.base import FloatArray, History, Mechanism, Parameter, Quantity, Values
from models.errors import InputError, nearest
from models.identification import Identification
from models.mechanisms import acting_on, applied
from models.peaks import peaks
from models.placing import Placing
from models.runs import DONE, Prescribed, Request, Run, by_lane
from models.shaking import Shaking, Shakings
from models.stepping import Stepping

MOST_LOGGED = 50_000
"""Events kept of one history."""


class Coefficients(Protocol):
    """What every integrator of a model starts from: geometry, inertia and laws of n lanes."""

    @property
    def size(self) -> int: ...

    def take(self, index: Any) -> Any: ...


C = TypeVar("C", bound=Coefficients, default=Any)


class Model(Placing, Stepping, ABC, Generic[C]):
    """A model of a wall: its declarations, its coefficients ``C`` and its integrators.

    Arrays broadcast; nothing here knows labels, files or dask. A model gives `assemble`, `run_lanes`,
    `run_reference`, `observe` and `derive`; everything else is the same for all, but where a model says more.

    ``alternatives``: tuples of parameter sets of which exactly one must be given, for instance
    ``(("width", "height"), ("height", "aspect_ratio"))``.
    ``options``: words that choose a formulation, with their values, the default first.
    ``states``: what a run starts from, by name. ``identification``: what diagnosis needs to know; None: not offered.
    ``resumes_with``: mechanisms with which the states of `resume` are all that a run remembers, so that it can be cut
    at an instant (`models.piecewise`); None: it never can.
    ``takes_vertical``: whether a vertical motion of the base enters the equations; ``vertical_by_default``:
    whether it does where a specimen does not say.
    ``call_time``: what a diagnosis takes for a call of the kernel beside its lane-steps, in s of a typical core.
    """

    name: str
    title: str
    version: str
    parameters: tuple[Parameter, ...]
    alternatives: tuple[tuple[tuple[str, ...], ...], ...]
    options: Mapping[str, tuple[str, ...]]
    outputs: tuple[Quantity, ...]
    derived: tuple[Quantity, ...]
    observables: tuple[Quantity, ...]
    states: tuple[str, ...]
    integrators: tuple[str, ...] = ("lanes", "reference")
    identification: Identification | None = None
    resumes_with: tuple[str, ...] | None = None
    takes_vertical: bool = True
    vertical_by_default: bool = False
    call_time: float = 7e-3

    # --- what a model gives

    @abstractmethod
    def assemble(self, values: Values, options: Mapping[str, str], *, vertical: bool, size: int) -> C:
        """The coefficients of ``size`` lanes from the model's own parameters, without mechanisms.

        ``vertical``: whether the vertical motion of the base acts.
        """

    @abstractmethod
    def run_lanes(self, coefficients: C, request: Request) -> Run:
        """All lanes by the compiled kernel."""

    @abstractmethod
    def run_reference(self, coefficients: C, request: Request) -> Run:
        """One lane by the slow plain route."""

    @abstractmethod
    def observe(self, coefficients: C, samples: FloatArray) -> Mapping[str, FloatArray]:
        """The observables ``(n, samples)`` of states ``(n, samples, k)`` as the integrators return them."""

    @abstractmethod
    def derive(self, values: Values, options: Mapping[str, str] | None = None) -> dict[str, FloatArray]:
        """Auxiliary constants (alpha, R, p ...) under ``options``, arrays ``(n,)`` by the names of `derived`."""

    def complete(self, coefficients: C, options: Mapping[str, str]) -> C:
        """The coefficients once every mechanism has acted: with the rubber laws that ``options`` name.

        Raises InputError for what does not go together; default: as they are.
        """
        return coefficients

    def check(self, values: Values, options: Mapping[str, str] | None = None) -> list[str]:
        """Sentences about values that have no meaning together under ``options`` (e <= 0); empty: fine.

        Default: why there are no coefficients, or why not one lane can stand.
        """
        try:
            return self.refused(self.build(values, options))
        except InputError as error:
            return [str(error)]

    def cannot_stand(self, coefficients: C) -> Sequence[tuple[NDArray[np.bool_], str]]:
        """Lanes (n,) without a state of rest under their own load, by why, with a sentence about the worst of each.

        Default: all stand.
        """
        return []

    def refused(self, coefficients: C) -> list[str]:
        """Why not one lane can stand; empty where one can."""
        found = self.cannot_stand(coefficients)
        return [said for unable, said in found if np.any(unable)] if np.all(_any_of(found)) else []

    def run(self, integrator: str, coefficients: C, request: Request) -> Run:
        """All lanes by the integrator of that name; what cannot stand is not_converged, all else of it nan."""
        unable = _any_of(self.cannot_stand(coefficients))
        if not np.any(unable):
            return self._integrated(integrator, coefficients, request)
        outputs = [quantity for quantity in self.outputs if not quantity.peak_of]
        able = np.flatnonzero(~unable)
        if not able.size:
            return unanswered(outputs, unable.size, request.samples, len(self.states))
        found = self._integrated(integrator, coefficients.take(able), request.take(able))
        return among(outputs, unable.size, able, found)

    def _integrated(self, integrator: str, coefficients: C, request: Request) -> Run:
        if integrator == "lanes":
            found = self.run_lanes(coefficients, request)
            DONE.call(found.steps, self.call_time + found.steps * self.step_time(coefficients))
            return found
        lanes = [slice(k, k + 1) for k in range(coefficients.size)]
        return Run.joined([self.run_reference(coefficients.take(k), request.take(k)) for k in lanes])

    def step_time(self, coefficients: C) -> float:
        """What a lane-step of the kernel takes a typical core (s), with what a diagnosis makes of its samples."""
        return 2e-7

    def settle(self, run: Run, time_step: float) -> FloatArray:
        """States of a history in which what has overturned stays where it lies; default: as computed."""
        return run.samples

    def resume(
        self, states: FloatArray, outputs: Mapping[str, NDArray[Any]], initial: Mapping[str, FloatArray]
    ) -> dict[str, FloatArray]:
        """What a run goes on from, arrays (n,) as for ``initial``: states (n, k) as the integrators return them.

        ``outputs`` and ``initial``: of the run that ends there; default: `states` in their order, nothing of a model
        that no run goes on in (`resumes_with`).
        """
        return {} if self.resumes_with is None else dict(zip(self.states, states.T, strict=True))

    # --- the same for all

    @property
    def mechanisms(self) -> Mapping[str, Mechanism]:
        """The mechanisms that can act on this model, by name."""
        return acting_on(self.name)

    def resolve_options(self, options: Mapping[str, str] | None) -> dict[str, str]:
        """Every option with its word, the default where ``options`` gives none; raises InputError."""
        chosen = {name: known[0] for name, known in self.options.items()}
        for name, word in (options or {}).items():
            if name not in chosen:
                raise InputError(f"{self.name} has no option '{name}'; {nearest(name, chosen)}")
            if word not in self.options[name]:
                raise InputError(f"{name} is '{word}'; {nearest(word, self.options[name])}")
            chosen[name] = word
        return chosen

    def build(
        self, values: Values, options: Mapping[str, str] | None = None, *, vertical: bool = False, size: int = 1
    ) -> C:
        """The coefficients with the mechanisms that ``values`` switch on (as ``mechanism.parameter``).

        ``values`` and ``size`` broadcast to the lanes; ``vertical``: whether that motion acts. Raises InputError, for
        names that the model does not have too.
        """
        plain, known = {k: value for k, value in values.items() if "." not in k}, [p.name for p in self.parameters]
        for name in (name for name in plain if name not in known):
            raise InputError(f"{self.name} has no parameter '{name}'; {nearest(name, known)}")
        lanes = int(np.prod(np.broadcast_shapes(*(np.shape(value) for value in values.values()), (size,))))
        chosen = self.resolve_options(options)
        found = applied(self.name, self.assemble(plain, chosen, vertical=vertical, size=lanes), values)
        return self.complete(found, chosen)

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
        """Run one lane per element of ``scale`` (n,), which multiplies the shaking; outputs ``(n,)`` by name.

        ``tail``: free motion after the record, at most, in s. Flags are int8, 0 or 1; where ``status`` is one of
        `UNANSWERED`, every other output is nan, or `MISSING` for whole numbers and flags.
        """
        scale = np.atleast_1d(np.asarray(scale, dtype=np.float64))
        coefficients = self._shaken(values, options, shaking, scale.size, integrator)
        request = Request(shaking.lines, scale, self.resolve_options(options), tail=tail)
        found = dict(self.run(integrator, coefficients, request).outputs)
        if wanted := [quantity for quantity in self.outputs if quantity.peak_of and quantity.name in outputs]:

            def observed(lanes: slice, part: Request) -> Mapping[str, FloatArray]:
                some = coefficients.take(lanes)
                return self.observe(some, self.run(integrator, some, part).samples)

            found |= peaks(observed, request, wanted, found.get("overturning_time", np.full(scale.size, np.nan)))
        return answers(self.outputs, found, outputs)

    def trajectories(
        self,
        values: Values,
        shaking: Shaking | Shakings,
        *,
        first: NDArray[np.int64],
        samples: int | NDArray[np.int64],
        initial: Mapping[str, FloatArray],
        options: Mapping[str, str] | None = None,
    ) -> Mapping[str, FloatArray]:
        """Observables ``(n, samples)`` of n lanes, lane k from sample ``first[k]`` of its shaking and its own state.

        ``samples`` (n,): how many of each lane are wanted, as many columns as of the longest; meaningless behind them.
        ``initial``: arrays ``(n,)`` by the names of `states`, and of what laws with a memory need, ``(n, ...)``.
        """
        steps = np.broadcast_to(np.asarray(samples) - 1, first.shape)
        return self.follow(values, shaking, first=first, steps=steps, initial=initial, options=options)[0]

    def follow(
        self,
        values: Values,
        shaking: Shaking | Shakings,
        *,
        first: NDArray[np.int64],
        steps: NDArray[np.int64],
        initial: Mapping[str, FloatArray],
        options: Mapping[str, str] | None = None,
    ) -> tuple[Mapping[str, FloatArray], dict[str, FloatArray]]:
        """As `trajectories`, lane k over ``steps[k]`` samples, and what each lane would go on from (`resume`)."""
        n, shakings = first.size, Shakings.over(shaking, first.size).lines
        coefficients = self._shaken(values, options, shakings.first, n, "lanes")
        last = np.minimum(first + steps, shakings.ends)
        request = Request(
            shakings.first, np.ones(n), self.resolve_options(options), first=first, last=last,
            samples=int(np.max(steps)) + 1, initial={name: by_lane(v, n) for name, v in initial.items()},
            bare=True, motions=shakings,
        )  # fmt: skip
        run = self.run("lanes", coefficients, request)
        after = self.resume(run.samples[np.arange(n), last - first], run.outputs, request.initial)
        return self.with_poses(self.observe(coefficients, run.samples), coefficients, run.samples), after

    def carry(
        self,
        values: Values,
        shaking: Shaking | Shakings,
        along: Prescribed,
        *,
        initial: Mapping[str, FloatArray] | None = None,
        options: Mapping[str, str] | None = None,
    ) -> dict[str, FloatArray]:
        """What ``initial`` of `trajectories` needs beside the motion ``along``, arrays ``(n, k, ...)`` at its marks.

        Each lane runs from its sample of its own shaking, or of that of all, at rest or from ``initial``; nan of walls
        that cannot stand.
        """
        n = along.first.size
        shakings = Shakings.over(shaking, n).lines
        coefficients = self._shaken(values, options, shakings.first, n, "lanes")
        given = {name: by_lane(v, n) for name, v in (initial or {}).items()}
        unable = _any_of(self.cannot_stand(coefficients))
        if not np.any(unable):
            return self.carry_lanes(coefficients, shakings, along, given)
        if not (able := np.flatnonzero(~unable)).size:
            return {}
        given, own = {name: x[able] for name, x in given.items()}, shakings.take(able)
        found = self.carry_lanes(coefficients.take(able), own, along.take(able), given)
        whole = {name: np.full((n, *x.shape[1:]), np.nan) for name, x in found.items()}
        for name, x in found.items():
            whole[name][able] = x
        return whole

    def points(self, values: Values) -> Mapping[str, int]:
        """How many points (levels) each observable has that is predicted at several; default: none is."""
        return {}

    def declared(
        self, values: Values, names: Sequence[str], options: Mapping[str, str] | None = None
    ) -> Mapping[str, FloatArray]:
        """Parameters (n,) of those ``names`` that ``values`` give as what a fit works with instead.

        Such names stand in `Identification.coordinates`; default: there are none.
        """
        return {}

    def carry_lanes(
        self, coefficients: C, shakings: Shakings, along: Prescribed, initial: Mapping[str, FloatArray]
    ) -> dict[str, FloatArray]:
        """`carry` of walls that all stand, each under its own shaking; default: nothing has to be carried."""
        return {}

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

        ``initial`` by the names of `states`. ``duration`` (s) cuts the run or lengthens it beyond the shaking.
        The channels of what overturns stay where it lies.
        """
        for name in initial or {}:
            if name not in self.states:
                raise InputError(f"[initial] has no state '{name}'; {nearest(name, self.states)}")
        last = round((shaking.duration + tail if duration is None else duration) / shaking.time_step)
        given = {name: np.array([value], dtype=np.float64) for name, value in (initial or {}).items()}
        return self.simulate_from(
            values, shaking, initial=given, samples=last, scale=scale, options=options, integrator=integrator
        )[0]

    def simulate_from(
        self,
        values: Values,
        shaking: Shaking,
        *,
        initial: Mapping[str, FloatArray],
        samples: int,
        scale: float,
        options: Mapping[str, str] | None,
        integrator: str,
    ) -> tuple[History, dict[str, FloatArray]]:
        """A history of so many ``samples`` after the first, and what it would go on from (`resume`)."""
        coefficients = self._shaken(values, options, shaking, 1, integrator)
        for sentence in self.refused(coefficients):
            raise InputError(sentence)
        step = shaking.time_step
        request = Request(
            shaking.lines, np.array([scale], dtype=np.float64), self.resolve_options(options),
            tail=max(0.0, samples * step - shaking.duration), initial=initial, last=np.array([samples]),
            samples=samples + 1, log=MOST_LOGGED,
        )  # fmt: skip
        run = self.run(integrator, coefficients, request)
        settled = self.settle(run, step)
        channels = dict(self.with_poses(self.observe(coefficients, settled), coefficients, settled))
        wanted = [quantity for quantity in self.outputs if quantity.peak_of]
        found = dict(run.outputs)
        found |= peaks(lambda *_: channels, request, wanted, found.get("overturning_time", np.full(1, np.nan)))
        given = answers(self.outputs, found, [quantity.name for quantity in self.outputs])
        history = History(
            step * np.arange(samples + 1, dtype=np.float64),
            {name: one[0] for name, one in channels.items()},
            run.events[0],
            {name: float(value[0]) for name, value in given.items()},
        )
        return history, self.resume(run.samples[:, samples], run.outputs, initial)

    def _shaken(
        self, values: Values, options: Mapping[str, str] | None, shaking: Shaking, size: int, integrator: str
    ) -> C:
        """The coefficients of ``size`` lanes under ``shaking``, after checking what was asked; raises InputError."""
        if integrator not in self.integrators:
            raise InputError(f"integrator is '{integrator}'; {nearest(integrator, self.integrators)}")
        if shaking.vertical is None and np.any(values.get("vertical_acceleration.kappa", 0.0)):
            raise InputError(
                "vertical_acceleration.kappa needs the vertical motion of the base: give a motion that has one"
            )
        acts = shaking.vertical is not None and shaking.vertical_acts
        coefficients = self.build(values, options, vertical=acts, size=size)
        if coefficients.size != size:
            raise ValueError(f"values broadcast to {coefficients.size} lanes, {size} are asked for")
        return coefficients


def _any_of(found: Sequence[tuple[NDArray[np.bool_], str]]) -> NDArray[np.bool_]:
    """Lanes (n,) that any of the reasons holds for; one False without reasons."""
    return np.any([unable for unable, _ in found], axis=0) if found else np.zeros(1, np.bool_)
