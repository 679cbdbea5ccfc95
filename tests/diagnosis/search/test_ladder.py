"""Another base model is named where it is the right one, and nowhere else."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.signal import lfilter

import models
from diagnosis.answer.ladder import confirmed, other_model
from diagnosis.answer.result import Effect, Estimate
from diagnosis.errors.adequacy import Inadequacy
from diagnosis.errors.model import Errors, calibrated
from diagnosis.fit.growing import fit_from
from diagnosis.fit.setup import base_fit, measure
from diagnosis.fit.solver import AT_STUCK, WIDEST, Fitted, fit, scatter
from diagnosis.fit.starts import nominal
from diagnosis.fit.unknowns import of_specimen
from diagnosis.forces.columns import forces
from diagnosis.forces.constancy import About
from diagnosis.progress import silent
from diagnosis.report import extend
from diagnosis.report.extended import SEARCHED
from diagnosis.search import ladder
from diagnosis.search.budget import ENDED, Budget
from diagnosis.search.found import MISSING, Search, left_over_white_noise
from diagnosis.search.refit import Explanation
from grids.recordings.base import Recording
from grids.specimen import Specimen, parse_specimen
from grids.write_specimen import specimen_text
from models import get
from models.errors import InputError
from models.shaking import Shaking
from tests.diagnosis.made import TIME_STEP, motion
from tests.diagnosis.report.example import diagnosis
from tests.diagnosis.stacks import STILL, rocking_on_top

PIER = Specimen(
    "pier", "housner", {"width": 0.5, "height": 2.3, "mass": 1380.0}, {"width": 0.005, "height": 0.005, "mass": 0.01}
)
MAT = {
    "wall_length": 0.5, "wall_height": 1.15, "wall_mass": 690.0, "top_mass": 690.0, "top_length": 0.5,
    "top_height": 1.15, "layer_thickness": 0.01, "base_stiffness": 2e7, "base_damping_ratio": 0.06,
}  # fmt: skip


@cache
def recorded(model: str, rotations: int) -> Recording:
    strong = motion(1, duration=6.0, pga=4.0).horizontal
    base = Shaking(TIME_STEP, np.concatenate([np.zeros(round(STILL / TIME_STEP)), strong]))
    values, options = (MAT, {"joints": "base"}) if model == "interface" else (PIER.parameters, {})
    ran = models.get(model).simulate(values, base, duration=base.duration, options=options)
    rng = np.random.default_rng(3)
    rotation = np.asarray(ran.channels["rotation_1"])
    channels = {"base_acceleration_x": base.horizontal}
    for body in range(1, 1 + rotations):
        noise = rng.normal(size=rotation.size)
        channels[f"rotation_{body}"] = rotation + 0.01 * np.max(np.abs(rotation)) * noise
    return Recording("run", TIME_STEP, base.time, channels)


def blown(seed: int, at: float) -> Recording:
    """A pier whose base receives a blow that the recorded motion does not hold."""
    base = motion(seed, duration=6.0, pga=3.0)
    time = base.time
    hit = Shaking(base.time_step, base.horizontal + 1.0 * ((time > at) & (time < at + 0.12)))
    rotation = models.get("housner").simulate(PIER.parameters, hit, duration=base.duration).channels["rotation_1"]
    noise = np.random.default_rng(seed).normal(size=rotation.size)
    channels = {
        "base_acceleration_x": base.horizontal,
        "rotation_1": rotation + 0.01 * np.max(np.abs(rotation)) * noise,
    }
    return Recording(f"run_{seed}", base.time_step, time, channels)


@cache
def calibrated_fit(model: str, rotations: int) -> tuple[Fitted, Errors]:
    return calibrated(PIER, measure(PIER, [recorded(model, rotations)]))


def test_other_base_models_are_left_out_once_the_work_of_an_answer_is_done() -> None:
    fitted, errors = calibrated_fit("interface", 1)
    found = Search(Explanation((), fitted), (), errors, whole=Budget(-1.0))
    assert ladder.rungs(found, PIER, [], 0, silent) == []
    assert found.not_tried and set(found.not_tried.values()) == {ENDED}


def test_rubber_under_a_pier_is_named_with_its_stiffness_and_the_answer_is_a_specimen() -> None:
    fitted, errors = calibrated_fit("interface", 1)
    found = Search(Explanation((), fitted), (), errors)
    pier = PIER.parameters
    rung = next(r for r in fitted.measured.identification.ladder if r.bonded)
    below = [ladder._plain(found.base)]
    tried = [(rung, ladder._weighed(ladder._fitted(rung, PIER, below, *below, fitted.measured.recordings, 0)))]
    climbed = confirmed(ladder.climb(found, tried, decisive=False), fitted.measured)
    assert climbed is not None and climbed.rung is rung and climbed.evidence > 3.0 * MISSING and climbed.inadequate
    about = forces(climbed.after.chosen.fitted)  # none in the joint that is bonded
    assert {kind.port.name for kind in about.kinds} == {"base", "block"}
    assert all(np.all(np.isfinite(about.column(kind))) and np.any(about.column(kind)) for kind in about.kinds)
    assert ladder.climb(found, tried, decisive=True) is not None
    with pytest.MonkeyPatch.context() as patch:  # a law outside the library: pairs of mechanisms are still to be tried
        patch.setattr(About, "flags", lambda about, threshold: about.tested[:1])
        assert ladder.climb(found, tried, decisive=True) is None
        assert ladder.climb(found, tried, decisive=False) is not None
    other = other_model(climbed, climbed.after.chosen)
    assert other.parameters["base_stiffness"] == pytest.approx(MAT["base_stiffness"], rel=0.15)
    assert other.parameters["base_damping_ratio"] == pytest.approx(MAT["base_damping_ratio"], rel=0.4)
    assert other.parameters["wall_mass"] + other.parameters["top_mass"] == pytest.approx(pier["mass"], rel=0.03)
    own = {p.name: other.parameters[p.name] for p in rung.parameters}
    estimates = {name: Estimate(value, 0.95 * value, 1.05 * value, "1") for name, value in own.items()}
    effect = Effect(rung.name, rung.name, estimates, 100.0, 1e-6)
    extended = extend(PIER, replace(diagnosis(), other_model=other, effects=(effect,)))
    read = parse_specimen(specimen_text(extended))
    assert read.model == rung.model and read.options == rung.options and read.parameters == extended.parameters
    # diagnosed again, what the laboratory knows keeps its tolerance, and what was searched may move
    assert read.tolerance["base_stiffness"] == read.tolerance["base_damping_ratio"] == SEARCHED
    assert read.tolerance["wall_length"] == pytest.approx(PIER.tolerance["width"], rel=0.01)
    assert read.nominal["wall_length"] == pytest.approx(PIER.parameters["width"])
    assert {x.name for x in of_specimen(read, get(read.model))} >= {"base_stiffness", "wall_length"}


def test_a_block_that_is_one_stays_one_whatever_is_tried(monkeypatch: pytest.MonkeyPatch) -> None:
    """Both rotations of one body are alike: a joint in it, which may open, and rubber explain no more."""
    fitted, errors = calibrated_fit("housner", 2)
    assert fitted.measured.channels == ("rotation_1", "rotation_2")
    found = Search(Explanation((), fitted), (), errors)
    monkeypatch.setattr(ladder, "_asked", lambda _: True)
    tried = ladder.rungs(found, PIER, [], 0, silent)
    assert {rung.name for rung, _ in tried} | set(found.not_tried) == {"second_body", "compliant_base"}
    assert all(why == ladder.WORSE for why in found.not_tried.values())
    two = ladder._misfit(fitted.measured.identification.ladder[0], PIER, fitted.measured, fitted.measured.recordings)
    base = ladder._plain(found.base)
    states = (len(two.measured.free) - len(fitted.measured.free)) * len(fitted.measured.windows)
    # a joint that stays closed gains less than the states that it starts the windows from cost
    assert base.loss - fit_from(two, [nominal(two), ladder._origin(two, base)]).loss < ladder.PER_STATE * states
    assert ladder.climb(found, tried, decisive=False) is None
    assert all(one.over(ladder._as_found(found))[0] < 0.0 for _, one in tried)


def test_another_base_model_is_given_up_where_it_is_far_from_what_was_found(monkeypatch: pytest.MonkeyPatch) -> None:
    fitted, _ = calibrated_fit("housner", 2)
    rung = next(r for r in fitted.measured.identification.ladder if ladder._meant_for(r, fitted.measured.recordings))
    base = ladder._plain(Explanation((), fitted))
    better = replace(base, fitted=replace(base.fitted, loss=0.1 * base.loss))
    reached: list[Fitted] = []

    def noted(*asked: Any) -> Fitted:
        reached.append(fit_from(*asked))
        return reached[-1]

    monkeypatch.setattr(ladder, "fit_from", noted)
    with pytest.raises(InputError, match=ladder.WORSE):
        ladder._fitted(rung, PIER, [base], better, fitted.measured.recordings, 0)
    assert reached and all(one.measured.mask.sum() < 0.6 * fitted.measured.mask.sum() for one in reached)


def test_a_rung_goes_on_from_what_the_one_below_has_found() -> None:
    fitted, _ = calibrated_fit("housner", 2)
    one, two = (r for r in fitted.measured.identification.ladder if ladder._meant_for(r, fitted.measured.recordings))
    base = ladder._plain(Explanation((), fitted))
    below = ladder._fitted(one, PIER, [base], base, fitted.measured.recordings, 0)
    misfit = ladder._misfit(two, PIER, base.measured, fitted.measured.recordings)
    origin = ladder._origin(misfit, below)
    known = [x.name for x, is_known in zip(misfit.unknowns, origin.known, strict=True) if is_known]
    assert known == ["width", "height", "mass", "compliant_base.joint_over_height"]
    joint = misfit.point(origin.u, origin.states).values["compliant_base.joint_over_height"]
    assert joint == pytest.approx(below.fitted.values["second_body.joint_over_height"])
    assert set(misfit.measured.free) == set(below.measured.free)
    order = [below.measured.free.index(name) for name in misfit.measured.free]
    assert np.array_equal(origin.states, below.fitted.states[:, order])


def test_nothing_is_tried_where_the_base_model_explains_the_recordings() -> None:
    fitted, errors = calibrated_fit("housner", 2)
    found = Search(Explanation((), fitted), (), errors)
    assert ladder.rungs(found, PIER, [], 0, silent) == [] and not found.not_tried


def test_nothing_is_tried_where_noise_that_is_coloured_explains_what_is_left() -> None:
    """White noise of the sensor would leave more than twice as much; rubber under the pier is asked for."""
    plain = recorded("housner", 1)
    peak = float(np.max(np.abs(plain.channels["rotation_1"])))
    slow = lfilter([np.sqrt(1.0 - 0.9**2)], [1.0, -0.9], np.random.default_rng(5).normal(size=plain.time.size))
    channels = {**plain.channels, "rotation_1": plain.channels["rotation_1"] + 0.01 * peak * slow}
    fitted, errors = calibrated(PIER, measure(PIER, [replace(plain, channels=channels)]))
    found = Search(Explanation((), fitted), (), errors)
    assert left_over_white_noise(found.base, errors) > 2.0 > ladder.LEFT
    assert ladder.rungs(found, PIER, [], 0, silent) == [] and not found.not_tried
    fitted, errors = calibrated_fit("interface", 1)
    assert ladder._asked(Search(Explanation((), fitted), (), errors))


@pytest.mark.parametrize(
    ("left", "deviance", "scatter", "fits", "judged", "asked"),
    [
        (3.0, 0.0, 0.01, True, True, False),
        (3.0, 4.0, 0.01, True, True, True),
        (3.0, 0.0, 0.03, True, True, True),
        (3.0, 0.0, 0.01, False, True, True),
        (3.0, 0.0, 0.01, True, False, True),
        (1.2, 4.0, 0.03, False, False, False),
    ],
)
def test_what_asks_for_another_base_model(
    left: float, deviance: float, scatter: float, fits: bool, judged: bool, asked: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A smooth error beyond chance or untold, scatter at its bound, or a misfit; nothing where little is left."""
    monkeypatch.setattr(ladder, "left_over_white_noise", lambda *_: left)
    monkeypatch.setattr(ladder, "inadequacy", lambda _: Inadequacy((0.0,), 0.5, deviance, judged))
    monkeypatch.setattr(ladder, "adequate", lambda _: fits)
    found: Any = SimpleNamespace(chosen=None, errors=SimpleNamespace(scatter=scatter, most_scatter=0.0285))
    assert ladder._asked(found) is asked


