"""Mechanisms refitted alone: none leads by a window that it happens to free, each counts along its own motion."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy as np
import pytest

from diagnosis.data.measured import Measured
from diagnosis.errors.model import Errors, calibrated, disturbance_about, estimate
from diagnosis.fit.setup import base_fit, measure
from diagnosis.fit.solver import Fitted, fit
from diagnosis.fit.starts import nominal
from diagnosis.progress import silent
from diagnosis.search import refit, singles, weighing
from diagnosis.search.budget import Budget
from diagnosis.search.candidates import Candidate, candidates
from diagnosis.search.evidence import evidence
from diagnosis.search.found import BEHIND, Search, adjusted, enough, explains_all, lost_in_a_window, within_reach
from diagnosis.search.refit import Explanation, extend, from_states_of, with_memory
from diagnosis.search.singles import COSTLY, THRESHOLD, in_turn, led_by, refit_singles, take_further
from diagnosis.search.weighing import Judged, led_by_each_other, reweighed
from models.base import FloatArray
from tests.diagnosis import buildings
from tests.diagnosis.made import SPECIMEN, recording

AWAY = -8.0
"""Rates from which windows end in other minima, over the scatter of the states' own."""


@pytest.fixture(scope="module")
def free() -> Search:
    """With a mechanism that is there and one that is not, refitted alone."""
    measured = measure(SPECIMEN, [recording("a", 4, {"delay": {"delay": 0.004}})])
    some = {one.name: one for one in candidates(measured, SPECIMEN) if one.name in ("delay", "gain")}
    first = base_fit(SPECIMEN, measured)
    errors = estimate(first, disturbance_about(first))
    base = reweighed(Explanation((), first), errors)
    return Search(
        base, tuple(some.values()), errors, singles=[extend(base, some[name], some[name].null) for name in some]
    )


def stuck(explanation: Explanation) -> Explanation:
    f = explanation.fitted
    states = f.states.copy()
    states[:, 1] += AWAY * f.measured.state_size[1]
    return replace(explanation, fitted=fit(f.misfit, f.u, states))


def test_what_frees_a_window_leads_the_base_and_all_others_out_of_it(free: Search) -> None:
    late, gain = sorted(free.singles, key=lambda e: e.names[0] == "gain")
    found = replace(free, base=stuck(free.base), singles=[gain, stuck(late)])
    assert found.gain(gain) > 1000.0 and found.gain(found.singles[1]) < found.gain(gain) - 500.0
    assert led_by(found, gain)
    assert found.base.loss < free.base.loss + 0.5
    assert found.singles[0].names == ("delay",)
    assert found.gain(found.singles[0]) == pytest.approx(free.gain(late), abs=1.0)


def test_a_base_that_is_not_stuck_stays(free: Search) -> None:
    found = replace(free, singles=list(free.singles))
    assert not led_by(found, free.singles[0])
    assert found.base is free.base and found.singles == free.singles


def test_a_model_that_is_stuck_is_led_by_the_states_of_another(free: Search) -> None:
    late, gain = sorted(free.singles, key=lambda e: e.names[0] == "gain")
    off = stuck(late)
    assert off.loss > late.loss + 100.0
    led = from_states_of(off, [off, gain])
    assert led.loss == pytest.approx(late.loss, abs=0.5)
    assert from_states_of(late, [off, gain]) is late and from_states_of(late, []) is late


def test_what_explains_more_is_told_though_its_fit_was_stuck(free: Search) -> None:
    """Its errors were estimated where it was stuck, and are again where it is not."""
    late, gain = sorted(free.singles, key=lambda e: e.names[0] == "gain")
    own = [(e, estimate(e.fitted, free.errors.base, free.errors)) for e in (stuck(late), gain)]
    judged = [Judged(errors.loss, e, errors) for e, errors in own]
    assert judged[0].loss > judged[1].loss
    led = led_by_each_other(judged, free.errors.base, Budget())
    assert led[0].loss < judged[1].loss - 15.0 and led[0].explanation.names == ("delay",)
    hopeless = judged[0]._replace(loss=judged[0].loss + 1e6)
    assert led_by_each_other([hopeless, judged[1]], free.errors.base, Budget())[0] is hopeless


def worse_in(explanation: Explanation, by: dict[int, float]) -> Explanation:
    f = explanation.fitted
    losses = f.window_losses.copy()
    for window, loss in by.items():
        losses[window] += loss
    return replace(explanation, fitted=replace(f, window_losses=losses, loss=f.loss + sum(by.values())))


