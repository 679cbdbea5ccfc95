"""Spells in the sequence of recordings, and the screen over runs of windows held against screens of spells."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import chi2

from diagnosis.fit.linearisation import linearise_about
from diagnosis.fit.whitening import Whitening
from diagnosis.search.runs import FEWEST, chance, in_runs, largest_by_chance, largest_run, runs
from diagnosis.search.screen import score
from diagnosis.search.spells import Spell, of_windows
from grids.stages import intervals
from tests.diagnosis.search.changing import opened, screened

NAMES = ("a", "b", "c")


@pytest.mark.parametrize(
    ("spell", "acting", "afterwards"),
    [
        (Spell(1, 4.2, 2, None), [(), ((4.2, np.inf),), ((0.0, np.inf),)], True),
        (Spell(0, None, 1, 3.0), [((0.0, np.inf),), ((0.0, 3.0),), ()], False),
        (Spell(1, None, 1, None), [(), ((0.0, np.inf),), ()], False),
        (Spell(0, 2.0, 0, 5.0), [((2.0, 5.0),), (), ()], False),
    ],
)
def test_a_spell_is_written_as_stages(
    spell: Spell, acting: list[tuple[tuple[float, float], ...]], afterwards: bool
) -> None:
    stages = spell.stages(NAMES)
    assert [intervals(stages, name) for name in NAMES] == acting
    assert bool(intervals(stages, "another motion")) is afterwards


def test_a_spell_of_windows_holds_these_and_no_other() -> None:
    measured, _ = opened()
    second = int(np.searchsorted(measured.recording_of, 1))
    for low, high in ((2, second - 1), (second - 2, second + 2), (second, len(measured.windows) - 1), (3, 5)):
        stages = of_windows(measured, low, high).stages(("a", "b"))
        for w, window in enumerate(measured.windows):
            recorded = measured.recordings[window.recording]
            middle = (window.first + window.samples / 2) * recorded.time_step
            acts = any(begins <= middle < ends for begins, ends in intervals(stages, recorded.name))
            assert acts is (low <= w <= high)


def test_a_run_has_the_statistic_of_the_mechanism_in_that_spell() -> None:
    measured, screen = opened()
    ends, compared = runs(len(measured.windows)), 0
    for one in in_runs(screen, screened(), ends):
        for k in range(0, len(ends), 17):
            low, high = ends[k].tolist()
            staged = replace(one.score.candidate, spell=of_windows(measured, low, high))
            [alone] = score(screen, [staged])
            along, information = screen.scores_with_residual(alone.column), screen.product(alone.column, alone.column)
            if information < 2.0 * FEWEST * np.einsum("w,wm->", screen.weights, one.score.column**2):
                continue
            compared += 1
            assert one.amplitude[k] == pytest.approx(-along / information, rel=1e-6)
            if one.score.side * along <= 0.0:
                assert one.statistic[k] == pytest.approx(along**2 / information, rel=1e-6)
    assert compared > 10


def test_chance_of_one_run_is_that_of_chi_squared_and_grows_with_their_number() -> None:
    measured, screen = opened()
    ends = runs(len(measured.windows))
    plain = [one for one in screened() if one.side == 0][:1]
    one = largest_by_chance(screen, plain, ends[:1])
    for probability in (0.5, 0.8, 0.95):
        drawn = float(np.quantile(one, probability))
        assert chi2.cdf(drawn, 1) == pytest.approx(probability, abs=4 * np.sqrt(probability * (1 - probability) / 1000))
    many = chance(screen, plain, ends)
    assert many > chance(screen, plain, ends[:1]) + 2.0
    assert chance(screen, screened(), ends) > many


def test_chance_is_that_of_the_errors_as_they_are() -> None:
    measured, screen = opened()
    ends, scores = runs(len(measured.windows)), screened()
    own, again = chance(screen, scores, ends), linearise_about(screen.fitted)
    misfit = screen.fitted.misfit
    assert again is not screen and chance(screen, scores, ends, again) == pytest.approx(own, rel=0.08)
    assert chance(screen, scores, ends, replace(again, weights=again.weights / 4.0)) == pytest.approx(4 * own, rel=0.08)

    def under(whitening: Whitening) -> float:
        fitted = replace(screen.fitted, misfit=replace(misfit, whitening=whitening))
        return chance(screen, scores, ends, replace(again, fitted=fitted))

    twice = replace(misfit.whitening, sensor=misfit.whitening.sensor / 2.0)
    assert under(twice) == pytest.approx(4.0 * own, rel=0.08)
    column = scores[0].column[..., None]  # an error that windows share looks as this mechanism does
    assert under(replace(misfit.whitening, shared=20.0 * column / np.linalg.norm(column))) > 10.0 * own


def test_the_largest_run_of_two_windows_at_least_is_the_one_with_the_largest_sum() -> None:
    rng = np.random.default_rng(0)
    for _ in range(20):
        values = rng.normal(size=9)
        sums = {(a, b): values[a : b + 1].sum() for a in range(9) for b in range(a + 1, 9)}
        assert largest_run(values) == max(sums, key=lambda ends: sums[ends])