def test_rungs_that_cannot_be_tried_say_why() -> None:
    switched_on = replace(PIER, mechanisms={"bounce": {"contact_restitution": 0.1}})
    for rung in models.get("housner").identification.ladder:  # type: ignore[union-attr]
        assert "bounce does not act on model" in ladder._refusal(rung, switched_on)
        assert not ladder._refusal(rung, PIER)
        fits = ladder._meant_for(rung, [recorded("housner", 1)]), ladder._meant_for(rung, [recorded("housner", 2)])
        assert fits in [(True, True), (True, False), (False, True)]


AS_BLOCK = Specimen(
    "wall", "housner",
    {"width": 0.354, "height": 1.41, "mass": 455.0, "top_mass": 200.0, "top_mass_height": 0.465,
     "top_mass_inertia": 200.0 * (0.236**2 + 0.93**2) / 12.0},
    {"width": 0.005, "height": 0.005, "mass": 0.01},
)  # fmt: skip


@pytest.mark.parametrize("both", [True, False])
def test_what_rocks_on_the_block_is_found_where_it_stands(both: bool) -> None:
    """Its valley is narrow: windows of full length end at motions with other events, and the joint elsewhere."""
    recordings = [rocking_on_top(seed, both) for seed in (1, 2)]
    base = ladder._plain(Explanation((), base_fit(AS_BLOCK, measure(AS_BLOCK, recordings))))
    rung = base.measured.identification.ladder[0]
    found = ladder._fitted(rung, AS_BLOCK, [base], base, recordings, 0).fitted
    samples = float(found.measured.count.sum())
    assert found.loss - samples < 0.1 * (base.loss - samples)
    assert found.values["second_body.joint_over_height"] == pytest.approx(1.0, abs=0.01)