def test_what_is_out_of_reach_by_one_window_may_have_lost_its_way_there(free: Search) -> None:
    (late,) = (e for e in free.singles if e.names == ("delay",))
    assert explains_all(late)
    assert lost_in_a_window(worse_in(late, {2: 10.0 * BEHIND}), late)
    assert lost_in_a_window(worse_in(late, {2: 10.0 * BEHIND, 0: 0.8 * BEHIND}), late)
    assert not lost_in_a_window(worse_in(late, {2: 10.0 * BEHIND, 0: 1.2 * BEHIND}), late)
    assert not lost_in_a_window(worse_in(late, {2: 0.9 * BEHIND}), late)  # it is within reach


def test_a_single_that_lost_its_way_in_one_window_is_fitted_again(
    monkeypatch: pytest.MonkeyPatch, free: Search
) -> None:
    """Though it explains less than what is taken from the leader's optimum: that window decides nothing."""
    late, gain = sorted(free.singles, key=lambda e: e.names[0] == "gain")
    lost = worse_in(replace(late, candidates=gain.candidates), {2: 10.0 * BEHIND})
    monkeypatch.setattr(singles, "over_ranges", lambda one: one)
    monkeypatch.setattr(singles, "reshaped", lambda one: one)
    for name in ("at_other_joints", "_may_hide"):
        monkeypatch.setattr(singles, name, lambda _: False)
    monkeypatch.setattr(singles, "led_by", lambda *_: False)
    monkeypatch.setattr(singles, "in_its_place", lambda *_: None)
    monkeypatch.setattr(singles, "from_other", lambda one, *_: one)
    monkeypatch.setattr(singles, "_refit_in_turn", lambda found, *_: found.singles.extend([late, lost]) or [])
    taken: list[Explanation] = []
    monkeypatch.setattr(singles, "again", lambda one: taken.append(one) or one)
    found = replace(free, singles=[])
    take_further(found, refit_singles(found, silent))
    assert [one is late for one in taken] == [True, False] and taken[1] is lost


def without_restarts(monkeypatch: pytest.MonkeyPatch) -> None:
    """A single's first fits alone, none of what takes the leader further."""
    for name in ("again", "over_ranges", "reshaped"):
        monkeypatch.setattr(singles, name, lambda one: one)
    monkeypatch.setattr(singles, "led_by", lambda *_: False)


def test_what_the_fit_of_the_base_did_astray_does_not_lead_a_single(
    monkeypatch: pytest.MonkeyPatch, free: Search
) -> None:
    """Where it misfits it is fitted from the specimen's own numbers and the measured states too, its errors anew."""
    without_restarts(monkeypatch)
    (late,) = (e for e in free.singles if e.names == ("delay",))
    found = replace(free, base=stuck(free.base), candidates=late.candidates, singles=[])
    assert found.base.loss > free.base.loss + 1000.0
    take_further(found, refit_singles(found, silent))
    assert reweighed(found.base, free.errors).loss < free.base.loss + 0.5
    whitening = found.base.fitted.misfit.whitening
    assert found.errors is not free.errors and whitening.sensor is found.errors.whitening.sensor
    assert found.gain(found.singles[0]) == pytest.approx(free.gain(late), rel=0.1)


def test_what_is_far_behind_a_single_that_explains_everything_is_not_fitted_to_its_end(
    monkeypatch: pytest.MonkeyPatch, free: Search
) -> None:
    """Nor as if the sensors' errors were white."""
    late, gain = sorted(free.singles, key=lambda e: e.names[0] == "gain")
    given: list[float] = []
    white: list[str] = []

    def watched(
        begin: Explanation, candidate: Candidate, start: FloatArray, iterations: int, most: float
    ) -> Explanation:
        given.append(most)
        known = late if candidate.name == "delay" else gain
        return replace(known, fitted=replace(known.fitted, loss=100.0 if known is late else 900.0))

    def by_white(one: Explanation, _: Errors) -> Explanation:
        white.append(one.names[0])
        return one

    without_restarts(monkeypatch)
    monkeypatch.setattr(refit, "extend", watched)
    monkeypatch.setattr(weighing, "by_white_noise", by_white)
    monkeypatch.setattr(singles, "from_other", lambda one, *_: one)
    monkeypatch.setattr(singles, "with_memory", lambda one: one)
    base = replace(free.base, fitted=replace(free.base.fitted, loss=1000.0))
    found = replace(free, base=base, singles=[])
    take_further(found, refit_singles(found, silent))
    assert given[0] == np.inf and given[-1] == pytest.approx(100.0 + BEHIND)
    assert white == ["delay"]


