"""What is told of recordings held out: how long predictions hold, and which of them extrapolate."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diagnosis.answer import heldout
from diagnosis.answer.extrapolated import extrapolated
from diagnosis.answer.heldout import Shown, compare, horizons, relative_misfit
from diagnosis.errors.model import calibrated
from diagnosis.fit.prediction import Point, Predictor
from diagnosis.fit.setup import measure
from diagnosis.search.candidates import candidates
from diagnosis.search.refit import Explanation, extend
from grids.recordings.base import Recording
from models.kinematics import Place
from tests.diagnosis.made import SPECIMEN, TRUE, recording

GAUGE = Place("displacement", 1, -0.125, 0.0, "z")


class Exact(Predictor):
    """What was measured."""

    def predict(self, *asked: object, **more: object) -> np.ndarray:
        return self.measured.values[None].copy()


def shown(*recordings: Recording) -> Shown:
    """Recordings beside themselves as the prediction."""
    measured = measure(SPECIMEN, recordings)
    point = Point(TRUE, measured.states)
    return Shown(measured, measured.values, measured.values, point, point)


def test_the_end_of_a_recording_is_no_end_of_a_prediction() -> None:
    one = shown(recording("a", 1))
    (pair,) = horizons(one, Predictor(one.measured), Exact(one.measured)).values()
    assert 0.0 < pair[0] < 3.0 and pair[1] == np.inf


def gauged(name: str, gauge: str, size: float) -> Recording:
    made = recording(name, 1)
    left = size * made.channels["rotation_1"]
    channels = {"base_acceleration_x": made.channels["base_acceleration_x"], gauge: 0.125 * np.abs(left)}
    channels["rotation_1"] = left
    return replace(made, channels=channels, places={gauge: GAUGE}, estimated=frozenset({"rotation_1"}))


@pytest.mark.parametrize("name", ["left", "other"])
def test_what_extrapolates_is_told_by_the_rotation_whatever_gauges_are_called(name: str) -> None:
    learned, held = (shown(one) for one in (gauged("a", "left", 1.0), gauged("b", name, 2.0)))
    (beyond,) = extrapolated(learned, held)
    assert (beyond.recording, beyond.channel, beyond.unit) == ("b", "rotation_1", "rad")
    assert beyond.peak == pytest.approx(2.0 * beyond.learned)
    assert not extrapolated(held, learned)


def test_an_extrapolated_recording_has_one_misfit() -> None:
    """Of one channel in one recording: the figure held out and that of the sentence are the same."""
    learned, held = (shown(gauged(name, "left", size)) for name, size in (("a", 1.0), ("b", 2.0)))
    off = replace(held, after=1.1 * held.measured.values)
    assert len(off.measured.channels) == 1
    (beyond,) = extrapolated(learned, off)
    assert beyond.after == pytest.approx(relative_misfit(off.measured, off.after))


def test_a_recording_of_which_nothing_is_compared_has_no_misfit() -> None:
    learned, held = (shown(gauged(name, "left", size)) for name, size in (("a", 1.0), ("b", 2.0)))
    lost = replace(held, measured=replace(held.measured, mask=np.zeros_like(held.measured.mask)))
    assert np.isnan(relative_misfit(lost.measured, lost.after)) and np.isnan(relative_misfit(lost.measured, None))
    assert extrapolated(learned, held) and not extrapolated(learned, lost)


def test_a_known_comparison_gives_what_the_model_before_predicts(monkeypatch: pytest.MonkeyPatch) -> None:
    measured = measure(SPECIMEN, [recording("a", 4, {"gain": {"gain": 0.06}})])
    fitted, errors = calibrated(SPECIMEN, measured)
    base = Explanation((), fitted)
    gain = next(one for one in candidates(measured, SPECIMEN) if one.name == "gain")
    little, much = (extend(base, gain, gain.null + size, 0) for size in (0.1, 1.0))
    asked: list[Explanation] = []
    frozen = heldout.frozen
    monkeypatch.setattr(heldout, "frozen", lambda one, *given: asked.append(one) or frozen(one, *given))
    first = compare(base, little, measured, errors)
    again, anew = (compare(base, much, measured, errors, known) for known in (first, None))
    assert asked == [base, little, much, base, much]
    assert again.before is first.before and again.point_before is first.point_before
    np.testing.assert_array_equal(again.before, anew.before)
    np.testing.assert_array_equal(again.after, anew.after)
    assert not np.array_equal(again.after, first.after)
