"""Where a named effect acts: intervals, phase and side of its action, held against what its law says."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest

from diagnosis.answer.acts import acts, within_stages
from diagnosis.answer.result import Located
from diagnosis.data.measured import Measured
from diagnosis.fit.prediction import Point, Predictor
from diagnosis.fit.setup import measure
from diagnosis.forces.action import Action, action
from grids.stages import Stage
from models.kinematics import Place
from tests.diagnosis.made import SPECIMEN, TRUE, recording

SAMPLE = 0.005


def at(effect: Mapping[str, float]) -> tuple[Measured, Action]:
    """An effect's action along the motion from the measured states of two recordings."""
    measured = measure(SPECIMEN, [recording("a", 1), recording("b", 2)])
    point = Point({**TRUE, **effect}, measured.states)
    return measured, action(Predictor(measured), point, next(iter(effect)).partition(".")[0])


def overlap(measured: Measured, places: tuple[Located, ...], r: int, inside: np.ndarray) -> float:
    """Intersection over union, among compared samples, of recording r's intervals and of where ``inside`` (W, N)."""
    found = np.zeros(measured.recordings[r].time.size, bool)
    for place in places:
        if place.recording == measured.recordings[r].name:
            found[round(place.start / SAMPLE) : round(place.end / SAMPLE)] = True
    found, truth = found & samples(measured, r, measured.mask[:, 0]), samples(measured, r, inside)
    return float(np.sum(found & truth) / max(np.sum(found | truth), 1))


def samples(measured: Measured, recording: int, inside: np.ndarray) -> np.ndarray:
    """Samples of a recording for which ``inside`` (W, N) holds in a window."""
    found = np.zeros(measured.recordings[recording].time.size, bool)
    for w, window in enumerate(measured.windows):
        if window.recording == recording:
            found[window.first : window.first + window.samples] |= inside[w, : window.samples]
    return found


@pytest.mark.parametrize(
    ("effect", "words"),
    [
        ({"restitution.factor_on_housner": 0.94}, ("impact",)),
        ({"velocity_restitution.beta": 0.1}, ("impact",)),
        ({"viscous_damping.rate": 0.3}, ("between_impacts",)),
        ({"coulomb_damping.over_m_g_b": 0.02}, ("between_impacts",)),
        ({"tilt.tilt": 0.005}, ("between_impacts",)),
        ({"base_gain.gain": 0.05}, ("between_impacts",)),
        ({"gain.gain": 0.05}, ("everywhere",)),
        ({"delay.delay": 0.01}, ("everywhere",)),
    ],
)  # fmt: skip
def test_the_phase_is_that_of_the_law(effect: Mapping[str, float], words: tuple[str, ...]) -> None:
    places = acts(*at(effect))
    assert {place.recording for place in places} == {"a", "b"}
    assert all(place.where == words for place in places)
    assert sum(place.share for place in places) == pytest.approx(1.0, abs=0.02)


def test_a_dashpot_is_found_with_its_force() -> None:
    measured, found = at({"viscous_damping.rate": 0.3})
    inside = measured.mask[:, 0] & ~found.event
    inside[:, :-1] &= inside[:, 1:]
    inside[:, -1] = False
    force = found.amount[:, 0] / SAMPLE
    rate = 0.5 * (found.motion.rate + np.roll(found.motion.rate, -1, axis=1))
    assert np.max(np.abs(force + 0.3 * rate)[inside]) < 0.02 * np.max(np.abs(0.3 * rate)[inside])


def test_a_spring_beyond_a_gap_acts_beyond_it_only() -> None:
    measured, found = at({"added_stiffness.over_m_g_R": 0.2, "added_stiffness.gap": 0.04})
    beyond = np.abs(found.motion.coordinate) > 0.04
    places = acts(measured, found)
    assert all("large_rotation" in place.where for place in places)
    assert all(overlap(measured, places, r, beyond) > 0.7 for r in range(2))


