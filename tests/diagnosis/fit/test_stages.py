"""Windows of a recording in which something begins: before, after, and over the instant."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import models
from diagnosis.answer import experiment
from diagnosis.answer.heldout import Shown
from diagnosis.answer.whole_runs import no_run, sensed_run, with_runs_from_rest
from diagnosis.errors.kicks import kicks
from diagnosis.fit.memory import counted
from diagnosis.fit.prediction import Point, Predictor
from diagnosis.fit.setup import base_fit, measure
from diagnosis.search.refit import Explanation
from grids.recordings.base import Recording
from grids.stages import Stage
from models.errors import InputError
from models.piecewise import Part, simulate
from tests.diagnosis.made import SPECIMEN, TIME_STEP, TRUE, motion

CHANGE = {"restitution.factor_on_housner": 0.9}
OFFSET = 0.004
MODEL = models.get("housner")
SHAKING = motion(3)


def made(first: int) -> tuple[Recording, np.ndarray]:
    """A recording in which impacts lose more, and the sensor is off, from a sample on; and the states."""
    ran = simulate(MODEL, [Part(0, TRUE), Part(first, {**TRUE, **CHANGE})], SHAKING, integrator="reference")
    states = np.stack([ran.channels["rotation_1"], ran.channels["rotation_rate_1"]], axis=-1)
    seen = states[:, 0] + OFFSET * (np.arange(states.shape[0]) >= first)
    rng = np.random.default_rng(0)
    noisy = seen + 1e-5 * rng.normal(size=seen.size)
    channels = {"base_acceleration_x": SHAKING.horizontal, "rotation_1": noisy}
    return Recording("shake_2", TIME_STEP, TIME_STEP * np.arange(seen.size), channels), states


def test_every_window_is_predicted_with_what_acts_in_it() -> None:
    plain = measure(SPECIMEN, [made(100_000)[0]])
    first = int(plain.first[len(plain.first) // 2]) + 40  # within a window
    recording, states = made(first)
    measured = measure(SPECIMEN, [recording], reference_peak=1.0)
    held = (measured.first < first) & (measured.first + [w.samples for w in measured.windows] > first)
    assert held.any() and np.any(measured.first > first)
    stages = {name: (Stage("shake_2", (first - 0.5) * TIME_STEP),) for name in ("restitution", "offset")}
    values = {**TRUE, **CHANGE, "offset.offset_over_peak": OFFSET}
    points = [Point(values, states[measured.first]), Point({**TRUE}, states[measured.first])]

    def misses(predictor: Predictor, k: int = 0) -> np.ndarray:
        wrong = np.abs(predictor.predict(points)[k] - measured.values)
        return np.where(measured.mask, wrong, 0.0).max(axis=(1, 2))

    noise = 6e-5
    assert np.all(misses(Predictor(measured, stages=stages)) < noise)
    assert np.max(misses(Predictor(measured))) > 20 * noise  # acts always
    before = measured.first + [w.samples for w in measured.windows] <= first
    assert np.all(misses(Predictor(measured, stages=stages), 1)[before] < noise)
    assert np.max(misses(Predictor(measured, stages=stages), 1)) > 20 * noise  # never acts


def test_a_recording_without_it_has_none_of_it() -> None:
    recording, states = made(100_000)
    measured = measure(SPECIMEN, [recording])
    point = Point({**TRUE, **CHANGE}, states[measured.first])
    nowhere = Predictor(measured, stages={"restitution": (Stage("shake_2", 0.0, 0.0), Stage("shake_3"))})
    np.testing.assert_array_equal(
        nowhere.predict([point]), Predictor(measured).predict([Point({**TRUE}, states[measured.first])])
    )


def test_a_clock_cannot_change_within_a_recording() -> None:
    recording, states = made(100_000)
    measured = measure(SPECIMEN, [recording])
    point = Point({**TRUE, "clock.rate": 0.01}, states[measured.first])
    with pytest.raises(InputError, match="clock"):
        Predictor(measured, stages={"clock": (Stage("shake_2", 2.0),)}).predict([point])


def test_a_specimen_with_stages_is_fitted_as_it_acts() -> None:
    recording, _ = made(600)
    acts = replace(
        SPECIMEN, mechanisms={"restitution": {"factor_on_housner": 0.9}, "offset": {"offset_over_peak": OFFSET}},
        stages={name: (Stage("shake_2", 599.5 * TIME_STEP),) for name in ("restitution", "offset")}, reference_peak=1.0,
    )  # fmt: skip
    right = base_fit(acts, measure(acts, [recording]))
    always = replace(acts, stages={})
    assert right.loss < base_fit(always, measure(always, [recording])).loss - 1000.0
    assert abs(right.values["width"] - TRUE["width"]) < 1e-4
    explanation = Explanation((), right)
    seen = sensed_run(explanation, right.measured, recording, ["rotation_1"])["rotation_1"]
    peak = np.max(np.abs(recording.channels["rotation_1"]))
    np.testing.assert_allclose(seen[:400], recording.channels["rotation_1"][:400], atol=0.02 * peak)
    assert 598 <= int(np.argmax(np.abs(np.diff(seen, 2)))) <= 599  # the sensor's jump stands where it begins


def test_a_change_of_an_impact_is_run_to_the_end_of_its_window_where_the_next_one_is_another() -> None:
    """With a table that pitches from that window on a run cannot be cut at an instant."""
    recording, states = made(100_000)
    measured = measure(SPECIMEN, [recording])
    begins = measured.first[len(measured.first) // 2]
    stages = {"table_pitch": (Stage("shake_2", (begins - 0.5) * TIME_STEP),)}
    point = Point({**TRUE, "table_pitch.pitch_per_acceleration": 1e-4}, states[measured.first])
    found = kicks(Predictor(measured, stages=stages), point)
    before, plain = measured.first < begins, kicks(Predictor(measured), Point({**TRUE}, states[measured.first]))
    np.testing.assert_allclose(found.columns[before], plain.columns[before], atol=1e-12)
    assert np.any(plain.columns[before]) and np.any(found.columns[~before])


def test_beside_what_a_run_cannot_be_cut_with_events_are_counted_and_runs_from_rest_left_out() -> None:
    """A block that slides goes on with more than its rotation; until now a diagnosis that found both ended there."""
    plain = measure(SPECIMEN, [made(100_000)[0]])
    first = int(plain.first[len(plain.first) // 2])  # between windows
    recording, states = made(first)
    measured = measure(SPECIMEN, [recording])
    stages = {"restitution": (Stage("shake_2", (first - 0.5) * TIME_STEP),)}
    slides = {**TRUE, **CHANGE, "sliding.friction": 2.0}
    fitted = base_fit(SPECIMEN, measured)
    predictor = Predictor(measured, stages=stages)
    staged = replace(
        fitted, u=np.zeros(0), misfit=replace(fitted.misfit, predictor=predictor, unknowns=(), fixed=slides)
    )
    explanation, before = Explanation((), staged), Explanation((), fitted)
    assert "cannot be cut" in no_run(explanation, recording) and not no_run(before, recording)
    assert experiment._made(explanation, recording, 1.0, measured.channels) is None
    assert experiment._made(before, recording, 1.0, measured.channels) is not None
    with pytest.raises(InputError, match="sliding remembers more"):
        sensed_run(explanation, measured, recording, measured.channels)
    points = [Point(values, states[measured.first]) for values in (slides, {**TRUE, **CHANGE})]
    with_sliding, without = (counted(predictor, point).memory["impacts"] for point in points)
    assert np.array_equal(with_sliding, without) and without.max() > 5
    beyond = replace(predictor, stages={"restitution": (Stage("shake_2", recording.time[-1] + 1.0),)})
    late = replace(staged, misfit=replace(staged.misfit, predictor=beyond))
    assert not no_run(Explanation((), late), recording)  # nothing changes while it lasts
    values = np.zeros(measured.values.shape)
    shown = Shown(measured, values, values, staged.point, staged.point)
    traces = with_runs_from_rest(SPECIMEN, [shown], before, explanation)
    assert [t.channel for t in traces] == list(measured.channels)
    assert all(t.from_rest_before is None and t.from_rest_after is None for t in traces)
    assert all(t.from_rest_after is not None for t in with_runs_from_rest(SPECIMEN, [shown], before, before))
