"""Where something must be added, without a name: right kind and phase, right recording and stretch, quiet on nulls."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from diagnosis.fit.along import Along
from diagnosis.fit.prediction import Point, Predictor
from diagnosis.fit.setup import measure
from diagnosis.forces.columns import Forces, forces, motions_of
from diagnosis.forces.scan import missing
from tests.diagnosis.made import SPECIMEN, TRUE, at_truth, recording


def about(effect: Mapping[str, float], there: slice, seed: int) -> Forces:
    """A base fit at the truth to noise, and to the response to ``effect`` in the windows ``there``."""
    measured = measure(SPECIMEN, [recording("a", 1), recording("b", 2)])
    predictor = Predictor(measured)
    plain, with_effect = predictor.predict([Point(TRUE, measured.states), Point({**TRUE, **effect}, measured.states)])
    noise = np.random.default_rng(seed).normal(size=plain.shape) * measured.sigma[..., None]
    values = plain + noise
    values[there] += (with_effect - plain)[there]
    return forces(at_truth(replace(measured, values=values)))


@pytest.mark.parametrize(
    ("effect", "kind"),
    [({"restitution.factor_on_housner": 0.93}, "restitution"), ({"viscous_damping.rate": 0.3}, "viscous_damping")],
)
def test_an_effect_in_one_recording_is_found_there(effect: Mapping[str, float], kind: str) -> None:
    measured = measure(SPECIMEN, [recording("a", 1), recording("b", 2)])
    first = int(np.argmax(measured.recording_of == 1))
    found = missing(about(effect, slice(first, None), 0))
    assert found is not None and found.kind == kind
    assert found.windows is not None and measured.recording_of[found.windows[0]] == 1
    low, high = found.windows
    assert (high - low + 1) / (len(measured.windows) - first) > 0.7


def test_an_effect_throughout_is_found_in_all_windows() -> None:
    found = missing(about({"coulomb_damping.over_m_g_b": 0.02}, slice(None), 0))
    assert found is not None and found.kind in ("coulomb_damping", "viscous_damping") and found.windows is None


def test_noise_alone_is_rarely_anything() -> None:
    alarms = sum(missing(about({}, slice(0, 0), seed), seed) is not None for seed in range(12))
    assert alarms <= 3  # .05 of 12 is .6, with probability .997 at most 3


def test_where_a_recording_ends_in_motion_the_rate_does_not_jump() -> None:
    """Behind its end nothing ran: a table over the rate had reached far beyond any rate of the motion."""
    fitted = at_truth(measure(SPECIMEN, [recording("a", 1)]))
    rate = Along(fitted.misfit.predictor, fitted.point).states["rotation_rate_1"]
    assert np.max(np.abs(motions_of(fitted)["base"].rate)) < 1.05 * np.max(np.abs(rate))


def test_what_lies_behind_a_window_has_no_say(monkeypatch: pytest.MonkeyPatch) -> None:
    """An error of the sensor with the rate is found, with the same evidence whatever follows a window's last sample."""
    measured = measure(SPECIMEN, [recording("a", 1), recording("b", 2)])
    plain = Predictor(measured).predict([Point(TRUE, measured.states)])[0]
    noise = np.random.default_rng(0).normal(size=plain.shape) * measured.sigma[..., None]
    late = 3.0 * np.gradient(plain, axis=-1)
    fitted = at_truth(replace(measured, values=np.where(measured.mask, plain + noise + late, 0.0)))
    found, predict = missing(forces(fitted)), Predictor.predict
    assert found is not None and not found.kind

    def and_nonsense(self: Predictor, *given: Any, **named: Any) -> np.ndarray:
        return np.where(self.measured.mask, predict(self, *given, **named), 1.0)

    about = forces(fitted)
    monkeypatch.setattr(Predictor, "predict", and_nonsense)
    again = missing(about)
    assert again is not None and again.statistic == pytest.approx(found.statistic, rel=1e-9)
