"""Effects that begin: found with their instants; recordings in which nothing begins are left alone."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from diagnosis.answer.when import may_change_again, stages_of, when_text
from diagnosis.errors.model import calibrated
from diagnosis.fit.linearisation import linearise_about
from diagnosis.fit.setup import measure
from diagnosis.progress import silent
from diagnosis.search import beginnings, in_spells
from diagnosis.search.beginnings import alone, beside, had_not_begun, others_in_the_spell
from diagnosis.search.candidates import candidates
from diagnosis.search.found import BADLY, MISSING, Search, adjusted, by_window
from diagnosis.search.null import null_distribution
from diagnosis.search.refit import Explanation, again, extend
from diagnosis.search.runs import InRuns
from diagnosis.search.screen import score
from diagnosis.search.select import first_effect, further_effects
from diagnosis.search.spells import Spell
from tests.diagnosis.made import SPECIMEN, scattered
from tests.diagnosis.search.changing import FEW, MODEL, made, searched


@pytest.mark.parametrize(
    ("name", "changes", "error"),
    [
        ("restitution", [(6.0, {"restitution.factor_on_housner": 0.9})], 0.0),
        ("offset", [(6.0, {})], 0.06),
    ],
)
def test_what_begins_in_the_second_recording_is_named_with_its_instant(
    name: str, changes: list[tuple[float, dict[str, float]]], error: float
) -> None:
    _, yielded = searched([made("a", 13, []), made("b", 6, changes, error)])
    assert yielded[-1].best is not None
    [candidate] = yielded[-1].best.candidates
    assert candidate.name == name and candidate.spell is not None
    assert candidate.spell.first == 1 and candidate.spell.ends is None and candidate.spell.last == 1
    stages = stages_of(yielded[-1].best, candidate)
    assert stages[0].begins == stages[0].ends == 0.0
    assert stages[1].begins == pytest.approx(6.0, abs=0.7)
    assert stages[1].begins_low95 is not None and stages[1].begins_high95 is not None
    assert stages[1].begins_low95 - 0.1 <= 6.0 <= stages[1].begins_high95 + 0.1
    assert when_text(stages).startswith("from ") and when_text(stages).endswith("of b on, and stays")


@pytest.mark.parametrize(("factor", "instant"), [(0.93, 4.0), (0.92, 5.0)])
def test_a_law_of_impacts_that_changes_is_found_where_the_base_bends_to_the_mean(factor: float, instant: float) -> None:
    """Errors estimated about the base take the change for scatter of impacts, and its score is nothing under these."""
    changed = made("b", 6, [(instant, {"restitution.factor_on_housner": factor})])
    _, yielded = searched([made("a", 13, []), changed], among=("restitution", "offset"))
    best = yielded[-1].best
    assert best is not None and best.names == ("restitution",)
    spell = best.candidates[0].spell
    assert spell is not None and (spell.first, spell.last, spell.ends) == (1, 1, None)
    assert spell.begins == pytest.approx(instant, abs=0.7)
    assert best.fitted.values["restitution.factor_on_housner"] == pytest.approx(factor, abs=0.015)


def test_what_acts_for_too_short_a_time_is_said_and_not_named() -> None:
    recordings = [
        made("a", 13, []),
        made("b", 6, [(4.0, {"viscous_damping.rate": 1.5}), (7.0, {"viscous_damping.rate": 0.0})]),
    ]
    found, yielded = searched(recordings, 10.0, ("viscous_damping", "tilt"))
    assert yielded == [] and found.best is None and found.blow is not None and found.blow.evidence > 20.0
    _, begins, _, _, ends, _, _, where = found.blow.stronger.split()
    assert float(begins) == pytest.approx(4.0, abs=0.7) and float(ends) == pytest.approx(7.0, abs=0.7)
    assert where == "b"


def test_nothing_begins_where_nothing_is_missing() -> None:
    _, yielded = searched([made("a", 13, []), made("b", 6, [])])
    assert yielded == []


def test_what_white_noise_shows_of_impacts_that_scatter_is_chance_and_of_a_law_that_changes_is_not() -> None:
    """Both are scatter to the errors about the base."""
    scatters = searched([scattered("a", 4, 0.02), scattered("b", 13, 0.02)], among=("restitution", "offset"))[0]
    changed = made("b", 6, [(5.0, {"restitution.factor_on_housner": 0.985})])
    changing = searched([made("a", 4, []), changed], among=("restitution", "offset"))[0]
    for found, hides in ((scatters, False), (changing, True)):
        assert found.errors.scatter > 0.005
        screened = in_spells.Screened.of(found, found.base, found.scores)
        largest = max(float(one.statistic.max()) for one in screened.in_runs[1])
        assert largest > 300.0 and screened.hides is hides


def test_what_always_acts_does_not_begin() -> None:
    """Even if the ordinary search has not named it."""
    from_rest = [(1.0, {"restitution.factor_on_housner": 0.93})]  # before anything moves
    _, yielded = searched([made("a", 13, from_rest), made("b", 6, from_rest)])
    assert yielded == []


def test_no_part_of_the_recordings_is_refitted_where_what_always_acts_explains_as_much(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """An effect that always acts says so in the windows before any instant: refits would be in vain."""

    def refitted(*_: object) -> Explanation:
        raise AssertionError("refitted in a part of the recordings")

    monkeypatch.setattr(in_spells, "in_run", refitted)
    always = [(1.0, {"restitution.factor_on_housner": 0.93})]
    searched([made("a", 13, always), made("b", 6, always)])
    late = [(6.0, {"restitution.factor_on_housner": 0.93})]
    with pytest.raises(AssertionError, match="in a part"):
        searched([made("a", 13, late), made("b", 6, always)])


def test_what_begins_early_is_found_where_it_explains_most_acting_always(monkeypatch: pytest.MonkeyPatch) -> None:
    """Then no run of windows stands out in the screen, and the single itself is asked where it acts."""
    monkeypatch.setattr(in_spells, "quick", lambda *_: iter(()))
    inset = {"pivot_inset.inset_over_half_width": 0.15}
    measured = measure(SPECIMEN, [made("a", 6, [(3.5, inset)]), made("b", 13, [(1.0, inset)])])
    fitted, errors = calibrated(SPECIMEN, measured)
    some = tuple(c for c in candidates(measured, SPECIMEN) if c.name in (*FEW, "pivot_inset"))
    found = Search(Explanation((), fitted), some, errors)
    opened = linearise_about(fitted)
    found.scores = score(opened, some)
    found.null = null_distribution(opened, found.scores)
    corner = next(c for c in some if c.name == "pivot_inset")
    always = again(extend(found.base, corner, np.array([corner.unknowns[0].coordinate(0.12)])))
    found.best, found.singles = always, [always]
    assert np.sum(by_window(always) > BADLY) == 1
    *_, last = alone(found, silent)
    assert last.best is not None and last.best.names == ("pivot_inset",)
    spell = last.best.candidates[0].spell
    assert spell is not None and (spell.first, spell.last, spell.ends) == (0, 1, None)
    assert spell.begins == pytest.approx(3.5, abs=0.5)
    assert last.best.fitted.values["pivot_inset.inset_over_half_width"] == pytest.approx(0.15, rel=0.05)


def test_the_strongest_against_white_noise_is_taken_along_however_little_it_gains_under_errors_that_hold_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A sensor that is knocked passes for noise that drifts: under the errors about the base it explains little."""
    found, yielded = searched([made("a", 13, []), made("b", 6, [(6.0, {})], 0.06)])
    assert yielded[-1].best is not None and yielded[-1].best.names == ("offset",)
    knocked = yielded[-1].best
    other = replace(knocked, candidates=(replace(knocked.candidates[0], mechanism=MODEL.mechanisms["tilt"]),))
    gains = {("tilt",): 1000.0, ("offset",): 100.0}
    screens = iter(([other], [knocked]))
    monkeypatch.setattr(in_spells, "quick", lambda *_: iter(next(screens)))
    monkeypatch.setattr(in_spells, "thorough", lambda single: single)
    monkeypatch.setattr(in_spells, "adjusted", lambda e: -gains.get(e.names, 0.0))
    screened = in_spells.Screened.of(found, found.base, found.scores)
    assert [e.names for e in in_spells.in_spells(found, found.base, screened)] == [("tilt",), ("offset",)]


