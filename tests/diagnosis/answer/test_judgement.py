"""What a search amounts to: p-values with shapes paid for, what stays undecided, what explains nothing."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from diagnosis.answer import heldout, judgement
from diagnosis.errors.adequacy import Inadequacy
from diagnosis.fit.setup import base_fit, measure
from diagnosis.forces.constancy import Constancy
from diagnosis.progress import Stages
from diagnosis.search.found import MISSING, Search
from diagnosis.search.null import LEAST_P, Null
from diagnosis.search.refit import Explanation
from models.errors import InputError
from tests.diagnosis.made import SPECIMEN, TIME_STEP, recording

NO_ERRORS: Any = None
SMALL = Inadequacy((0.0,), 0.0, 0.0, True)
NULL = Null(np.sort(np.random.default_rng(0).chisquare(1, 20_000)), 1.0)


def candidate(name: str, shapes: int = 0) -> Any:
    return SimpleNamespace(
        name=name, effect_class=name, unknowns=(None,) * (1 + shapes), held={}, spell=None, price=0.0
    )


def explanation(window_losses: list[float], *candidates: Any) -> Explanation:
    losses = np.array(window_losses)
    return Explanation(candidates, SimpleNamespace(loss=float(losses.sum()), window_losses=losses))  # type: ignore[arg-type]


def search(*singles: Explanation, best: Explanation | None = None, windows: int = 4) -> Search:
    return Search(explanation([100.0] * windows), (), NO_ERRORS, null=NULL, singles=list(singles), best=best)


def test_shapes_are_paid_for() -> None:
    plain, shaped = candidate("a"), candidate("b", shapes=2)
    found = search(best=explanation([90.0] * 4, plain, shaped))
    chances = judgement.p_of_effects(found, [9.0, 9.0], found.chosen.candidates)
    assert chances == [NULL.p_value(9.0), NULL.p_value(5.0)] and chances[0] < chances[1]
    assert judgement.p_of_effects(found, [], ()) == []  # a law in a table stands in the place of both


def test_of_two_effects_the_stronger_one_tells_the_chance_not_their_sum() -> None:
    found = search(best=explanation([90.0] * 4, candidate("a"), candidate("b")))
    assert judgement.p_of_missing(found, [9.0, 12.0], SMALL, (), (), True) == NULL.p_value(12.0) > NULL.p_value(21.0)


def test_no_chance_is_told_beyond_what_anyone_tested() -> None:
    assert NULL.p_value(600.0) < LEAST_P == judgement.p_value(search(), 600.0)


def test_a_large_error_of_the_model_is_as_unlikely_as_its_deviance() -> None:
    large, faint = Inadequacy((1.0,), 4.0, 40.0, True), Inadequacy((0.1,), 0.2, 40.0, True)
    assert large.large and not faint.large
    found = search(explanation([100.0] * 4, candidate("a")))
    assert judgement.p_of_missing(found, [], large, (), (), True) == LEAST_P
    assert judgement.p_of_missing(found, [], faint, (), (), True) == 1.0


def test_what_is_not_the_same_everywhere_is_as_unlikely_as_its_evidence() -> None:
    found = search(explanation([100.0] * 4, candidate("a")))
    one = Constancy("restitution", "window", 17.0)
    assert judgement.p_of_missing(found, [], SMALL, (one,), (), True) == NULL.p_value(17.0) < 0.05


def test_a_suspect_that_is_refused_does_not_make_a_faint_doubt_certain() -> None:
    """It rests on one window, by far beyond chance; what speaks against the model is hardly."""
    found = search(explanation([100.0, 100.0, 100.0, 40.0], candidate("a")))
    faint = Constancy("restitution", "amplitude", 17.0)
    assert judgement.p_of_missing(found, [], SMALL, (), (), True) == LEAST_P
    assert judgement.p_of_missing(found, [], SMALL, (faint,), (), True) == NULL.p_value(17.0) > LEAST_P


def test_what_a_stopped_search_did_not_test_has_no_p_value() -> None:
    single = explanation([90.0] * 4, candidate("a"))
    assert judgement.p_of_missing(search(single), [], SMALL, (), (), finished=False) is None
    assert judgement.p_of_missing(search(single), [], SMALL, (), (), finished=True) == LEAST_P
    assert judgement.p_of_missing(Search(explanation([1.0]), (), NO_ERRORS), [], SMALL, (), (), finished=True) is None


@pytest.mark.parametrize(
    ("losses", "rests_on"),
    [([100.0, 100.0, 100.0, 60.0], "one window"), ([88.0, 88.0, 88.0, 100.0], "one recording"), ([97.0] * 4, "")],
)
def test_a_suspect_refused_says_what_it_rests_on(losses: list[float], rests_on: str) -> None:
    suspect = explanation(losses, candidate("saturation"))
    found = search(suspect)
    left_open = judgement.undecided(found, judgement.p_of_missing(found, [], SMALL, (), (), True))
    assert left_open is not None and (left_open.name, left_open.rests_on) == ("saturation", rests_on)
    assert left_open.gain == 400.0 - sum(losses) and (left_open.gain >= MISSING) == bool(rests_on)


def test_what_chance_brings_is_not_undecided() -> None:
    found = search(explanation([99.9] * 4, candidate("a")))
    assert judgement.undecided(found, judgement.p_of_missing(found, [], SMALL, (), (), True)) is None


@pytest.mark.parametrize(("share", "explained"), [(0.05, True), (0.6, True), (0.8, False), (1.3, False)])
def test_a_model_explains_when_less_than_half_of_the_squares_is_left(share: float, explained: bool) -> None:
    values = np.random.default_rng(1).normal(size=(5, 2, 80))
    mask = np.ones(values.shape, bool)
    shown: Any = SimpleNamespace(measured=SimpleNamespace(values=values, mask=mask), after=(1.0 - share) * values)
    assert judgement.explains(shown) is explained


@pytest.mark.parametrize(("noise", "free"), [(1e-6, True), (0.01, False)])
def test_a_recording_without_noise_is_known(noise: float, free: bool) -> None:
    measured = measure(SPECIMEN, [recording("test_1", 3, noise=noise)])
    shown = heldout.Shown(measured, measured.values, measured.values, None, None)  # type: ignore[arg-type]
    assert heldout.fit_figures(shown, True).noise_free is free


@pytest.mark.parametrize(
    ("rise", "spell", "told"), [(0.9, None, False), (1.04, None, False), (1.3, None, True), (1.3, "then", False)]
)
def test_what_predicts_recordings_held_out_worse_is_not_the_explanation(
    rise: float, spell: str | None, told: bool
) -> None:
    measured = measure(SPECIMEN, [recording("test_1", 3, noise=0.01)])
    error = np.random.default_rng(2).normal(size=measured.values.shape)
    shown = heldout.Shown(measured, measured.values + error, measured.values + rise * error, None, None)  # type: ignore[arg-type]
    named = candidate("coulomb_damping")
    named.spell = spell
    found = search(best=explanation([90.0] * 4, named))
    against = judgement.contradicted(found, shown)
    assert (against is not None) is told
    if against is not None:
        assert against[1] == pytest.approx(rise * against[0])
        assert judgement.verdict_of(found, [], True, True, True) == "not_in_library"
    assert judgement.contradicted(search(), shown) is None


def test_ctrl_c_costs_the_stage_and_those_after_it() -> None:
    def interrupted() -> str:
        raise KeyboardInterrupt

    stages = Stages()
    assert stages.optional("first", lambda: "done", lambda: "instead") == "done"
    assert stages.optional("second", interrupted, lambda: "instead") == "instead"
    assert stages.optional("third", lambda: "done", lambda: "instead") == "instead"
    assert stages.skipped == ["second", "third"]
    assert stages.needed(lambda: "done") == "done"
    with pytest.raises(KeyboardInterrupt):
        stages.needed(interrupted)


def test_a_stage_that_cannot_be_done_costs_itself_alone() -> None:
    def refused() -> str:
        raise InputError("a run cannot be cut there")

    stages = Stages()
    assert stages.optional("first", refused, lambda: "instead") == "instead"
    assert stages.optional("second", lambda: "done", lambda: "instead") == "done"
    assert stages.failed == {"first": "a run cannot be cut there"} and not stages.skipped and not stages.stopped


def test_a_needed_stage_is_begun_anew_once() -> None:
    presses = [KeyboardInterrupt()]

    def stage() -> str:
        if presses:
            raise presses.pop()
        return "done"

    stages = Stages()
    assert stages.needed(stage) == "done" and stages.stopped


@pytest.mark.parametrize("windows", [1, 2])
def test_more_than_one_window_far_from_the_noise_is_no_explanation(windows: int) -> None:
    """The likelihood counts them by their logarithm only; a single one may be an event that was misread."""
    measured = measure(SPECIMEN, [recording("a", 1)])
    fitted = base_fit(SPECIMEN, measured)
    assert judgement.unfit_windows(Search(Explanation((), fitted), (), NO_ERRORS)) == ()
    m = fitted.measured
    shaken = np.zeros(m.values.shape)
    for w in (2, 5)[:windows]:
        length = m.windows[w].samples
        shaken[w, 0, :length] = 4.0 * (w + 1) * m.units[w, 0] * np.sin(np.linspace(0.0, 40.0, length))
    predictor = replace(fitted.misfit.predictor, measured=replace(m, values=m.values + shaken))
    disturbed = replace(fitted, misfit=replace(fitted.misfit, predictor=predictor))
    found = judgement.unfit_windows(Search(Explanation((), disturbed), (), NO_ERRORS))
    assert len(found) == windows and found[0].misfit > judgement.ALONE
    assert judgement.far_from_noise(found) is (windows > 1)
    assert (judgement.p_of_doubts(search(), SMALL, (), found) == [LEAST_P]) is (windows > 1)
    if windows > 1:
        assert found[0].misfit > found[1].misfit > 3.0 and found[0].recording == "a"
        assert found[0].start == pytest.approx(m.windows[5].first * TIME_STEP)
        clean = judgement.p_of_missing(search(), [], SMALL, (), found, True)
        assert clean == LEAST_P and judgement.verdict_of(search(), [], True, True, True) == "not_in_library"
