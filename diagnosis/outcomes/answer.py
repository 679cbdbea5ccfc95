"""What a diagnosis of outcomes says: small frozen objects, written as ``diagnosis.json``."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from diagnosis.answer.result import Effect, Rival, Verdict
from diagnosis.fit.intervals import Estimate
from diagnosis.outcomes.scores import Bin, Scores
from grids.specimen import Specimen
from models.base import FloatArray


@dataclass(frozen=True)
class Wrong:
    """Where the base model's predictions are wrong: a range of a measure, or a group of runs.

    ``predicted``: "stands" or "overturns", what it says of ``wrong`` of the ``runs`` there, which did the other.
    ``standard_score`` of the residuals (their slope along the logarithm of a measure, their sum in a group).
    """

    over: str
    low: float | None
    high: float | None
    unit: str
    predicted: str
    wrong: int
    runs: int
    standard_score: float


@dataclass(frozen=True)
class Compared:
    """One predictor over all runs: chances (runs,) of overturning, and how they agree with the outcomes.

    ``by``: what predicts; ``cross_validated``: each group of runs predicted from the others alone.
    """

    by: str
    cross_validated: bool
    chance: FloatArray
    scores: Scores
    reliability: tuple[Bin, ...]


@dataclass(frozen=True)
class Posterior:
    """Samples of what was found, equally likely: ``values`` (samples,) by name with ``units``, and ``scatter``
    (samples,), the standard deviation of the logarithm of a run's scale.
    """

    values: Mapping[str, FloatArray]
    units: Mapping[str, str]
    scatter: FloatArray


@dataclass(frozen=True)
class Prediction:
    """Chance of overturning (runs,) of each run, with its 95 % interval over the posterior."""

    runs: tuple[str, ...]
    chance: FloatArray
    low95: FloatArray
    high95: FloatArray


@dataclass(frozen=True)
class OutcomeDiagnosis:
    """The answer. ``measures``: of the motions, arrays (runs,); ``overturned`` (runs,) of 0 and 1."""

    verdict: Verdict
    statement: str
    effects: tuple[Effect, ...]
    rivals: tuple[Rival, ...]
    wrong: tuple[Wrong, ...]
    left: tuple[Wrong, ...]
    """Where the extended model is still wrong."""
    compared: tuple[Compared, ...]
    base: Mapping[str, Estimate]
    at_bound: tuple[str, ...]
    scatter: Estimate
    p_value: float
    misfit_p_value: float
    """Chance of residuals that hang together within groups as much, if the extended model is right."""
    slope_p_value: float
    """Chance of residuals that slope as much along any measure of the motion, if the extended model is right."""
    extended: Specimen
    posterior: Posterior
    runs: tuple[str, ...]
    groups: tuple[str, ...]
    overturned: FloatArray
    measures: Mapping[str, FloatArray]
    not_tried: Mapping[str, str] = field(default_factory=dict)
    finished: bool = True
    provenance: Mapping[str, Any] = field(default_factory=dict)

    def predictor(self, by: str) -> Compared:
        return next(one for one in self.compared if one.by == by)