@pytest.mark.parametrize(("begins", "counts"), [(3.0, True), (1.0, True), (None, False)])
def test_one_window_may_say_that_an_effect_had_not_begun_and_not_that_it_acts(
    begins: float | None, counts: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """All of the gain is in the first window, of a spell that begins after it, or within it, or that is it."""
    measured: Any = SimpleNamespace(
        windows=[SimpleNamespace(recording=0, first=k * 100, samples=101) for k in range(4)],
        recordings=[SimpleNamespace(name="a", time_step=0.02)],
    )
    always: Any = SimpleNamespace(measured=measured)
    single: Any = SimpleNamespace(measured=measured)
    spell = Spell(0, begins, 0, None if begins else 5.0)
    monkeypatch.setattr(beginnings, "gain_by_window", lambda *_: np.array([300.0, 1.0, 2.0, 0.0]))
    monkeypatch.setattr(beginnings, "adjusted", lambda e: 303.0 if e is always else 0.0)
    monkeypatch.setattr(beginnings, "settles", lambda *_: True)
    assert had_not_begun(always, single, spell) is counts
    monkeypatch.setattr(beginnings, "settles", lambda *_: False)
    assert not had_not_begun(always, single, spell)


def test_what_may_change_again_is_told_from_what_stays_or_is_gone() -> None:
    assert may_change_again(Spell(1, None, 1, None), 2)
    assert may_change_again(Spell(0, 2.0, 0, 5.0), 2)
    assert may_change_again(Spell(0, 2.0, 0, None), 2)
    assert not may_change_again(Spell(0, 2.0, 1, None), 2)
    assert not may_change_again(Spell(0, None, 1, 3.0), 2)


def test_what_takes_too_little_always_is_tried_in_the_spell_of_what_makes_up_for_it() -> None:
    """A dashpot in the first recording: as one that always acts and another law in the first it explains as much."""
    recordings = [made("a", 13, [(1.0, {"viscous_damping.rate": 0.3})]), made("b", 6, [])]
    measured = measure(SPECIMEN, recordings)
    fitted, _ = calibrated(SPECIMEN, measured)
    known = {c.name: c for c in candidates(measured, SPECIMEN)}
    dashpot, drag = known["viscous_damping"], replace(known["quadratic_damping"], spell=Spell(0, None, 0, None))
    always = extend(Explanation((), fitted), dashpot, np.array([dashpot.unknowns[0].coordinate(0.15)]))
    both = extend(always, drag, np.array([drag.unknowns[0].coordinate(1.0)]))
    (simpler,) = others_in_the_spell(both)
    assert simpler.names == ("viscous_damping",) and simpler.candidates[0].spell == drag.spell
    assert adjusted(simpler) < adjusted(both) + MISSING < adjusted(always)


def test_a_mechanism_without_a_slope_starts_in_a_run_from_what_was_tried() -> None:
    """It may explain nothing of all recordings and much of one: the search ended in an error there."""
    recordings = [made("first", 1, [(0.0, {})]), made("second", 2, [(0.0, {})])]
    measured = measure(SPECIMEN, recordings)
    known = [c for c in candidates(measured, SPECIMEN) if c.name == "sliding"]
    fitted, _ = calibrated(SPECIMEN, measured)
    (one,) = score(linearise_about(fitted), known)
    assert not one.slope and one.trial is not None
    without = InRuns(replace(one, starts=()), np.ones(1), np.zeros(1))
    assert [start.tolist() for start in without.starts(0)] == [one.trial.tolist()]


def test_one_of_two_effects_begins_and_the_other_acts_always() -> None:
    """Both named as acting always are no explanation, and the one that begins explains little without the other."""
    leans = {"tilt.tilt": 0.006}
    both = [(0.005, leans), (5.0, {**leans, "viscous_damping.rate": 0.5})]
    measured = measure(SPECIMEN, [made("a", 13, both[:1]), made("b", 6, both)])
    fitted, errors = calibrated(SPECIMEN, measured)
    some = tuple(c for c in candidates(measured, SPECIMEN) if c.name in FEW)
    found = Search(Explanation((), fitted), some, errors)
    for more in (first_effect, alone, further_effects, beside):
        for stage in more(found, silent):
            found = stage
    spells = {c.name: c.spell for c in found.chosen.candidates}
    begins = spells.pop("viscous_damping")
    assert spells == {"tilt": None} and isinstance(begins, Spell)
    assert (begins.first, begins.last, begins.ends) == (1, 1, None)
    assert begins.begins == pytest.approx(5.0, abs=0.3)
