"""Effects whose runs cannot be cut at an instant: they begin between two windows, or between recordings, only."""

from __future__ import annotations

from dataclasses import replace

import pytest

import models
from diagnosis.answer.when import held_stages
from diagnosis.data.measured import Measured
from diagnosis.fit.misfit import Misfit
from diagnosis.fit.prediction import Point, Predictor
from diagnosis.fit.setup import base_fit, measure
from diagnosis.fit.whitening import sensor_noise_only
from diagnosis.search.candidates import candidates
from diagnosis.search.refit import Explanation, extend
from diagnosis.search.spells import Spell, interval_of
from grids.stages import Stage
from models.errors import InputError
from tests.diagnosis import made, walls

OF_BLOCKS = {
    "sliding": {"friction": 2.0},
    "bounce": {"contact_restitution": 0.2},
    "wall_flexibility": {"first_frequency": 50.0},
}
OF_WALLS = {"mullins", "maxwell", "bouc_wen", "permanent_set", "degradation", "bonded_layer", "interface_shear"}


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


@pytest.mark.parametrize("mechanism", ["sliding", "restitution"])
def test_a_recording_held_out_is_predicted_with_it_in_whole_windows(
    monkeypatch: pytest.MonkeyPatch, mechanism: str
) -> None:
    """Of an effect that acts in one recording only; all windows but the first and the last ask for it."""
    names = ("train_1", "train_2")
    learned = measure(made.SPECIMEN, [made.recording(name, k + 1) for k, name in enumerate(names)])
    fitted = base_fit(made.SPECIMEN, learned)
    candidate = next(c for c in candidates(fitted.measured, made.SPECIMEN) if c.name == mechanism)
    candidate = replace(candidate, spell=Spell(1, None, 1, None))
    explanation = extend(Explanation((), fitted), candidate, candidate.null, 1)
    held = measure(made.SPECIMEN, [made.recording("test_1", 3)])
    misfit = explanation.fitted.misfit
    fixed = {**misfit.fixed, **explanation.fitted.values}
    predictor = replace(misfit.predictor, measured=held)
    misfit = Misfit(predictor, sensor_noise_only(predictor), (), fixed)
    asked = interval_of(held, 1, len(held.windows) - 2)
    monkeypatch.setattr("diagnosis.answer.when.asking", lambda *_: asked)
    (stage,) = held_stages(explanation, misfit, held.states)
    assert stage.found_there and stage.effect == mechanism
    assert ((stage.begins, stage.ends) == asked) is (mechanism == "sliding")