def test_states_that_no_channel_shows_are_scattered_as_far_as_they_are() -> None:
    """The upper body's, which begin as the lower one's: it rocks several times as far."""
    recordings, shown = ([rocking_on_top(seed, both) for seed in (1, 2)] for both in (False, True))
    measured = measure(AS_BLOCK, recordings)
    rung = measured.identification.ladder[0]
    m = ladder._misfit(rung, AS_BLOCK, measured, recordings).measured
    k = m.free.index("rotation_2")
    true = np.array([shown[w.recording].channels["rotation_2"][w.first] for w in m.windows])
    assert np.mean(np.abs(true - m.states[:, k]) < 2.0 * WIDEST * m.state_size[k]) > 0.7


def test_a_stuck_window_ends_no_worse_than_from_where_it_was_measured() -> None:
    """Scattered as widely as states are that no channel shows, few start where the bodies move as one."""
    recordings = [rocking_on_top(seed, False) for seed in (1, 2)]
    measured = measure(AS_BLOCK, recordings)
    plain = ladder._misfit(measured.identification.ladder[0], AS_BLOCK, measured, recordings)
    start = ladder._with(plain, nominal(plain), {"second_body.joint_over_height": 1.0})
    best = fit(plain, start.u, plain.measured.states, 0).frozen
    from_measured = fit(best, np.zeros(0), plain.measured.states, AT_STUCK)
    for first in range(2):  # every other window is moved away
        apart = from_measured.states.copy()
        apart[first::2] += 4.0 * plain.measured.state_size
        found = fit(best, np.zeros(0), apart, 0)
        states = scatter(found, 0)
        assert states is not None
        scattered = fit(best, np.zeros(0), states, 0).window_losses
        stuck = scattered != found.window_losses
        assert stuck.sum() > 2 and np.all(scattered[stuck] < from_measured.window_losses[stuck] + 1.0)


