"""Windows that are stuck far from where they were measured are found again."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from diagnosis.data.measured import arrange
from diagnosis.fit import solver
from diagnosis.fit.growing import fit_from
from diagnosis.fit.misfit import Misfit
from diagnosis.fit.prediction import Point, Predictor
from diagnosis.fit.setup import base_fit, measure, with_noise_of_the_base
from diagnosis.fit.solver import ITERATIONS, Fitted, fit, fit_thoroughly, fit_together
from diagnosis.fit.starts import nominal
from diagnosis.fit.unknowns import fixed_values, of_specimen
from diagnosis.fit.whitening import sensor_noise_only
from grids.specimen import Specimen
from models.errors import InputError
from models.stacked.identification import IDENTIFICATION
from models.stacked.model import MODEL
from tests.diagnosis.made import SPECIMEN, recording
from tests.diagnosis.stacks import ON_TOP, rocking_on_top

STACK = Specimen("stack", "stacked", ON_TOP, {"wall_length": 0.005, "wall_height": 0.005})
assert IDENTIFICATION.windows is not None
WINDOWS = IDENTIFICATION.windows


@pytest.mark.parametrize(("seed", "away"), [(1, 8.0), (4, -4.0)])
def test_windows_stuck_far_from_the_measured_states_come_back(seed: int, away: float) -> None:
    """Rates ``away`` times the scatter of the states' own: motions with other events, each in a minimum of its own."""
    best = base_fit(SPECIMEN, measure(SPECIMEN, [recording("a", seed)]))
    states = best.states.copy()
    states[:, 1] += away * best.measured.state_size[1]
    assert fit(best.misfit, best.u, states).loss > best.loss + 1000.0
    assert fit_thoroughly(best.misfit, best.u, states).loss < best.loss + 0.5


@pytest.mark.parametrize("above", [0.0, 1e6])
def test_a_restart_ends_no_higher_than_what_it_mends(monkeypatch: pytest.MonkeyPatch, above: float) -> None:
    """A zero that all windows share, ten times the noise: it starts anew, or, if that ends ``above``, where it was."""
    best = base_fit(SPECIMEN, measure(SPECIMEN, [recording("a", 1)]))
    plain, m = best.misfit, best.measured
    zero = 10.0 * np.ones((*m.values.shape, 1)) * m.first_errors[:, :, None, None]
    misfit = replace(plain, whitening=plain.whitening.with_shared(zero))
    predictor = replace(misfit.predictor, measured=replace(m, values=m.values + zero[..., 0]))
    misfit = replace(misfit, predictor=predictor)
    states = best.states.copy()
    states[:, 1] += 8.0 * m.state_size[1]
    began: list[float] = []
    losses: list[float] = []

    def watched(misfit: Misfit, *rest: Any) -> Fitted:
        found = fit(misfit, *rest)
        if not misfit.unknowns:  # windows alone
            return found
        if began and misfit.level == 0.0:
            found = replace(found, loss=found.loss + above)
        began.append(misfit.level.item())
        losses.append(found.loss)
        return found

    monkeypatch.setattr(solver, "fit", watched)
    found = fit_thoroughly(misfit, best.u, states)
    assert len(began) > 1 and began[1] == 0.0
    assert found.loss == min(losses) < losses[0]
    assert any(level != 0.0 for level in began) == (above > 0.0)


@pytest.mark.parametrize("together", [False, True])
def test_a_step_to_where_the_model_refuses_its_parameters_ends_no_fit(
    monkeypatch: pytest.MonkeyPatch, together: bool
) -> None:
    """The fit goes as far as it may; a start that is refused is said so."""
    best = base_fit(SPECIMEN, measure(SPECIMEN, [recording("a", 1)]))
    unknown, true = best.misfit.unknowns[0], float(best.u[0])
    begin, limit = true - 0.6, unknown.value(true - 0.2)
    predict, refused = Predictor.predict, 0

    def up_to_limit(self: Predictor, points: Any, *rest: Any, **more: Any) -> Any:
        nonlocal refused
        if any(point.values[unknown.name] > limit for point in points):
            refused += 1
            raise InputError(f"{unknown.name} is beyond {limit}.")
        return predict(self, points, *rest, **more)

    def fitted(u: Any) -> Fitted:
        return fit_together([best.misfit], u, best.states)[0] if together else fit(best.misfit, u, best.states)

    u = best.u.copy()
    u[0] = begin
    start = fit(best.misfit, u, best.states, 0).loss
    monkeypatch.setattr(Predictor, "predict", up_to_limit)
    found = fitted(u)
    assert refused > 0 and begin < found.u[0] <= true - 0.2 and best.loss < found.loss < start
    with pytest.raises(InputError, match="is beyond"):
        fitted(best.u)


