"""States at the windows' starts that no recording holds: carried along what was measured, freed of the instruments."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diagnosis.data.measured import Measured
from diagnosis.fit.carrying import Setting, freed
from diagnosis.fit.prediction import Point, Predictor
from grids.instruments.base import Switched
from grids.instruments.windowed import moved_in_windows
from grids.recordings.base import Recording
from grids.stages import Stage, first_sample
from models.piecewise import Part
from tests.diagnosis.fit.carried import BASE, HARDENING, TRUE, made, measured_of, seen
from tests.diagnosis.made import TIME_STEP
from tests.diagnosis.walls import MAXWELL


def true_states(recording: Recording, measured: Measured, late: int = 0) -> np.ndarray:
    """At the windows' starts on the clock of responses that come ``late`` by some samples."""
    return np.stack([recording.channels[name][measured.first - late] for name in measured.free], axis=1)


def misses(predicted: np.ndarray, recording: Recording, measured: Measured) -> float:
    """Rms of the prediction's error of the rotations as they were, over their peak."""
    values = replace(measured, recordings=(recording,)).values
    return float(np.sqrt(np.mean(np.where(measured.mask, predicted - values, 0.0) ** 2)) / np.max(np.abs(values)))


def test_the_measured_motion_is_freed_of_what_sensors_read_of_the_base_as_it_moves() -> None:
    instruments = {"cross_axis": {"rotation_per_acceleration": 0.002}, "base_gain": {"gain": 0.1}}
    true = made(())
    base = moved_in_windows(BASE, instruments)
    names = ("rotation_1", "rotation_2")
    leaking = {name: true.channels[name] + 0.002 * 1.1 * BASE.horizontal for name in names}
    recording = replace(true, channels={"base_acceleration_x": BASE.horizontal, **leaking})
    found = freed(measured_of(recording), recording, Setting(base, [Part(0, TRUE)], [(0, instruments)]))
    assert set(found) == set(names)
    for name in names:
        np.testing.assert_allclose(found[name], true.channels[name], atol=1e-12)


def test_only_what_is_recorded_is_free_and_the_rest_is_right_at_the_true_parameters() -> None:
    true = made(tuple(MAXWELL.items()))
    measured = measured_of(seen(true, {}))
    assert measured.free == ("rotation_1", "rotation_2", "rotation_rate_1", "rotation_rate_2")
    states = true_states(true, measured)
    point, without = Point({**TRUE, **MAXWELL}, states), Point(TRUE, states)
    right, wrong = Predictor(measured).predict([point, without])
    assert misses(right, true, measured) < 2e-3
    assert misses(wrong, true, measured) > 0.05


def test_the_motion_is_freed_of_what_the_sensors_add_to_it() -> None:
    true = made(tuple(MAXWELL.items()))
    instruments: Switched = {"offset": {"offset_over_peak": 0.1}, "gain": {"gain": 0.08}, "delay": {"delay": 0.01}}
    switched = {f"{name}.{k}": v for name, values in instruments.items() for k, v in values.items()}
    measured = measured_of(seen(true, instruments))
    states = true_states(true, measured, late=2)
    known, unknown = Predictor(measured).predict(
        [Point({**TRUE, **MAXWELL, **switched}, states), Point({**TRUE, **MAXWELL}, states)]
    )
    assert misses(known, true, measured) < 0.015 < 0.035 < misses(unknown, true, measured)


def test_what_is_carried_is_computed_once_for_all_states_and_probes() -> None:
    measured = measured_of(seen(made(tuple(MAXWELL.items())), {}))
    predictor = Predictor(measured)
    states = measured.states
    first = predictor.predict([Point({**TRUE, **MAXWELL}, states)])
    before = list(predictor.carrying.kept)
    moved = Point({**TRUE, **MAXWELL}, states * 1.01)
    predictor.predict([moved], [replace(s, horizontal=s.horizontal + 0.1) for s in measured.shakings])
    assert list(predictor.carrying.kept) == before
    again = predictor.predict(
        [moved, Point({**TRUE, **MAXWELL, "wall_height": 1.81}, states), Point({**TRUE, **MAXWELL}, states)]
    )
    assert len(predictor.carrying.kept) == len(before) + 1
    np.testing.assert_array_equal(again[2], first[0])


def test_a_law_that_begins_is_carried_as_it_acts() -> None:
    begins = 900
    true = made(tuple(HARDENING.items()), begins)
    measured = measured_of(seen(true, {}))
    states = true_states(true, measured)
    point = Point({**TRUE, **HARDENING}, states)
    stages = {"hardening": (Stage("shake_1", (begins - 0.5) * TIME_STEP),)}
    staged, always = (Predictor(measured, stages=s).predict([point])[0] for s in (stages, {}))
    assert misses(staged, true, measured) < 2e-3
    assert misses(always, true, measured) > 2e-2


def test_a_wall_that_falls_from_an_instant_on_carries_nothing_from_there_on() -> None:
    """Marks before it keep what was carried there, however many follow."""
    measured = measured_of(made(()))
    stages = {"tilt": (Stage("shake_1", 0.5 * float(BASE.time[-1])),)}
    predictor = Predictor(measured, stages=stages)
    point = Point({**TRUE, "tilt.tilt": 0.6}, true_states(made(()), measured))
    compressed = predictor.carried(point)["displacement_z_1"]
    before = measured.first < first_sample(0.5 * float(BASE.time[-1]), TIME_STEP)
    assert before.any() and not before.all()
    assert np.all(np.isfinite(compressed[before])) and np.all(np.isnan(compressed[~before]))