def test_a_blow_to_the_base_in_every_recording_is_no_second_body() -> None:
    """States that are free in its window fit it, and every other window gains by the smaller errors alone."""
    fitted, errors = calibrated(PIER, measure(PIER, [blown(seed, at) for seed, at in ((5, 3.9), (6, 4.5))]))
    found, recordings = Search(Explanation((), fitted), (), errors), fitted.measured.recordings
    rung = next(r for r in fitted.measured.identification.ladder if ladder._meant_for(r, recordings))
    below = [ladder._plain(found.base)]
    tried = ladder._weighed(ladder._fitted(rung, PIER, below, *below, recordings, 0))
    gain, without_one = tried.over(ladder._as_found(found))
    assert rung.name == "second_body" and gain > without_one > found.more
    assert ladder.climb(found, [(rung, tried)], decisive=False) is None


def test_of_each_recording_one_window_is_no_hindrance(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without the window that weighs most of them all; else another base model could never be named there."""
    fitted, errors = calibrated_fit("housner", 2)
    found = Search(Explanation((), fitted), (), errors)
    weighed = ladder._as_found(found)
    count = len(fitted.measured.windows)
    monkeypatch.setattr(ladder, "gain_by_window", lambda before, after: np.arange(1.0, count + 1.0))
    assert ladder._elsewhere(found, weighed) == pytest.approx(sum(range(1, count)))
    windows = tuple(replace(window, recording=k) for k, window in enumerate(fitted.measured.windows))
    apart = replace(fitted.measured, windows=windows)
    moved = replace(fitted, misfit=replace(fitted.misfit, predictor=replace(fitted.misfit.predictor, measured=apart)))
    alone = replace(found, base=Explanation((), moved))
    monkeypatch.setattr(ladder, "reweighed", lambda explanation, errors: explanation)
    assert ladder._elsewhere(alone, weighed) == pytest.approx(sum(range(1, count)))
