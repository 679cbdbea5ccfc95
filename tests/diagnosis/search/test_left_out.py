"""Recordings predicted from the others tell laws apart that fit all of them alike."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from diagnosis.errors.model import calibrated
from diagnosis.fit.setup import measure
from diagnosis.search.candidates import candidates
from diagnosis.search.left_out import error_left_out, predicts_worse, within_the_others
from diagnosis.search.refit import Explanation, again, best_of, extend, reshaped
from tests.diagnosis.buildings import SPECIMEN, made

TRUE = {"mullins.softening": 0.5, "mullins.strain": 0.4, "bouc_wen.post_yield_ratio": 0.6,
        "bouc_wen.yield_compression": 0.02, "bouc_wen.exponent": 1.0}  # fmt: skip
"""Softening with the largest strain so far, and hysteresis that none of the explanations has."""


@cache
def explained(name: str, *peaks: float) -> Explanation:
    runs = [made(f"run_{k}", peak, k, **TRUE) for k, peak in enumerate(peaks)]
    measured = measure(SPECIMEN, runs)
    base = Explanation((), calibrated(SPECIMEN, measured)[0])
    (law,) = (one for one in candidates(measured, SPECIMEN) if one.name == name)
    return again(reshaped(best_of([extend(base, law, start) for start in law.grid()])))


def test_the_law_that_is_closer_to_the_truth_predicts_a_recording_left_out_better() -> None:
    past, cycles = explained("mullins", 1.0, 3.0), explained("degradation", 1.0, 3.0)
    assert predicts_worse(past, cycles)
    assert not predicts_worse(cycles, past)
    assert not predicts_worse(past, past)


def test_the_error_is_that_of_a_fit_to_the_others_alone() -> None:
    both, alone = explained("mullins", 1.0, 3.0), explained("mullins", 3.0)
    m, own = both.measured, both.measured.recording_of == 0
    values = {**both.fitted.values, **alone.fitted.values}
    u = np.array([x.coordinate(values[x.name]) for x in both.fitted.misfit.unknowns])
    shown = both.fitted.misfit.predictor.predict([both.fitted.misfit.point(u, both.fitted.states)])[0]
    error = (shown - m.values)[own][m.mask[own]]
    rms = np.sqrt(np.mean(m.recordings[0].channels["level_displacement_x_0"] ** 2))
    expected = float(np.sqrt(np.mean(error**2)) / rms)
    assert expected > 0.05
    assert error_left_out(both, 0) == pytest.approx(expected, rel=0.1)  # the errors are those of both


def test_what_goes_further_than_the_others_decides_nothing() -> None:
    assert within_the_others(explained("mullins", 1.0, 3.0).measured) == [0]
    assert within_the_others(explained("mullins", 1.0, 1.0).measured) != []
    alone = explained("mullins", 2.0)
    assert within_the_others(alone.measured) == [] and not predicts_worse(alone, alone)