def test_a_base_that_declared_numbers_do_not_better_stays_and_singles_begin_at_both(
    monkeypatch: pytest.MonkeyPatch, free: Search
) -> None:
    without_restarts(monkeypatch)
    began: list[Explanation] = []

    def watched(begin: Explanation, *rest: Any) -> Explanation:
        began.append(begin)
        return extend(begin, *rest)

    (late,) = (e for e in free.singles if e.names == ("delay",))
    off = stuck(free.base)
    monkeypatch.setattr(refit, "extend", watched)
    monkeypatch.setattr(singles, "further", lambda declared: replace(declared, fitted=replace(off.fitted, loss=1e9)))
    found = replace(free, base=off, candidates=late.candidates, singles=[])
    take_further(found, refit_singles(found, silent))
    assert found.base is off
    own, declared = (one.fitted for one in list({id(one): one for one in began}.values()))
    assert own is off.fitted and np.array_equal(declared.states, off.measured.states)
    assert np.array_equal(declared.u, nominal(off.fitted.misfit).u)
    assert found.singles[0].loss == pytest.approx(late.loss, abs=1.0)


@pytest.mark.parametrize(("behind", "reached"), [(BEHIND - 1.0, True), (BEHIND + 1.0, False)])
def test_what_is_far_behind_an_explanation_of_everything_is_no_rival(
    free: Search, behind: float, reached: bool
) -> None:
    (late,) = (e for e in free.singles if e.names == ("delay",))
    later = replace(late, fitted=replace(late.fitted, loss=late.loss + behind))
    assert explains_all(late) and within_reach(later, late) == reached
    off = stuck(late)
    assert not explains_all(off) and within_reach(later, off)  # which leaves something itself
    assert enough([later, late]) == pytest.approx(adjusted(late) + BEHIND)
    assert enough([off]) == np.inf


def test_evidence_is_of_the_best_fit_of_an_effect_whatever_its_first_one_was(free: Search) -> None:
    """It may have come in the place of another one; with the first fit it was named with an evidence of 0, p = 1."""
    (late,) = (e for e in free.singles if e.names == ("delay",))
    off = replace(late, fitted=replace(late.fitted, loss=free.base.loss + 3.0))
    found = replace(free, best=late, tried=[late], at_null=replace(free, tried=[off]))
    assert evidence(found)[0] == pytest.approx(free.gain(late), rel=0.02)
    assert free.gain(late) > 15.0


def test_every_law_with_a_memory_counts_events_along_its_own_motion() -> None:
    """Not along the base model's, which bounces otherwise: half as many here."""
    effect = {"restitution": {"factor_on_housner": 0.92}}
    measured = measure(SPECIMEN, [recording(f"run_{seed}", seed, effect) for seed in (1, 2)])
    fitted, errors = calibrated(SPECIMEN, measured)
    predictor = fitted.misfit.predictor
    fewer = {**fitted.measured.memory, "impacts": 0.5 * fitted.measured.memory["impacts"]}
    predictor = replace(predictor, measured=replace(fitted.measured, memory=fewer))
    fitted = replace(fitted, misfit=replace(fitted.misfit, predictor=predictor))
    some = tuple(one for one in candidates(measured, SPECIMEN) if one.name in ("restitution", "degradation"))
    found = Search(Explanation((), fitted), some, errors)
    take_further(found, refit_singles(found, silent))
    assert [single.names[0] for single in found.singles] == ["restitution", "degradation"]
    lossy, worn = found.singles
    assert with_memory(worn).loss > worn.loss - 0.5
    assert with_memory(lossy) is lossy  # it remembers no impacts: nothing is fitted again


@pytest.mark.parametrize(
    ("known", "near", "refitted", "began"),
    [
        (("viscous_damping", "gain", "coulomb_damping"), 2.0, False, False),
        (("viscous_damping", "gain", "coulomb_damping"), 0.0, True, False),
        (("gain", "coulomb_damping"), 2.0, True, True),
    ],
    ids=["explained", "explained but near", "not explained"],
)
def test_costly_fits_are_left_out_where_another_explains_all(
    monkeypatch: pytest.MonkeyPatch, known: tuple[str, ...], near: float, refitted: bool, began: bool
) -> None:
    """Of a mechanism of many short steps, unless it comes near in the screen; from measured states in any case."""
    measured = measure(
        SPECIMEN, [recording(f"run_{seed}", seed, {"viscous_damping": {"rate": 0.15}}) for seed in (1, 2)]
    )
    fitted, errors = calibrated(SPECIMEN, measured)
    some = {one.name: one for one in candidates(measured, SPECIMEN) if one.name in known}
    at_measured: list[str] = []
    monkeypatch.setattr(singles, "heavy", lambda entry, _: entry.candidate.name == "coulomb_damping")
    monkeypatch.setattr(singles, "NEAR_HEAVY", near)
    monkeypatch.setattr(singles, "misfits", lambda *_: True)
    monkeypatch.setattr(singles, "setting_in", lambda *_: [some["coulomb_damping"]])
    monkeypatch.setattr(singles, "from_measured", lambda _, candidate: at_measured.append(candidate.name) or [])
    found = Search(Explanation((), fitted), tuple(some.values()), errors)
    take_further(found, refit_singles(found, silent))
    assert ("coulomb_damping" in [single.names[0] for single in found.singles]) == refitted
    assert bool(at_measured) == began
    assert found.not_tried == ({} if refitted else {"coulomb_damping": COSTLY})


