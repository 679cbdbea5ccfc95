"""What a diagnosis says: small frozen objects, written as ``diagnosis.json``."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from diagnosis.errors.summary import ErrorModel
from diagnosis.fit.intervals import Estimate
from diagnosis.forces.constancy import Constancy
from models.base import FloatArray

Verdict = Literal["missing", "nothing_missing", "not_in_library", "cannot_tell_apart"]


@dataclass(frozen=True)
class EffectStage:
    """From when to when (s) an effect acts in a recording learned from; ``ends`` inf: to its end; both equal: never.

    ``begins_low95`` and so on: the 95 % interval of an instant within the recording; None of the recording's own ends.
    """

    recording: str
    begins: float
    ends: float
    begins_low95: float | None = None
    begins_high95: float | None = None
    ends_low95: float | None = None
    ends_high95: float | None = None


@dataclass(frozen=True)
class HeldStage:
    """From when to when (s) an effect with stages acts in the prediction of a recording held out.

    As after the last recording learned from, or, of one that came and went or changed between recordings
    (``found_there``), where the recording held out asks for it itself.
    """

    effect: str
    recording: str
    begins: float
    ends: float
    found_there: bool


@dataclass(frozen=True)
class Effect:
    """A mechanism that the recordings ask for.

    ``evidence``: its gain in 2 log likelihood, refitted; ``p_value``: chance of it, LEAST_P for at most that;
    ``stages`` by recording in the order of the tests: when it acts, none for always.
    """

    name: str
    effect_class: str
    parameters: Mapping[str, Estimate]
    evidence: float
    p_value: float
    stages: tuple[EffectStage, ...] = ()


@dataclass(frozen=True)
class Rival:
    """A mechanism that explains nearly as much: ``evidence_gap`` is how much less.

    ``in_place_of``: the effect of the answer that it would replace, several with "and" between them.
    """

    name: str
    effect_class: str
    evidence_gap: float
    in_place_of: str


@dataclass(frozen=True)
class Undecided:
    """A suspect that is not named although chance hardly brings its ``gain`` (2 log likelihood less that of shapes).

    ``rests_on``: "one window" or "one recording" without which too little is left, "the recordings fitted to", those
    held out being less likely with it, or "the refit alone", the score being no larger than chance brings; "" where
    the gain is under what a name takes.
    """

    name: str
    effect_class: str
    gain: float
    rests_on: str


@dataclass(frozen=True)
class Located:
    """An interval (s) of a recording in which something acts or shows, and in which phases of the motion.

    ``share`` of the whole action or excess misfit. Where a named ``effect`` acts, ``amplitude`` is the largest value
    of its force, impulse or error there, in ``unit``; of a residual, and of what has no name, both are empty.
    """

    recording: str
    channel: str
    start: float
    end: float
    where: tuple[str, ...]
    share: float
    effect: str = ""
    amplitude: float | None = None
    unit: str = ""


@dataclass(frozen=True)
class Visited:
    """What a named effect does along the fitted motion: ``value`` (``what``, in ``unit``) ``over`` a variable ``at``
    its values, arrays (n,).
    """

    effect: str
    over: str
    at: NDArray[np.float64]
    at_unit: str
    what: str
    value: NDArray[np.float64]
    unit: str


@dataclass(frozen=True)
class Fit:
    """Relative rms misfit over windows and channels before and after, on one set of recordings.

    ``noise_free``: these recordings have no noise of their own, the floor is that of rounding.
    """

    before: float
    after: float
    noise_floor: float
    share_of_achievable: float | None = None
    noise_free: bool = False


@dataclass(frozen=True)
class Screened:
    """One line of the screen: the score statistic and, where refitted, the gain."""

    name: str
    effect_class: str
    score: float
    gain: float | None
    estimate: Mapping[str, float] | None


@dataclass(frozen=True)
class Windows:
    """Residuals window by window, for the raster: one entry a window of one recording and channel.

    ``start`` and ``end`` in s; ``before`` and ``after`` are rms residuals over the noise;
    ``held_out``: the recording was not fitted.
    """

    recording: str
    channel: str
    held_out: bool
    start: NDArray[np.float64]
    end: NDArray[np.float64]
    before: NDArray[np.float64]
    after: NDArray[np.float64]


@dataclass(frozen=True)
class Trace:
    """Measured and predicted channel over time of one recording (nan outside windows)."""

    recording: str
    channel: str
    unit: str
    held_out: bool
    time: NDArray[np.float64]
    measured: NDArray[np.float64]
    before: NDArray[np.float64]
    after: NDArray[np.float64]
    from_rest_before: NDArray[np.float64] | None = None
    from_rest_after: NDArray[np.float64] | None = None


@dataclass(frozen=True)
class Extrapolated:
    """A recording held out that goes beyond those learned from: peaks of ``channel`` in ``unit``, misfit ``after``."""

    recording: str
    channel: str
    unit: str
    peak: float
    learned: float
    after: float


@dataclass(frozen=True)
class OtherModel:
    """The base model that the recordings ask for in the place of the one given, named as the ``effect``.

    ``evidence``: its gain in 2 log likelihood over the one given with the effects ``instead`` (all that its mechanisms
    could do), prices of parameters and states paid; ``inadequate``: with them that one errs clearly all the same.
    ``vertical``: whether the vertical motion of the base acts.
    """

    effect: str
    model: str
    options: Mapping[str, str]
    parameters: Mapping[str, float]
    evidence: float
    instead: tuple[str, ...]
    inadequate: bool
    vertical: bool


@dataclass(frozen=True)
class Beyond:
    """An ``effect`` whose ``parameter`` ends at the ``limit`` of its range and, released, goes on to ``wanted``.

    ``evidence``: what that gains in 2 log likelihood.
    """

    effect: str
    parameter: str
    limit: float
    wanted: float
    unit: str
    evidence: float


@dataclass(frozen=True)
class Unfit:
    """A window of a recording, ``start`` to ``end`` in s, that the answer leaves far from the noise.

    ``misfit``: mean squared residual over the variance of what is expected.
    """

    recording: str
    start: float
    end: float
    misfit: float


@dataclass(frozen=True)
class Diagnosis:
    """The answer. Everything the report shows is here; nothing in the report is computed anew."""

    verdict: Verdict
    statement: str
    effects: tuple[Effect, ...]
    rivals: tuple[Rival, ...]
    located: tuple[Located, ...]
    """Where what is missing acts: of named effects along the fitted motion, else where something must be added."""
    shows: tuple[Located, ...]
    """Where the residual of the base model lies."""
    constancy: tuple[Constancy, ...]
    train: Fit
    holdout: Fit | None
    base: Mapping[str, Estimate]
    """Calibrated base parameters (of the extended model if something is missing)."""
    screen: tuple[Screened, ...]
    null_band: float
    """The gain that chance alone exceeds with 5 % probability."""
    p_value: float | None
    """Of "something is missing"; None where a stopped search has tested nothing."""
    next_experiment: Mapping[str, Any] | None
    windows: tuple[Windows, ...]
    traces: tuple[Trace, ...]
    prediction_horizon: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    """By recording: seconds until the prediction from a window's start leaves the noise, before and after."""
    missing_force: Mapping[str, Any] | None = None
    """The force that is not in the library, as a law in a table (`diagnosis.answer.missing_force`)."""
    other_model: OtherModel | None = None
    """Another base model than the specimen's, where that is the answer."""
    held_stages: tuple[HeldStage, ...] = ()
    """In which state recordings held out were predicted, of effects that do not always act."""
    contradicted: tuple[float, float] | None = None
    """Misfit on recordings held out without and with the effects found, where that is why they are no explanation."""
    unfit: tuple[Unfit, ...] = ()
    """Windows that what was found leaves far from the noise: two or more are no explanation, one is told."""
    beyond: tuple[Beyond, ...] = ()
    """Effects found that would have to be larger than the library takes for possible: they are no explanation."""
    visited: tuple[Visited, ...] = ()
    """The force, jump or error of each named effect over what was visited."""
    reference_peak: float | None = None
    """Rotation (rad) over which levels of instruments among the effects are given; None without such an effect."""
    errors: ErrorModel | None = None
    """The errors of the recordings, estimated with what was found; None where a stopped search has none."""
    not_tried: Mapping[str, str] = field(default_factory=dict)
    """By mechanism: why it was not tried."""
    provenance: Mapping[str, Any] = field(default_factory=dict)
    finished: bool = True
    """False when the user stopped the search: what stands is what was found so far."""
    undecided: Undecided | None = None
    """With ``nothing_missing``: what is not named although chance hardly brings it."""
    unexplained: bool = False
    """The best model leaves so much of the motion that a name would mean nothing; then there are no effects."""
    suspicions: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """By recording: what looked wrong with it when it was read."""
    seen: tuple[str, ...] = ()
    """What the recordings show of their instruments by themselves."""
    instruments: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    """Of the specimen, those seen included."""
    detail: Constancy | None = None
    """What is not the same everywhere and is taken for a detail of a named law (`diagnosis.search.details`)."""
    extrapolated: tuple[Extrapolated, ...] = ()
    """Recordings held out that lie beyond the amplitudes learned from."""
    channels: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    """By channel and parameter: how many times wider the interval would be without the channel; with several."""
    posterior: Mapping[str, FloatArray] = field(default_factory=dict)
    """Samples (n,) of what a study can vary, by name; none where another model is the answer."""
    skipped: tuple[str, ...] = ()
    """What a Ctrl-C after the search has left out."""
    failed: Mapping[str, str] = field(default_factory=dict)
    """By stage after the search that the answer can do without: why it could not be done."""
