"""Effects whose runs cannot be cut at an instant: they begin between two windows, or between recordings, only."""

from __future__ import annotations

import pytest

import models
from diagnosis.data.measured import Measured
from diagnosis.fit.prediction import Point, Predictor
from diagnosis.fit.setup import measure
from grids.stages import Stage
from models.errors import InputError
from tests.diagnosis import made, walls

OF_BLOCKS = {
    "sliding": {"friction": 2.0},
    "bounce": {"contact_restitution": 0.2},
    "wall_flexibility": {"first_frequency": 50.0},
}
OF_WALLS = {"mullins", "maxwell", "bouc_wen", "permanent_set", "degradation", "bonded_layer"}


def predicted(measured: Measured, values: dict[str, float], mechanism: str, sample: int) -> None:
    """Raises InputError where the run cannot go on with the mechanism from just before a sample on."""
    (recording,) = measured.recordings
    stages = {mechanism: (Stage(recording.name, (sample - 0.5) * recording.time_step),)}
    Predictor(measured, stages=stages).predict([Point(values, measured.states)])


@pytest.mark.parametrize("mechanism", OF_BLOCKS)
def test_what_a_run_cannot_be_cut_with_begins_between_windows(mechanism: str) -> None:
    measured = measure(made.SPECIMEN, [made.recording("run", 6)])
    window = measured.windows[len(measured.windows) // 2]
    values = {**made.TRUE, **{f"{mechanism}.{name}": value for name, value in OF_BLOCKS[mechanism].items()}}
    predicted(measured, values, mechanism, window.first)
    with pytest.raises(InputError, match=f"{mechanism} remembers more than the motion"):
        predicted(measured, values, mechanism, window.first + window.samples // 2)


def test_a_wall_whose_rubber_remembers_begins_between_windows() -> None:
    measured = measure(walls.WALL, [walls.recorded(1)])
    window = measured.windows[len(measured.windows) // 2]
    values = {**walls.TRUE, "mullins.softening": 0.3, "mullins.strain": 0.3}
    predicted(measured, values, "mullins", window.first)
    with pytest.raises(InputError, match="mullins remembers more than the motion"):
        predicted(measured, values, "mullins", window.first + window.samples // 2)


@pytest.mark.parametrize(
    ("model", "names"),
    [("housner", set(OF_BLOCKS)), ("stacked", set()), ("interface", OF_WALLS), ("interface_linear", set())],
)
def test_these_are_all_of_them(model: str, names: set[str]) -> None:
    """The page on the diagnosis lists them."""
    known = models.get(model)
    assert set(known.mechanisms) - set(known.resumes_with or ()) == names
