"""Where the model at hand explains everything an effect can only be small: derivatives and white noise are enough."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from diagnosis.errors.model import calibrated
from diagnosis.fit.linearisation import Linearisation, linearise_about
from diagnosis.fit.misfit import Misfit
from diagnosis.fit.setup import measure
from diagnosis.progress import silent
from diagnosis.search import beside, in_spells, singles, weighing
from diagnosis.search.candidates import Candidate, candidates
from diagnosis.search.found import BADLY, Search, by_window, explains_all, passes_for_white
from diagnosis.search.refit import Explanation, extend
from diagnosis.search.screen import Score, score
from tests.diagnosis.made import SPECIMEN, recording


@pytest.fixture(scope="module")
def found() -> Search:
    """Of a block with a weak spring, without which the model still explains all windows."""
    effects = {"added_stiffness": {"over_m_g_R": 0.1, "gap": 0.01}}
    measured = measure(SPECIMEN, [recording(f"run_{seed}", seed, effects) for seed in (1, 2)])
    fitted, errors = calibrated(SPECIMEN, measured)
    assert explains_all(Explanation((), fitted))
    return Search(Explanation((), fitted), candidates(measured, SPECIMEN), errors)


@pytest.fixture(scope="module")
def opened(found: Search) -> Linearisation:
    return linearise_about(found.base.fitted)


def by_candidate(scores: list[Score]) -> dict[Candidate, Score]:
    return {one.candidate: one for one in scores}


def test_derivatives_find_what_values_find_in_fewer_runs(
    monkeypatch: pytest.MonkeyPatch, found: Search, opened: Linearisation
) -> None:
    """The refit of the strongest gains what its derivative says."""
    asked = []
    residuals = Misfit.residuals

    def counted(self: Misfit, points: Any, **rest: Any) -> Any:
        asked.append(len(points))
        return residuals(self, points, **rest)

    monkeypatch.setattr(Misfit, "residuals", counted)
    values = score(opened, found.candidates)
    of_values = sum(asked)
    asked.clear()
    slopes = score(opened, found.candidates, small=True)
    assert sum(asked) < 0.6 * of_values
    assert slopes[0].candidate.name == "added_stiffness" and slopes[0].statistic > 20.0
    assert slopes[0].statistic >= 0.95 * values[0].statistic
    strongest = slopes[0]
    gain = found.base.loss - extend(found.base, strongest.candidate, strongest.starts[0]).loss
    assert gain == pytest.approx(strongest.statistic, rel=0.2)


def test_the_shape_of_an_effect_is_looked_over_and_what_has_no_slope_is_tried_at_values(
    found: Search, opened: Linearisation
) -> None:
    values, slopes = (by_candidate(score(opened, found.candidates, small=small)) for small in (False, True))
    shaped = [c for c in found.candidates if len(c.unknowns) > 1 and slopes[c].slope]
    own = {candidate: _own(opened, candidate) for candidate in shaped}
    for candidate in shaped:
        assert slopes[candidate].statistic >= own[candidate] - 1e-9 * max(own[candidate], 1.0)
    assert any(slopes[candidate].statistic > own[candidate] + 1.0 for candidate in shaped)
    flat = [c for c in found.candidates if not values[c].slope]
    assert "sliding" in [c.name for c in flat]
    for candidate in flat:
        assert slopes[candidate].statistic == pytest.approx(values[candidate].statistic)
        assert not slopes[candidate].slope


def test_no_shape_is_run_twice(found: Search) -> None:
    """Two starts at one place would be two fits of the same."""
    shaped = [c for c in found.candidates if len(c.unknowns) > 1]
    assert shaped
    for candidate in found.candidates:
        shapes = [tuple(one) for one in candidate.shapes()]
        assert shapes[0] == tuple(candidate.null) and len(set(shapes)) == len(shapes)


@pytest.mark.parametrize("all_explained", [True, False])
def test_screens_go_by_slopes_alone_where_the_model_at_hand_explains_everything(
    monkeypatch: pytest.MonkeyPatch, found: Search, all_explained: bool
) -> None:
    asked: list[bool] = []

    def watched(screen: Linearisation, some: list[Candidate], refused: dict[str, str], small: bool) -> list[Score]:
        asked.append(small)
        return []

    for module in (singles, beside):
        monkeypatch.setattr(module, "score", watched)
        monkeypatch.setattr(module, "explains_all", lambda _: all_explained)
    monkeypatch.setattr(singles, "null_distribution", lambda *_: None)
    monkeypatch.setattr(singles, "passes_for_white", lambda *_: True)
    monkeypatch.setattr(singles, "in_turn", lambda *_: [])
    search = replace(found, singles=[], not_tried={})
    singles.take_further(search, singles.refit_singles(search, silent))
    beside.seconds(search, search.base)
    assert asked == [all_explained] * 2


def _own(opened: Linearisation, candidate: Candidate) -> float:
    """The score statistic at the null with the shapes as declared."""
    shapes = {x.name: x.value(float(c)) for x, c in zip(candidate.unknowns[1:], candidate.null[1:], strict=True)}
    alone = replace(candidate, unknowns=candidate.unknowns[:1], held={**candidate.held, **shapes})
    return score(opened, [alone], small=True)[0].statistic


def test_where_white_noise_explains_all_nothing_is_screened_or_fitted_against_it(
    monkeypatch: pytest.MonkeyPatch, found: Search
) -> None:
    def refuse(*_: Any) -> Any:
        raise AssertionError("white noise is all there is")

    assert passes_for_white(found.base, found.errors)
    for module in (singles, in_spells):
        monkeypatch.setattr(module, "against_white_noise", refuse)
    monkeypatch.setattr(weighing, "as_white_noise", refuse)
    search = replace(found, singles=[], not_tried={})
    singles.take_further(search, singles.refit_singles(search, silent))
    assert search.singles
    screened = in_spells.Screened.of(search, search.base, search.scores)
    assert len(screened.screens) == 1 and not screened.hides
    in_spells.in_spells(search, search.base, screened)


@pytest.mark.parametrize("name", ["delay", "gain"])
def test_where_a_mechanism_leaves_white_noise_none_is_sought_in_the_errors(
    monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    """Only where none does is there a screen against white noise."""
    asked: list[Explanation] = []

    def watched(_: Search, start: Explanation, some: list[Candidate]) -> tuple[None, list[Score]]:
        asked.append(start)
        return None, []

    effects = {"delay": {"delay": 0.012}}
    measured = measure(SPECIMEN, [recording(f"run_{seed}", seed, effects) for seed in (1, 2)])
    fitted, errors = calibrated(SPECIMEN, measured)
    known = tuple(one for one in candidates(measured, SPECIMEN) if one.name == name)
    search = Search(Explanation((), fitted), known, errors)
    assert not passes_for_white(search.base, search.errors)
    monkeypatch.setattr(singles, "against_white_noise", watched)
    singles.take_further(search, singles.refit_singles(search, silent))
    assert len(search.singles) == 1
    assert asked == ([] if name == "delay" else [search.base])


def test_one_window_that_white_noise_does_not_explain_is_enough_to_ask_it(found: Search) -> None:
    """It may be the only one in which an effect acts."""
    base = found.base
    misfit = base.fitted.misfit
    values = misfit.measured.values.copy()
    values[0] += 3.0 * misfit.measured.first_errors[0][:, None] * np.sin(np.arange(values.shape[-1]) / 3.0)
    predictor = replace(misfit.predictor, measured=replace(misfit.measured, values=values))
    shaken = replace(base, fitted=replace(base.fitted, misfit=replace(misfit, predictor=predictor)))
    assert by_window(shaken)[0] > BADLY
    assert not passes_for_white(shaken, found.errors)
