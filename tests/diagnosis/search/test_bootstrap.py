"""The bootstrap's draws have the estimated errors; its tail is that of the draws."""

from __future__ import annotations

from contextlib import nullcontext
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.stats import chi2

from diagnosis.errors.draws import draw
from diagnosis.errors.model import calibrated
from diagnosis.fit.linearisation import linearise_about
from diagnosis.fit.setup import measure
from diagnosis.fit.solver import fit
from diagnosis.search.bootstrap import p_value, tail_probability
from diagnosis.search.candidates import candidates
from diagnosis.search.found import Search
from diagnosis.search.null import LEAST_P, null_distribution
from diagnosis.search.refit import Explanation
from diagnosis.search.screen import score
from models.errors import InputError
from tests.diagnosis.answer.searched import among
from tests.diagnosis.buildings import SPECIMEN as BUILDING
from tests.diagnosis.buildings import made
from tests.diagnosis.made import SPECIMEN, recording


@cache
def null(restitution: float = 1.0) -> Search:
    acting = {} if restitution == 1.0 else {"restitution": {"factor_on_housner": restitution}}
    measured = measure(SPECIMEN, [recording("train_1", 1, acting)])
    fitted, errors = calibrated(SPECIMEN, measured)
    return Search(Explanation((), fitted), candidates(measured, SPECIMEN), errors)


def test_whitened_draws_are_white() -> None:
    """Of variance one, less the floor of white noise that is not drawn."""
    base, errors = null().base.fitted, null().errors
    rng = np.random.default_rng(5)
    drawn = base.misfit.whitening(np.stack([draw(errors, base.measured, rng) for _ in range(150)]))
    inside = base.measured.compared.reshape(len(base.measured.windows), -1)
    assert np.mean(drawn[:, inside] ** 2) == pytest.approx(0.985, abs=0.025)


def test_draws_of_whole_runs_hold_the_error_of_the_model_itself() -> None:
    """Of a building the largest part: without it everything that was found would be beyond chance."""
    measured = measure(BUILDING, [made("small", 1.0, 1), made("large", 2.5, 2)])
    errors = calibrated(BUILDING, measured)[1]
    own = np.array([c.kind == "inadequacy" for c in errors.components])
    rms = []
    for variance in (0.0, 4.0):
        given = replace(errors, theta=np.where(own, variance, errors.theta))
        drawn = draw(given, measured, np.random.default_rng(3))[measured.mask] / errors.unit[0]
        rms.append(float(np.mean(drawn**2)))
    assert rms[1] - rms[0] == pytest.approx(4.0 * own.sum(), rel=0.5)


def test_one_sided_tests_count_on_the_side_on_which_their_effect_may_lie() -> None:
    """The same test written with the other sign of its coordinate is the same test, and no second chance."""
    found = null()
    opened = linearise_about(found.base.fitted)
    one = next(s for s in score(opened, found.candidates) if s.side == 1)
    mirrored = replace(one, column=-one.column, side=-1)
    alone, both = (null_distribution(opened, some) for some in ([one], [one, mirrored]))
    assert both.band == pytest.approx(alone.band, rel=0.05) and alone.band < 3.0


def test_scores_of_draws_are_those_of_chance() -> None:
    base, errors = null().base.fitted, null().errors
    predictor, m = base.misfit.predictor, base.measured
    motion = predictor.predict([base.point])[0]
    rng = np.random.default_rng(8)
    found = []
    for _ in range(8):
        values = np.where(m.mask, motion + draw(errors, m, rng), 0.0)
        made = replace(base.misfit, predictor=replace(predictor, measured=replace(m, values=values)))
        again = fit(made, base.u, base.states)
        found += [
            s.statistic for s in score(linearise_about(again), candidates(m, SPECIMEN)) if not s.candidate.one_sided
        ]
    assert 0.5 < np.mean(found) < 1.8


def test_the_tail_goes_on_where_the_draws_end() -> None:
    gains = chi2.ppf((np.arange(99) + 0.5) / 99, 1)
    for scale, beyond in ((1.0, 12.0), (1.0, 20.0), (3.0, 40.0), (0.5, 8.0)):
        assert 0.5 < tail_probability(beyond, scale * gains) / chi2.sf(beyond / scale, 1) < 2.0
    many = chi2.ppf(((np.arange(99) + 0.5) / 99) ** 0.1, 1)  # the largest of ten
    assert 0.5 < tail_probability(20.0, many) / (10.0 * chi2.sf(20.0, 1)) < 2.0
    alike = 1e4 + gains  # far out and close together
    assert LEAST_P <= tail_probability(1e4 + 30.0, alike) < 0.25
    assert tail_probability(12.0, gains) > tail_probability(20.0, gains)
    assert tail_probability(1e4, gains) == LEAST_P
    assert tail_probability(0.0, gains) == 1.0
    assert tail_probability(1e4, gains[:9]) == 0.1


def test_what_is_missing_is_beyond_every_draw_and_what_is_not_within() -> None:
    """With two draws p is a third if the recording gains more than any of them: without an effect once in three."""
    with among(("restitution", "viscous_damping", "tilt", "offset")):
        found, missing = (p_value(SPECIMEN, null(factor), 2, 9, lambda text, share: None) for factor in (1.0, 0.95))
    assert missing == 1 / 3 < found


@pytest.mark.parametrize("restitution", [1.0, 0.9])
def test_draws_tell_nothing_of_what_their_search_does_not_find(restitution: float) -> None:
    """An effect that begins, say: their gains are not those of the answer."""
    found = null(restitution)
    with pytest.raises(InputError, match="does not find") if restitution == 1.0 else nullcontext():
        assert p_value(SPECIMEN, replace(found, best=found.base), 1, 0, lambda *_: None) == 0.5
