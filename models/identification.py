"""What calibration and diagnosis need to know of a model, declared beside it as data.

A recording is compared with a model window by window. A window starts from states that were measured, from states that
the model carries there along the measured motion, and from memories of what came before it; what no model of the
library explains is described by forces at the ports of the model. Nothing of this is known to the diagnosis itself:
each model says it in ``models/<name>/identification.py`` (`Model.identification`; None: neither calibrated nor
diagnosed).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np

from models.base import FloatArray, Mechanism, MechanismParameter
from models.observed import Observed

Derived = Mapping[str, FloatArray]
"""Auxiliary constants of a model, by the names of its `derived`."""


@dataclass(frozen=True)
class Lead:
    """A channel that says when a ``body`` moves on its ``joint``: windows begin at its peaks."""

    channel: str
    body: int
    joint: str


@dataclass(frozen=True)
class State:
    """A state that a window starts from.

    ``channel`` measures it, or the coordinate whose rate it is (``rate``; a recorded channel of the state's own
    name is preferred). Without a channel it is latent: no recording holds it, and it is carried along the measured
    motion (`Identification.carrying`). ``at_rest``: its value at rest as a function of the derived constants; None for
    0.
    """

    name: str
    channel: str = ""
    rate: bool = False
    at_rest: Callable[[Derived], FloatArray] | None = None

    @property
    def latent(self) -> bool:
        return not self.channel


@dataclass(frozen=True)
class Largest:
    """Memory ``name``: largest absolute value of a channel before a window, read off the smoothed measurement."""

    name: str
    channel: str


@dataclass(frozen=True)
class Count:
    """Memory ``name``: number of events of a kind before a window, counted along the model.

    The first guess is the number of sign changes of ``channel`` in the measurement.
    """

    name: str
    event: str
    channel: str


NARROWEST = 0.04
"""s, of a filter along which states are carried."""


@dataclass(frozen=True)
class WindowLengths:
    """How a recording is cut, in units of ``unit(derived)`` s (None: in s).

    ``shortest``, ``aim``, ``longest``: length of a window; ``quiet``: time without motion that ends one;
    ``smoothing``: width of the filter that finds the peaks; ``carrying``: of the one that frees the measured motion of
    noise where the model runs along it, `NARROWEST` s at least.
    """

    shortest: float
    aim: float
    longest: float
    quiet: float
    smoothing: float
    carrying: float = 0.0
    unit: Callable[[Derived], FloatArray] | None = None

    def in_seconds(self, derived: Derived) -> WindowLengths:
        """The same in s, for a wall with these constants."""
        if self.unit is None:
            return self
        unit = float(np.min(self.unit(derived)))
        return WindowLengths(
            unit * self.shortest,
            unit * self.aim,
            unit * self.longest,
            unit * self.quiet,
            unit * self.smoothing,
            max(NARROWEST, unit * self.carrying),
        )


@dataclass(frozen=True)
class Stretches:
    """How a model is compared that forgets how it started: it runs from rest through each recording, once.

    Lengths in units of ``unit(derived)`` s, its slowest period. Means over ``mean`` are compared, in stretches of
    ``length`` that are weighed one by one. ``smooth``: deviations of the Gaussian kernels of the model's own error,
    which grows with the motion of a stretch. ``integrals``: channels of displacement and of acceleration that are one
    measurement where the one was integrated from the other; the displacement is compared then.
    """

    unit: Callable[[Derived], FloatArray]
    mean: float
    length: float
    smooth: tuple[float, ...]
    integrals: tuple[tuple[str, str], ...] = ()

    def in_seconds(self, derived: Derived) -> Stretches:
        """The same in s, for a building with these constants."""
        unit = float(np.min(self.unit(derived)))
        smooth = tuple(unit * scale for scale in self.smooth)
        return Stretches(lambda _: np.ones(1), unit * self.mean, unit * self.length, smooth, self.integrals)


@dataclass(frozen=True)
class Motion:
    """The fitted motion along all windows: a coordinate, its rate and the base acceleration, arrays (W, N).

    ``reach``: the largest absolute value of the coordinate inside the windows.
    """

    coordinate: FloatArray
    rate: FloatArray
    base: FloatArray
    reach: float


@dataclass(frozen=True)
class Port:
    """Where a force that a model lacks may act on it.

    ``coordinate``: what the force works along, from the observables of a run; positive to the right. ``jumps``: changes
    of the states' rates (by name) by a unit impulse that resists the coordinate, from the coefficients of one wall and
    the states at that moment, arrays by name; arrays like these, or one number for all moments.
    """

    name: str
    coordinate: Callable[[Mapping[str, FloatArray]], FloatArray]
    jumps: Callable[[Any, Mapping[str, FloatArray]], Mapping[str, float | FloatArray]]


@dataclass(frozen=True)
class Force:
    """A kind of force that a model may lack, acting at a ``port``.

    ``along``: the force over the motion of the port's coordinate, of order one; None for one that acts at the instants
    of ``event`` (see `Separation`), in proportion to the rate before. ``named``: by the dependence, the kind and
    dependence under which the same force is reported. ``signed``: it has a direction and no strength.
    """

    name: str
    meaning: str
    port: Port
    along: Callable[[Motion], FloatArray] | None
    event: str = ""
    named: Mapping[str, tuple[str, str]] = field(default_factory=dict)
    signed: bool = False


@dataclass(frozen=True)
class Dependence:
    """What a force may depend on: ``factor`` (W, N), less its mean where ``about_mean``.

    ``stronger``: words for its lower and its upper end; ``phases``: the phase words of a located interval for
    either end, empty for none.
    """

    name: str
    factor: Callable[[Motion], FloatArray]
    stronger: tuple[str, str]
    phases: tuple[str, str] = ("", "")
    about_mean: bool = False


@dataclass(frozen=True)
class Separation:
    """The event that separates phases of the motion: sign changes of ``signal``; words for at it and between."""

    event: str
    signal: Callable[[Motion], FloatArray]
    between: str


@dataclass(frozen=True)
class Closing:
    """A joint whose events do not repeat exactly: the ``port`` of a couple there, at which its coordinate changes sign.

    ``rate``: of that coordinate, from the rates of the states by name; linear in them.
    """

    port: Port
    rate: Callable[[Mapping[str, FloatArray]], FloatArray]


@dataclass(frozen=True)
class Scatter:
    """Events that do not repeat exactly: the rate after one is random about the law's, by the same share at each joint.

    By an impulse at the joint's port: what it moves besides is moved with it. ``events``: what they are called, in the
    plural.
    """

    events: str
    joints: tuple[Closing, ...]


@dataclass(frozen=True)
class Exposure:
    """What properties of a specimen may have changed with over a sequence of tests.

    ``name``: of the quantity; ``meaning``: what has happened up to the end of a test; ``output``: of a run, the largest
    value so far counts, or where ``summed`` all together. ``of``: the parameters that it may change.
    """

    name: str
    meaning: str
    output: str
    of: tuple[str, ...]
    summed: bool = False


Numbers = Mapping[str, float]
"""Parameters of a model in SI, by name."""


@dataclass(frozen=True)
class Rung:
    """Another base model that recordings may ask for in the place of this one: the next rung of a ladder.

    ``name``: as an effect of an answer, and its class. ``model`` with ``options``: the other model. ``parameters``:
    what this model has no number for, the one that tells most first, each searched in its ``ranges`` for the specimen,
    and from the ``likely`` values of some of them.
    ``carried_over(specimen's parameters, these)``: the parameters of the other model. ``without``: parameters of this
    model that mean nothing to the other. ``recorded``, ``not_recorded``: channels that decide whether this rung is the
    one to try. ``alike``: states of the other model that begin a window as another one does where their channel is not
    recorded; ``bonded``: and stay so. ``refusal``: why a specimen cannot be carried over; empty where it can.
    ``sentence``: what a report prints, with the names of ``parameters`` in braces.
    """

    name: str
    model: str
    equation: str
    sentence: str
    parameters: tuple[MechanismParameter, ...]
    ranges: Callable[[Numbers], Mapping[str, tuple[float, float]]]
    carried_over: Callable[[Numbers, Numbers], dict[str, float]]
    likely: Callable[[Numbers], Mapping[str, float]] = lambda values: {}
    options: Mapping[str, str] = field(default_factory=dict)
    without: tuple[str, ...] = ()
    recorded: tuple[str, ...] = ()
    not_recorded: tuple[str, ...] = ()
    alike: Mapping[str, str] = field(default_factory=dict)
    bonded: bool = False
    refusal: Callable[[Numbers], str] = lambda values: ""

    @property
    def mechanism(self) -> Mechanism:
        """The rung as an effect."""
        return Mechanism(
            self.name, self.name, self.parameters, self.equation, signature="the base model is another one",
            sentence=self.sentence,
        )  # fmt: skip

    def values(self, given: Numbers) -> dict[str, float]:
        """Values of the other model, of those of this one and ``name.parameter``; other mechanisms' stay."""
        mine = f"{self.name}."
        own = {key.removeprefix(mine): value for key, value in given.items() if key.startswith(mine)}
        plain = {key: value for key, value in given.items() if "." not in key}
        rest = {key: value for key, value in given.items() if "." in key and not key.startswith(mine)}
        return {**self.carried_over(plain, own), **rest}


@dataclass(frozen=True)
class Identification:
    """The declaration of one model.

    ``chaotic``: neighbouring trajectories diverge quickly, so that runs from rest show little. ``elastic``: the bodies
    move with every motion of the base, and are still only where it is. ``windows`` None: the
    model runs through whole recordings (``stretches``). ``forces`` empty: laws outside the library are not tested for.
    ``phases``: every phase word in plain English. ``scatter`` None: events are taken to repeat exactly.
    ``most_effects``: how many a search adds at most; ``further_work``: what it may cost, over that of other models.
    ``coordinates``: parameters in whose place a fit within a range works with something that recordings tell better
    (`models.model.Model.declared`), as soon as a mechanism acts. ``whole``: whole-number parameters of mechanisms, with
    the values that are tried.
    ``carrying``: whether the model runs along the measured motion (`models.model.Model.carry`) and gives the latent
    states, and whatever else it remembers, at every window's start. ``not_carried``: what else a window would have to
    inherit; with it, or with a latent state that is not carried, calibration and diagnosis are refused.
    ``same``: channels of parts that move as one here, by the observable that predicts them. ``ladder``: base models
    that may be the right ones where this one is not, in the order in which they are tried. ``exposures``: what may have
    changed the specimen from test to test.
    """

    leads: tuple[Lead, ...]
    states: tuple[State, ...]
    windows: WindowLengths | None
    chaotic: bool
    memories: tuple[Largest | Count, ...] = ()
    forces: tuple[Force, ...] = ()
    dependences: tuple[Dependence, ...] = ()
    separation: Separation | None = None
    scatter: Scatter | None = None
    phases: Mapping[str, str] = field(default_factory=dict)
    coordinates: tuple[str, ...] = ()
    whole: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    carrying: bool = False
    not_carried: tuple[str, ...] = ()
    stretches: Stretches | None = None
    most_effects: int = 3
    further_work: float = 1.0
    same: Mapping[str, str] = field(default_factory=dict)
    ladder: tuple[Rung, ...] = ()
    exposures: tuple[Exposure, ...] = ()
    elastic: bool = False

    def seen(self, observed: Mapping[str, FloatArray]) -> Mapping[str, FloatArray]:
        """The observables of a run, with those that `same` makes of them."""
        alike = Observed({name: partial(observed.__getitem__, of) for name, of in self.same.items()})
        return Observed.joined(observed, alike)

    @property
    def free(self) -> tuple[State, ...]:
        """The states that a recording holds: free in every window."""
        return tuple(state for state in self.states if not state.latent)

    def rest(self, derived: Derived) -> dict[str, float]:
        """Every state at rest."""
        return {s.name: 0.0 if s.at_rest is None else float(s.at_rest(derived).item()) for s in self.states}

    def refusal(self) -> str:
        """Why recordings cannot be compared with this model; empty where they can."""
        if self.stretches is not None:
            return ""
        latent = [state.name for state in self.states if state.latent and not self.carrying]
        lacking = [f"{', '.join(latent)} at the start of a window, which no recording holds"] if latent else []
        return " and ".join([*lacking, *self.not_carried])
