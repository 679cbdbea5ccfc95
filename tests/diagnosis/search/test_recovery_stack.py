"""Two stacked blocks: dry friction and a table that pitches are seen by the screen and recovered by their own refit."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from diagnosis.fit.linearisation import linearise_about
from diagnosis.fit.setup import base_fit, measure
from diagnosis.search.candidates import Candidate, candidates
from diagnosis.search.refit import Explanation
from diagnosis.search.screen import at, score
from grids.recordings.base import Recording
from tests.diagnosis.fit.test_two_blocks import WALL, recording
from tests.diagnosis.search.recovered import assert_recovered

EFFECTS: dict[str, dict[str, float]] = {
    "coulomb_damping": {"over_m_g_b": 0.02},
    "table_pitch": {"pitch_per_acceleration": 0.0003, "low_pass_hz": 8.0},
}


def recorded(name: str, seed: int) -> Recording:
    return recording(seed, {f"{name}.{parameter}": value for parameter, value in EFFECTS[name].items()})


@cache
def base(name: str) -> Explanation:
    return Explanation((), base_fit(WALL, measure(WALL, [recorded(name, seed) for seed in (1, 2)]), 0))


def own(name: str) -> list[Candidate]:
    return [c for c in candidates(base(name).measured, WALL) if c.name == name]


@pytest.mark.parametrize("name", EFFECTS)
def test_the_direction_of_the_score_is_a_finite_difference(name: str) -> None:
    fitted = base(name).fitted
    opened = linearise_about(fitted)
    for found in score(opened, own(name)):
        null, step = found.candidate.null, np.zeros(len(found.candidate.unknowns))
        step[0] = 0.01
        # of friction there is none on the other side
        back = null if found.candidate.one_sided else null - step
        r = fitted.misfit.residuals([at(fitted.point, found.candidate, u) for u in (null + step, back)])
        wanted = opened.reduced((r[0] - r[1]) / (null + step - back)[0])[0]
        # the statistic knows the direction alone; where an impact comes or goes within a step there is no derivative
        along = np.sum(found.column * wanted) / (np.linalg.norm(found.column) * np.linalg.norm(wanted))
        assert along > 0.99


@pytest.mark.parametrize("name", EFFECTS)
def test_a_simulated_effect_is_seen_and_recovered(name: str) -> None:
    assert_recovered(base(name), own(name), next(iter(EFFECTS[name].values())))
