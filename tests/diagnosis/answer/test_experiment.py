"""Which experiment would separate two rivals, and that none is offered which would tell nothing."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

from diagnosis.answer.experiment import next_experiment
from diagnosis.errors.model import calibrated
from diagnosis.fit.setup import measure
from diagnosis.search.candidates import Candidate, candidates
from diagnosis.search.found import Near, Search
from diagnosis.search.refit import Explanation, extend
from tests.diagnosis.made import SPECIMEN, recording
from tests.diagnosis.report.schema import NextExperimentPart

FIRST, SECOND = "viscous_damping", "coulomb_damping"


@cache
def rivals(rate: float) -> tuple[Search, Near]:
    """A search that found viscous damping in a block with ``rate`` (1/s) of it, and dry friction in its place."""
    effect: Mapping[str, Mapping[str, float]] = {FIRST: {"rate": rate}} if rate else {}
    measured = measure(SPECIMEN, [recording(f"train_{k}", k, effect) for k in (1, 2)])
    fitted, errors = calibrated(SPECIMEN, measured)
    tried = {c.name: c for c in candidates(measured, SPECIMEN) if c.name in (FIRST, SECOND)}
    base = Explanation((), fitted)
    best, other = (_with(base, tried[name]) for name in (FIRST, SECOND))
    found = Search(base, tuple(tried.values()), errors, best=best)
    return found, Near(other, other.candidates[0], other.loss - best.loss, (FIRST,))


def _with(base: Explanation, candidate: Candidate) -> Explanation:
    return min((extend(base, candidate, start) for start in candidate.grid()), key=lambda one: one.loss)


def test_expected_evidence_is_of_the_size_that_such_recordings_had() -> None:
    """Against all that is to be expected of them: with the sensors' errors alone it was seven times as much."""
    found, near = rivals(0.15)
    offered = next_experiment(found, [near])
    assert offered is not None and offered["separates"] == [FIRST, SECOND] and near.gap > 2.0
    assert offered["recording"]["base_motion"] in ("train_1", "train_2")
    assert NextExperimentPart.model_validate(offered)
    assert 0.3 * near.gap < offered["recording"]["expected_evidence"] < 3.0 * near.gap


def test_no_shaking_is_offered_that_would_tell_nothing() -> None:
    """Of a block without either effect both explanations predict the same motion."""
    found, near = rivals(0.0)
    offered = next_experiment(found, [near])
    assert offered is not None and offered["recording"] is None and offered["sensor"] is None
    assert "rock freely" in offered["static_test"]