@pytest.mark.parametrize("at_impacts", [True, False])
@pytest.mark.parametrize("part", ["one recording", "after an instant", "one side"])
def test_intervals_are_as_long_as_the_action(at_impacts: bool, part: str) -> None:
    measured, found = at({"restitution.factor_on_housner": 0.94} if at_impacts else {"viscous_damping.rate": 0.3})
    time = (measured.first[:, None] + np.arange(found.amount.shape[2])) * SAMPLE
    there = {
        "one recording": np.broadcast_to(measured.recording_of[:, None] == 1, time.shape),
        "after an instant": time > 4.0,
        "one side": found.motion.coordinate > 0.0,
    }[part]
    places = acts(measured, Action(found.effect, found.kind, found.amount * there[:, None], found.event, found.motion))
    if part == "one side":
        assert all("right" in place.where for place in places)
    else:
        assert all({"left", "right"}.isdisjoint(place.where) for place in places)
    if not (at_impacts and part == "one side"):  # between two landings on a side nothing tells that it is the side
        for r, one in enumerate(measured.recordings):
            own = (measured.recording_of == r)[:, None] & there & measured.mask[:, 0]
            if own.any():
                happens = time[own & found.event] if at_impacts else time[own]
                assert overlap(measured, places, r, own & (time >= happens.min()) & (time <= happens.max())) > 0.7
            else:
                assert one.name not in {place.recording for place in places}


@pytest.mark.parametrize("effect", [{"restitution.factor_on_housner": 0.94}, {"gain.gain": 0.05}, {"tilt.tilt": 0.005}])
def test_what_begins_acts_from_there_on(effect: Mapping[str, float]) -> None:
    name, begins = next(iter(effect)).partition(".")[0], 4.0
    measured = measure(SPECIMEN, [recording("a", 1), recording("b", 2)])
    point = Point({**TRUE, **effect}, measured.states)
    stages = {name: (Stage("a", 0.0, 0.0), Stage("b", begins))}
    staged = action(Predictor(measured, stages=stages), point, name)
    time = np.stack([measured.times(w) for w in range(len(measured.windows))])
    inside = (measured.recording_of[:, None] == 1) & (time >= begins - 1.5 * SAMPLE)
    assert np.any(staged.amount[inside[:, None]])
    assert not np.any(staged.amount[~inside[:, None]])
    places = acts(measured, staged)
    assert {place.recording for place in places} == {"b"} and min(
        place.start for place in places
    ) >= begins - 2 * SAMPLE
    carried_on = within_stages(measured, places, stages[name])
    assert min(place.start for place in carried_on) == begins
    assert max(place.end for place in carried_on) == measured.recordings[1].time[-1]
    assert sum(place.share for place in carried_on) == pytest.approx(1.0)


def test_an_error_is_in_the_unit_of_its_channel() -> None:
    recordings = [recording("a", 1), recording("b", 2)]
    moving = [r.channels | {"displacement_1_x": 0.9 * r.channels["rotation_1"]} for r in recordings]
    measured = measure(SPECIMEN, [replace(r, channels=own) for r, own in zip(recordings, moving, strict=True)])
    late = action(Predictor(measured), Point({**TRUE, "delay.delay": 0.01}, measured.states), "delay")
    units = {place.channel: place.unit for place in acts(measured, late)}
    assert units == {"rotation_1": "rad", "displacement_1_x": "m"}


def test_a_force_turns_the_block_whatever_measured_it() -> None:
    """Gauges are compared, the dashpot acts on the rotation, which was not recorded."""
    gauge = Place("displacement", 1, 0.0, 1.5, "x")
    moving = []
    for one in (recording("a", 1), recording("b", 2)):
        channels = {"base_acceleration_x": one.channels["base_acceleration_x"]}
        moving.append(
            replace(one, channels=channels | {"string": 1.5 * one.channels["rotation_1"]}, places={"string": gauge})
        )
    measured = measure(SPECIMEN, moving)
    assert measured.channels == ("string",)
    point = Point({**TRUE, "viscous_damping.rate": 0.3}, measured.states)
    places = acts(measured, action(Predictor(measured), point, "viscous_damping"))
    assert {(place.channel, place.unit) for place in places} == {("rotation_1", "rad s-2")}
