"""Walls on rubber: layers that a laboratory does not know are recovered from the rotations, a law in them is named."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import models
from diagnosis import calibrate
from diagnosis.answer.experiment import unrecorded
from diagnosis.fit.along import Along
from diagnosis.fit.intervals import QUANTILE, at_least, covariances, estimates
from diagnosis.fit.linearisation import linearise_about
from diagnosis.fit.posterior import samples
from diagnosis.fit.prediction import Predictor
from diagnosis.fit.setup import measure
from diagnosis.fit.solver import fit
from diagnosis.fit.starts import start_of
from diagnosis.forces.action import action, one_step
from diagnosis.search.candidates import candidates
from diagnosis.search.refit import Explanation, extend, further
from diagnosis.search.screen import score
from grids.recordings.base import CHANNELS
from tests.diagnosis.walls import LAYERS, MAXWELL, TRUE, WALL, misfit, recorded


def test_layers_are_recovered_from_both_rotations() -> None:
    found = calibrate(WALL, [recorded(1)], profile=False)
    for name, true in TRUE.items():
        if name in found.parameters:
            value = found.parameters[name]
            assert abs(value.estimate - true) < value.high95 - value.low95, name
            if not name.startswith("top"):  # the upper block hardly rocks on its layer, which then tells little
                assert value.high95 - value.low95 < 0.3 * true, name
    assert found.misfit_per_sample < 1.2


def test_a_fit_works_with_the_slope_under_load_and_gives_the_unstressed_stiffness() -> None:
    measured = measure(WALL, [recorded(1)])
    one = misfit(measured)
    u = np.array([x.coordinate(TRUE[x.name]) for x in one.unknowns])
    plain = one.predictor.declared([one.point(u, measured.states)])[0]
    assert plain.values == one.point(u, measured.states).values
    point = one.point(u, measured.states)
    hard = Predictor.declared(
        one.predictor, [type(point)({**point.values, "hardening.beta2": 60.0}, point.states, point.coordinates)]
    )[0]
    assert hard.values["base_stiffness"] < 0.9 * TRUE["base_stiffness"] and not hard.coordinates
    rigid = models.get("interface").derive(hard.values)
    soft = models.get("interface").derive(plain.values)
    assert abs(rigid["frequency_1"][0] / soft["frequency_1"][0] - 1.0) < 1e-2


def test_a_new_sensor_is_one_that_a_recording_can_hold() -> None:
    """How far the layers are compressed is known to the model, and no standard channel."""
    found = unrecorded(measure(WALL, [recorded(1)]), {}, TRUE)
    assert "displacement_2_x" in found and set(found) <= set(CHANNELS) and "rotation_1" not in found


def test_whole_numbers_are_held_at_values_that_are_tried() -> None:
    found = [c for c in candidates(measure(WALL, [recorded(1)]), WALL) if c.name == "bouc_wen"]
    assert sorted(next(iter(c.held.values())) for c in found) == [1.0, 1.0, 1.0, 2.0, 2.0, 2.0]
    assert {u.name.rpartition(".")[2] for c in found for u in c.unknowns if "exponent" in u.name} == set()


def test_a_law_of_the_rubber_stands_out_with_its_parameters() -> None:
    """Of all laws its score is the largest, and a few iterations from there find what it is."""
    measured = measure(WALL, [recorded(1, tuple(MAXWELL.items()))])
    one = misfit(measured)
    base = fit(one, start_of(one.unknowns), measured.states, 4)
    both = ("maxwell.arm_stiffness_ratio", "hardening.beta2")
    laws = [c for c in candidates(measured, WALL) if c.unknowns[0].name in both]
    first, second = score(linearise_about(base), laws)
    assert first.candidate.name == "maxwell" and first.statistic > 2.0 * second.statistic
    found = extend(Explanation((), base), first.candidate, first.starts[0])
    assert base.loss - found.loss > 1000.0
    assert np.sum(found.fitted.misfit.residuals([found.fitted.point])[0] ** 2) / measured.count.sum() < 1.15
    for name, true in MAXWELL.items():
        assert abs(found.fitted.values[name] / true - 1.0) < 0.15, name


def test_what_a_law_does_along_the_motion_starts_from_what_the_layers_remember_there() -> None:
    measured = measure(WALL, [recorded(1, tuple(MAXWELL.items()))])
    one = misfit(measured)
    point = one.point(np.array([x.coordinate(TRUE[x.name]) for x in one.unknowns]), measured.states)
    point = one.predictor.declared([replace(point, values={**point.values, **MAXWELL})])[0]
    off = replace(point, values={**point.values, "maxwell.arm_stiffness_ratio": 0.0})
    acting, nothing = (action(one.predictor, p, "maxwell") for p in (point, off))
    assert acting.kind == "force" and np.max(np.abs(acting.amount)) > 0.0
    assert np.all(nothing.amount == 0.0)  # what is not there does nothing
    # the run to the next sample is that of the motion itself: nothing was lost on the way
    along = Along(one.predictor, point)
    states, ahead = along.states, one_step(point, along)
    for rate in ("rotation_rate_1", "rotation_rate_2"):
        lost = np.where(measured.mask[:, 0, 1:], ahead[rate] - states[rate][:, 1:], 0.0)
        assert np.max(np.abs(lost)) < 0.02 * np.max(np.abs(acting.amount))


def test_fits_get_along_a_bent_valley() -> None:
    """A damping couple and the dashpot of the layer do nearly the same; the way from one to the other is no long one.

    A fit that never dares a longer step crawls there, each iteration a hundredth of the way.
    """
    measured = measure(WALL, [recorded(1, (("viscous_damping.couple_damping", 3.0e5),))])
    one = misfit(measured)
    base = fit(one, start_of(one.unknowns), measured.states)
    (law,) = (c for c in candidates(measured, WALL) if c.name == "viscous_damping")
    reach = law.unknowns[0].bounds[1] - law.null
    ended = [further(extend(Explanation((), base), law, law.null + share * reach)) for share in (0.005, 0.05)]
    assert abs(ended[0].loss - ended[1].loss) < 0.5
    sizes = ended[0].fitted.values
    assert abs(sizes["viscous_damping.couple_damping"] / 3.0e5 - 1.0) < 0.1
    assert abs(sizes["base_damping"] - LAYERS["base_damping"]) < 0.7 * LAYERS["base_damping"]


def test_the_interval_of_a_layer_knows_what_a_law_beside_it_may_be() -> None:
    """What is told well is the slope under the load; how much of it is the stiffness depends on how it hardens."""
    measured = measure(WALL, [recorded(1, (("hardening.beta2", 20.0),))])
    (law,) = (c for c in candidates(measured, WALL) if [u.name for u in c.unknowns] == ["hardening.beta2"])
    one = misfit(measured)
    one = replace(one, unknowns=(*one.unknowns, *law.unknowns))
    true = {**TRUE, "hardening.beta2": 20.0}
    found = fit(one, np.array([x.coordinate(true[x.name]) for x in one.unknowns]), measured.states)
    k = [x.name for x in one.unknowns].index("base_stiffness")
    slope_alone = float(np.sqrt(at_least(*covariances(found))[k, k])) * one.unknowns[k].scale
    interval, drawn = estimates(found)["base_stiffness"], samples(found, 2000)
    assert interval.low95 < true["base_stiffness"] < interval.high95
    width = np.log(interval.high95 / interval.low95) / (2.0 * QUANTILE)
    assert width > 1.3 * slope_alone
    assert abs(np.std(np.log(drawn["base_stiffness"])) / width - 1.0) < 0.1
    assert np.corrcoef(drawn["base_stiffness"], drawn["hardening.beta2"])[0, 1] < -0.6
