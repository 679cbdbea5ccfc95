"""Two stacked blocks: both rotations start a window, mechanisms act at one joint or at both, the wall is recovered."""

from __future__ import annotations

import numpy as np
import pytest

import models
from diagnosis import calibrate
from diagnosis.fit.prediction import Point, Predictor
from diagnosis.fit.setup import measure
from diagnosis.search.candidates import candidates
from tests.diagnosis.made import TIME_STEP
from tests.diagnosis.stacks import TRUE, WALL, recorded


def test_the_wall_is_recovered_from_both_rotations() -> None:
    found = calibrate(WALL, [recorded(1), recorded(2)], profile=False)
    for name in WALL.tolerance:
        value = found.parameters[name]
        assert abs(value.estimate - TRUE[name]) < value.high95 - value.low95, name
        assert value.high95 - value.low95 < 0.9 * 2 * 1.96 * WALL.tolerance[name] * WALL.parameters[name], name
    assert found.misfit_per_sample < 1.3


def test_windows_begin_where_either_block_moves_most_and_last_by_the_wall() -> None:
    measured = measure(WALL, [recorded(1)])
    assert measured.channels == ("rotation_1", "rotation_2") and len(measured.windows) > 2
    p = float(models.get("stacked").derive(WALL.parameters)["frequency_parameter"].item())
    assert measured.lengths is not None
    assert measured.lengths.aim * p == pytest.approx(0.8)
    assert max(w.samples for w in measured.windows) * TIME_STEP <= 1.1 / p + TIME_STEP


def test_a_mechanism_may_act_at_one_joint_and_both_are_the_plain_one() -> None:
    measured = measure(WALL, [recorded(1)])
    found = {u.name for c in candidates(measured, WALL) for u in c.unknowns if c.name == "pivot_inset"}
    inset = "pivot_inset.inset_over_half_width"
    assert found == {inset, f"{inset}_base", f"{inset}_top"}
    points = [
        Point({**WALL.parameters, **given}, measured.states)
        for given in ({}, {inset: 0.1}, {f"{inset}_base": 0.1}, {f"{inset}_base": 0.1, f"{inset}_top": 0.1})
    ]
    none, both, base, each = Predictor(measured).predict(points)
    np.testing.assert_array_equal(both, each)
    assert np.max(np.abs(base - none)) > 1e-4
