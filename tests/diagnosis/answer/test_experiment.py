"""Which experiment would separate two rivals, and that none is offered which would tell nothing."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cache

from diagnosis.answer.experiment import next_experiment, unrecorded
from diagnosis.errors.model import calibrated
from diagnosis.fit.setup import measure
from diagnosis.search.candidates import Candidate, candidates
from diagnosis.search.found import Near, Search
from diagnosis.search.refit import Explanation, extend
from grids.recordings.base import Recording
from grids.specimen import Specimen, with_mechanism
from models.kinematics import Place
from tests.diagnosis.buildings import BEARINGS, made
from tests.diagnosis.buildings import SPECIMEN as BUILDING
from tests.diagnosis.made import SPECIMEN, recording
from tests.diagnosis.report.schema import NextExperimentPart

FIRST, SECOND = "viscous_damping", "coulomb_damping"


@cache
def rivals(rate: float) -> tuple[Search, Near]:
    """A search that found viscous damping in a block with ``rate`` (1/s) of it, and dry friction in its place."""
    effect: Mapping[str, Mapping[str, float]] = {FIRST: {"rate": rate}} if rate else {}
    return _search(SPECIMEN, [recording(f"train_{k}", k, effect) for k in (1, 2)], FIRST, SECOND)


def _search(specimen: Specimen, learned: Sequence[Recording], first: str, second: str) -> tuple[Search, Near]:
    """One mechanism, and another in its place."""
    measured = measure(specimen, learned)
    fitted, errors = calibrated(specimen, measured)
    tried = {c.name: c for c in candidates(measured, specimen) if c.name in (first, second)}
    base = Explanation((), fitted)
    best, other = (_with(base, tried[name]) for name in (first, second))
    found = Search(base, tuple(tried.values()), errors, best=best)
    return found, Near(other, other.candidates[0], other.loss - best.loss, (first,))


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


def test_a_run_and_a_channel_are_offered_that_tell_the_laws_of_a_building_apart() -> None:
    """Against the model's own error too, without which any law would be told from any other at once."""
    laws = {"bouc_wen.post_yield_ratio": 0.4, "bouc_wen.yield_compression": 0.008, "bouc_wen.exponent": 1.0}
    runs = [made("small", 1.0, 1, **laws), made("large", 2.5, 2, **laws)]
    found, near = _search(BUILDING, runs, "bouc_wen", "mullins")
    offered = next_experiment(found, [near], {"above": Place("acceleration", 2), "on": Place("acceleration", 1)})
    assert offered is not None and NextExperimentPart.model_validate(offered) and near.gap > 100.0
    assert offered["recording"]["base_motion"] in ("small", "large")
    assert 0.3 * near.gap < offered["recording"]["expected_evidence"] < 3.0 * near.gap
    # the slab's accelerometer, not one on a body that the model has not
    assert offered["sensor"]["channel"] in ("level_acceleration_x_0", "on")
    assert "cycle the rubber slowly" in offered["static_test"]


def test_what_is_recorded_already_is_no_further_channel() -> None:
    """The acceleration from which a displacement was integrated is the same measurement, and not compared."""
    run = made("small", 1.0, 1)
    both = replace(run, channels={**run.channels, "level_acceleration_x": run.channels["level_displacement_x"]})
    filtered = with_mechanism(BUILDING, "integrated_displacement", {"high_pass_hz": 0.1})
    values = {**BUILDING.parameters, **BEARINGS}
    assert unrecorded(measure(BUILDING, [run]), {}, values) == ["level_acceleration_x_0"]
    assert unrecorded(measure(filtered, [both]), {}, values) == []


def test_no_shaking_is_offered_that_would_tell_nothing() -> None:
    """Of a block without either effect both explanations predict the same motion."""
    found, near = rivals(0.0)
    offered = next_experiment(found, [near])
    assert offered is not None and offered["recording"] is None and offered["sensor"] is None
    assert "rock freely" in offered["static_test"]
