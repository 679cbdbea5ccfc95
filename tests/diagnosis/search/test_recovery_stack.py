"""Two stacked blocks: dry friction and a table that pitches are seen by the screen and recovered by their own refit."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import models
from diagnosis.fit.intervals import covariances
from diagnosis.fit.linearisation import linearise_about
from diagnosis.fit.setup import base_fit, measure
from diagnosis.search.candidates import Candidate, candidates
from diagnosis.search.refit import Explanation, again, best_of, extend, with_memory
from diagnosis.search.screen import at, score
from grids.recordings.base import Recording
from tests.diagnosis.fit.test_two_blocks import NOISE, TRUE, WALL
from tests.diagnosis.made import TIME_STEP, motion

EFFECTS: dict[str, dict[str, float]] = {
    "coulomb_damping": {"over_m_g_b": 0.02},
    "table_pitch": {"pitch_per_acceleration": 0.0003, "low_pass_hz": 8.0},
}


def recorded(name: str, seed: int) -> Recording:
    """Both rotations with white noise of 1 % of their peaks."""
    base = motion(seed, pga=6.0)
    effect = {f"{name}.{parameter}": value for parameter, value in EFFECTS[name].items()}
    ran = models.get("stacked").simulate({**TRUE, **effect}, base, duration=base.duration)
    rng = np.random.default_rng(seed)
    channels = {"base_acceleration_x": base.horizontal}
    for channel in ("rotation_1", "rotation_2"):
        true = ran.channels[channel]
        channels[channel] = true + NOISE * np.max(np.abs(true)) * rng.normal(size=true.size)
    return Recording(f"run_{seed}", TIME_STEP, base.time, channels)


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
    before = base(name)
    seen = [s for s in score(linearise_about(before.fitted), own(name)) if s.starts]
    assert max(s.statistic for s in seen) > 15.0
    after = with_memory(best_of([again(extend(before, s.candidate, start)) for s in seen for start in s.starts]))
    assert before.loss - after.loss > 15.0
    unknown = after.candidates[0].unknowns[0]
    place = [x.name for x in after.fitted.misfit.unknowns].index(unknown.name)
    sandwich, laplace = covariances(after.fitted)
    deviation = np.sqrt(max(sandwich[place, place], laplace[place, place]))
    truth = unknown.coordinate(next(iter(EFFECTS[name].values())))
    assert abs(after.fitted.u[place] - truth) < 3.0 * deviation, (after.fitted.values[unknown.name], deviation)
