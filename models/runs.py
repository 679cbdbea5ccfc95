"""What an integrator is asked, and what it returns."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from models.base import Event, FloatArray
from models.shaking import Shaking, Shakings

Index = NDArray[np.int64]


@dataclass(frozen=True)
class Request:
    """Runs of n lanes under ``scale`` (n,) times the shaking, the formulation chosen by ``options``.

    Outputs alone (``samples`` = 0): from the start of the shaking, then ``tail`` (s) of free motion at most.
    Histories: ``samples`` states of every lane at the time step of the shaking, from sample ``first`` (n,) to
    ``last`` (n,; default: from the start to the end of the tail), through rest and overturning.
    ``initial``: arrays (n,) by the names of the model's states; what is left out is as at rest.
    ``log``: most events kept of a lane. ``bare``: only the motion is asked for; outputs that cost more may be left out.
    ``motions``: of bare histories of lanes under motions of their own, of which ``shaking`` is one; None: all are
    under ``shaking``.
    ``step``: that of the kernel (s), of models that have `steps_chosen`; None: by their own rule.
    """

    shaking: Shaking
    scale: FloatArray
    options: Mapping[str, str] = field(default_factory=dict)
    tail: float = 0.0
    initial: Mapping[str, FloatArray] = field(default_factory=dict)
    first: Index | None = None
    last: Index | None = None
    samples: int = 0
    log: int = 0
    bare: bool = False
    motions: Shakings | None = None
    step: float | None = None

    @property
    def history(self) -> bool:
        """Whether the motion itself is asked for, not only its outputs."""
        return self.samples > 0

    @property
    def linear(self) -> bool:
        """Whether the formulation asked for is the linear one, in models that have both."""
        return self.options.get("formulation") == "linear"

    @property
    def until(self) -> float:
        """End (s) of a request of one lane that starts with the shaking."""
        if self.last is None:
            return self.shaking.duration + self.tail
        return float(self.last[0]) * self.shaking.time_step

    @property
    def times(self) -> FloatArray:
        """Samples (s) from the start of the shaking to the end of a request that starts with it."""
        step = self.shaking.time_step
        return step * np.arange(round(self.until / step) + 1, dtype=np.float64)

    @property
    def shakings(self) -> Shakings:
        """The motion of every lane."""
        return self.motions or Shakings.over(self.shaking, self.scale.size)

    def steps(self, per_sample: int, end: int, begins: Index) -> tuple[Index, Index]:
        """First and last step (n,) of every lane at ``per_sample`` steps a sample, ``end`` that of the tail.

        ``begins`` (n,): the step of the record at which the motion of each lane begins.
        """
        n = self.scale.size
        first = np.zeros(n, np.int64) if self.first is None else self.first * per_sample
        last = np.full(n, end) if self.last is None else self.last * per_sample
        return first + begins, last + begins

    def take(self, lanes: Any) -> Request:
        """The request for the lanes of an index array, slice or mask."""
        return replace(
            self,
            scale=self.scale[lanes],
            initial={name: values[lanes] for name, values in self.initial.items()},
            first=None if self.first is None else self.first[lanes],
            last=None if self.last is None else self.last[lanes],
            motions=None if self.motions is None else self.motions.take(lanes),
        )

    @property
    def start(self) -> dict[str, float]:
        """``initial`` of a request of one lane."""
        return {name: float(values[0]) for name, values in self.initial.items()}


def by_lane(values: Any, lanes: int) -> FloatArray:
    """Numbers of all lanes alike (a scalar) or of each (lanes, ...)."""
    array = np.asarray(values, dtype=np.float64)
    return array if array.ndim > 1 else np.broadcast_to(array, (lanes,))


@dataclass
class Work:
    """What this process has asked of the kernels: lane-steps, and how long all of it takes a typical core (s).

    Counted, not clocked: it does not depend on the machine.
    """

    steps: int = 0
    seconds: float = 0.0

    def call(self, steps: int, seconds: float) -> None:
        """One call of a kernel, of so many lane-steps, that takes so long."""
        self.steps += steps
        self.seconds += seconds


DONE = Work()


@dataclass(frozen=True)
class Prescribed:
    """A measured motion that n lanes run along: states (r, m) by name, of each lane from sample ``first`` (n,) on.

    ``marks`` (k,), counted from there and in order: samples at which the other states are asked for. ``row`` (n,): the
    motion that each lane follows (default: its own, or the only one); ``last`` (n,): the last mark that it needs.
    """

    motion: Mapping[str, FloatArray]
    marks: Index
    first: Index
    row: Index = field(default_factory=lambda: np.zeros(0, np.int64))
    last: Index = field(default_factory=lambda: np.zeros(0, np.int64))

    @property
    def rows(self) -> Index:
        """The row of each lane (n,)."""
        if self.row.size:
            return self.row
        rows = len(next(iter(self.motion.values()), ()))
        return np.arange(self.first.size) if rows > 1 else np.zeros(self.first.size, np.int64)

    @property
    def ends(self) -> Index:
        """The last mark of each lane (n,)."""
        return self.last if self.last.size else np.full(self.first.size, self.marks[-1])

    def held(self, states: Sequence[str]) -> tuple[Index, FloatArray]:
        """Places of the prescribed ones among the model's ``states`` (h,), and the motion (r, m, h) in that order."""
        places = np.array([k for k, name in enumerate(states) if name in self.motion], np.int64)
        return places, np.stack([self.motion[states[k]] for k in places], axis=-1)

    def take(self, lanes: Index) -> Prescribed:
        """That of some lanes."""
        return replace(self, first=self.first[lanes], row=self.rows[lanes], last=self.ends[lanes])


@dataclass(frozen=True)
class Run:
    """Outputs ``(n,)`` by name, states ``(n, samples, k)`` as the model orders them, and events lane by lane.

    ``steps``: lane-steps that a kernel has computed; those that take longer than most count as several.
    """

    outputs: Mapping[str, NDArray[Any]]
    samples: FloatArray
    events: tuple[tuple[Event, ...], ...] = ()
    steps: int = 0

    @classmethod
    def of_one(cls, outputs: Mapping[str, float], samples: FloatArray, events: Sequence[Event]) -> Run:
        """From what a reference returns of its one lane: outputs, states ``(samples, k)``, events."""
        return cls({name: np.array([value]) for name, value in outputs.items()}, samples[None], (tuple(events),))

    @classmethod
    def joined(cls, runs: Sequence[Run]) -> Run:
        """Several runs as one, in their order."""
        return cls(
            {name: np.concatenate([run.outputs[name] for run in runs]) for name in runs[0].outputs},
            np.concatenate([run.samples for run in runs]),
            tuple(events for run in runs for events in run.events),
        )