@cache
def of_a_stack() -> Fitted:
    """In windows so long that neighbouring trajectories part in them."""
    lengths = replace(WINDOWS, shortest=1.0, aim=2.0, longest=2.8).in_seconds(MODEL.derive(ON_TOP))
    measured = arrange(MODEL, [rocking_on_top(seed, True) for seed in (1, 2)], False, lengths)
    predictor = Predictor(measured, STACK.options)
    plain = Misfit(predictor, sensor_noise_only(predictor), of_specimen(STACK, measured.model), fixed_values(STACK))
    return with_noise_of_the_base(fit_from(plain, [nominal(plain)]))


def away(axis: int, size: float) -> np.ndarray:
    """States with one of them moved by so many times its scatter among the windows."""
    found = of_a_stack().states.copy()
    found[:, axis] += size * of_a_stack().measured.state_size[axis]
    return found


def test_windows_of_two_bodies_come_back_from_most_states() -> None:
    """Each of the four moved, up or down: 480 above the minimum where stuck ones are not fitted, 10 where they are."""
    best = of_a_stack()
    starts = [away(axis, size) for axis, size in enumerate((-4.0, 4.0, -4.0, 4.0))]
    above = [fit_thoroughly(best.misfit, best.u, states).loss - best.loss for states in starts]
    assert min(fit(best.misfit, best.u, states).loss for states in starts) > best.loss + 1e4
    assert np.median(above) < 100.0


def test_a_fit_near_its_minimum_goes_on_with_the_derivatives_that_it_has(monkeypatch: pytest.MonkeyPatch) -> None:
    """Near the minimum derivatives hardly change; each set of them takes a run for every parameter and state."""
    best = base_fit(SPECIMEN, measure(SPECIMEN, [recording("a", 1)]))
    start = best.u + 0.3

    def asked() -> tuple[float, int]:
        """Loss of the fit, and the runs of all windows that it asked for."""
        runs: list[int] = []

        def counted(predictor: Predictor, points: list[Point], **more: object) -> np.ndarray:
            runs.append(len(points))
            return predict(predictor, points, **more)

        predict = Predictor.predict
        with monkeypatch.context() as patch:
            patch.setattr(Predictor, "predict", counted)
            return fit(best.misfit, start, best.states).loss, sum(runs)

    loss, fewer = asked()
    monkeypatch.setattr(solver, "GOOD", np.inf)  # no step gains so much: each has derivatives of its own
    other, more = asked()
    assert fewer < 0.7 * more
    assert loss < best.loss + 0.05 and other < best.loss + 0.05


def test_a_fit_that_promises_less_than_is_asked_is_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    """And one that reaches it is the same as without."""
    best = base_fit(SPECIMEN, measure(SPECIMEN, [recording("a", 1)]))
    runs: list[int] = []
    run = Predictor.predict
    monkeypatch.setattr(Predictor, "predict", lambda *asked: runs.append(len(asked[1])) or run(*asked))

    def fitted(away: float, most: float = np.inf, iterations: int = ITERATIONS) -> tuple[float, int]:
        """Loss and runs of a fit from rates so many times their scatter away."""
        runs.clear()
        states = best.states.copy()
        states[:, 1] += away * best.measured.state_size[1]
        return fit(best.misfit, best.u + 0.5, states, iterations, most).loss, sum(runs)

    near, far, (started, _) = fitted(0.2), fitted(8.0), fitted(8.0, iterations=0)
    assert fitted(0.2, near[0] + 1.0) == near and fitted(8.0, far[0] + 1.0) == far
    assert fitted(8.0, -np.inf)[0] < 0.9 * started  # one step is taken in any case
    loss, took = fitted(8.0, near[0])
    assert loss > far[0] > near[0] + 1000.0 and took < 0.7 * far[1]


def test_a_search_far_from_a_loss_that_it_should_reach_ends_in_short_windows() -> None:
    plain = of_a_stack().misfit
    plain = replace(plain, whitening=sensor_noise_only(plain.predictor))
    found = fit_from(plain, [nominal(plain)])
    assert fit_from(plain, [nominal(plain)], most=found.loss).loss == found.loss
    given_up = fit_from(plain, [nominal(plain)], most=0.1 * found.loss)
    assert given_up.loss > 0.1 * found.loss
    assert given_up.measured.mask.sum() < 0.6 * found.measured.mask.sum()