def test_costly_fits_are_left_out_where_whole_runs_are_compared_too(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing is given up on its way there, but what another explains everything without is not begun."""
    effect = {"viscous_damping": {"rate": 0.15}}
    measured = measure(SPECIMEN, [recording(f"run_{seed}", seed, effect) for seed in (1, 2)])
    fitted, errors = calibrated(SPECIMEN, measured)
    known = ("viscous_damping", "coulomb_damping")
    some = tuple(one for one in candidates(measured, SPECIMEN) if one.name in known)
    without_restarts(monkeypatch)
    monkeypatch.setattr(singles, "heavy", lambda entry, _: entry.candidate.name == "coulomb_damping")
    monkeypatch.setattr(singles, "NEAR_HEAVY", 2.0)
    monkeypatch.setattr(singles, "explains_all", lambda *_: True)
    monkeypatch.setattr(Measured, "stretches", property(lambda _: (), lambda *_: None), raising=False)
    found = Search(Explanation((), fitted), some, errors)
    take_further(found, refit_singles(found, silent))
    assert found.not_tried == {"coulomb_damping": COSTLY}


def test_what_sets_in_at_a_threshold_is_said_not_to_be_tried_where_another_explains_all(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Unless a variant of it was."""
    measured = measure(
        SPECIMEN, [recording(f"run_{seed}", seed, {"viscous_damping": {"rate": 0.15}}) for seed in (1, 2)]
    )
    fitted, errors = calibrated(SPECIMEN, measured)
    some = {one.name: one for one in candidates(measured, SPECIMEN) if one.name in ("viscous_damping", "gain")}
    twin = replace(some["viscous_damping"], price=1.0)
    monkeypatch.setattr(singles, "misfits", lambda *_: True)
    monkeypatch.setattr(singles, "setting_in", lambda *_: [some["gain"], twin])
    monkeypatch.setattr(singles, "starts_of", lambda e, _: () if e.candidate in (some["gain"], twin) else e.starts)
    found = Search(Explanation((), fitted), (*some.values(), twin), errors)
    take_further(found, refit_singles(found, silent))
    assert found.not_tried == {"gain": THRESHOLD}


def test_fits_of_whole_runs_are_taken_further_though_nothing_is_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    body = Explanation(
        (), base_fit(buildings.SPECIMEN, measure(buildings.SPECIMEN, [buildings.made("small", 1.0, 1)]), 0)
    )
    taken = []

    def further(*at: object) -> Fitted:
        taken.append(at)
        return body.fitted

    monkeypatch.setattr(refit, "fit_thoroughly", further)
    assert with_memory(body) is body and len(taken) == 1


def test_the_strongest_of_the_screen_come_before_what_has_no_slope_there() -> None:
    """A refit of a law that sets in at a threshold may cost the whole budget; laws at further joints come last."""

    class Law(NamedTuple):
        name: str
        joints: str = ""

    ordered = [Law("maxwell", "both"), Law("maxwell", "base"), *(Law(x) for x in ("bouc_wen", "gain", "locking"))]
    entries: dict[Law, Any] = {
        one: SimpleNamespace(candidate=one, work=1.0, statistic=1000.0 if k < 2 else 100.0)
        for k, one in enumerate((*ordered, Law("sliding")))
    }
    late = [entries[Law("locking")], entries[Law("sliding")]]
    found = in_turn([entries[one] for one in ordered], late, list(entries.values()))
    names = [(entry.candidate.name, entry.candidate.joints) for entry in found]
    first = [("maxwell", "both"), ("bouc_wen", ""), ("locking", ""), ("sliding", ""), ("gain", "")]
    assert names == [*first, ("maxwell", "base")]
    entries[Law("locking")].work = 100.0
    found = in_turn([entries[one] for one in ordered], late, list(entries.values()))
    assert found[-1] is entries[Law("locking")]


def test_at_most_four_that_are_strong_come_before_what_has_no_slope() -> None:
    class Effect(NamedTuple):
        name: str

    entries: list[Any] = [
        SimpleNamespace(candidate=Effect(name), work=100.0 if name == "c" else 1.0, statistic=1000.0 - 10.0 * k)
        for k, name in enumerate("abcdef")
    ]
    found = in_turn(entries[:5], entries[5:], entries)
    assert "".join(entry.candidate.name for entry in found) == "abcdfe"
