"""Long steps of the model, their error at a fit taken off: as good as short ones near it, and in fewer runs' time."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diagnosis.data.measured import Measured, for_model, seen_as
from diagnosis.errors.model import calibrated, disturbance_about, estimate, fit_under
from diagnosis.fit import long_steps
from diagnosis.fit.long_steps import MORE, in_long_steps
from diagnosis.fit.prediction import Point
from diagnosis.fit.setup import measure
from diagnosis.fit.solver import Fitted, fit
from models.base import FloatArray
from models.runs import DONE
from tests.diagnosis.made import SPECIMEN, TIME_STEP, recording
from tests.diagnosis.walls import TRUE, WALL, misfit, recorded


@pytest.fixture(scope="module")
def wall() -> Fitted:
    one = misfit(measure(WALL, [recorded(seed) for seed in (1, 2)]))
    return fit(one, np.array([x.coordinate(TRUE[x.name]) for x in one.unknowns]), one.measured.states)


def predicted(fitted: Fitted, point: Point, steps: int | None = None) -> FloatArray:
    """Whitened residuals at a point; with so many ``steps`` a sample in the place of the fit's."""
    one = fitted.misfit
    if steps is not None:
        m = fitted.measured.in_own_steps
        measured = replace(m, model=m.model.stepping(TIME_STEP / steps))
        one = replace(one, predictor=replace(one.predictor, measured=measured))
    return one.residuals([point])[0]


def own_steps(fitted: Fitted) -> int:
    return fitted.measured.model.steps_a_sample(TRUE, TIME_STEP)


def test_at_the_fit_it_predicts_as_in_short_steps(wall: Fitted) -> None:
    long = in_long_steps(wall)
    assert long.measured.model.step is not None and long.measured.model.step > TIME_STEP / own_steps(wall)
    short = predicted(wall, wall.point, MORE * own_steps(wall))
    np.testing.assert_allclose(predicted(long, wall.point), short, atol=1e-8)
    assert np.max(np.abs(predicted(wall, wall.point) - short)) > 1e-4


def test_near_it_its_error_is_less_than_that_of_the_own_rule_and_further_away_still_small(wall: Fitted) -> None:
    """In 2 log likelihood; and in fewer steps."""
    long, unknowns = in_long_steps(wall), wall.misfit.unknowns
    for share, most in ((0.05, 0.3), (2.0, np.inf)):
        u = wall.u.copy()
        u[[x.name for x in unknowns].index("top_stiffness")] += share
        point = wall.misfit.point(u, (1.0 + 0.01 * share) * wall.states)
        exact = predicted(wall, point, 8 * own_steps(wall))
        took = []
        for fitted in (wall, long):
            begin = DONE.steps
            took.append((float(np.sum((predicted(fitted, point) - exact) ** 2)), DONE.steps - begin))
        (of_rule, steps_of_rule), (error, steps) = took
        assert error < min(most * of_rule, 1.0)
        assert steps < 0.75 * steps_of_rule


def test_what_is_carried_to_a_window_is_that_of_its_own_steps(wall: Fitted) -> None:
    """Though both keep it in one place."""
    by_rule, by_long = (one.misfit.predictor.carried(wall.point) for one in (wall, in_long_steps(wall)))
    assert all(not np.array_equal(by_long[name], x) for name, x in by_rule.items())
    for name in ("displacement_z_1", "displacement_z_2"):
        np.testing.assert_allclose(by_long[name], by_rule[name], atol=0.02 * np.max(np.abs(by_rule[name])))


def test_nothing_is_taken_off_where_the_error_is_not_small(monkeypatch: pytest.MonkeyPatch, wall: Fitted) -> None:
    taken = in_long_steps(wall).measured.step_error
    assert taken is not None and np.any(taken)
    monkeypatch.setattr(long_steps, "LARGEST", 0.0)
    left = in_long_steps(wall).measured.step_error
    assert left is not None and not np.any(left)


def test_other_windows_and_other_recordings_are_predicted_by_the_own_rule(wall: Fitted) -> None:
    long = in_long_steps(wall).measured
    some = long.of_windows(np.array([2, 0]))
    assert long.step_error is not None and some.step_error is not None
    np.testing.assert_array_equal(some.step_error, long.step_error[[2, 0]])
    shorter = tuple(replace(w, samples=w.samples // 2) for w in long.windows)
    others = [long.cut_again(shorter), for_model(long, wall.measured.model, {}, False), seen_as(wall.measured, long)]
    assert all(one.model.step is None and one.step_error is None for one in others)


def test_a_fit_under_errors_goes_on_in_long_steps(wall: Fitted) -> None:
    found, _ = fit_under(wall, estimate(wall, disturbance_about(wall)))
    assert found.measured.model.step is not None and found.measured.step_error is not None


def test_a_model_whose_steps_are_not_chosen_stays_as_it_is() -> None:
    measured: Measured = measure(SPECIMEN, [recording("run_1", 1)])
    fitted, _ = calibrated(SPECIMEN, measured)
    assert fitted.measured.model.step is None and fitted.measured.step_error is None
