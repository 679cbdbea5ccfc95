"""A law that acts for a while in each recording: its intervals are found, in others too, and it predicts them."""

from __future__ import annotations

from dataclasses import asdict, replace

import numpy as np
import pytest

from diagnosis.answer.when import as_stages, comes_and_goes, held_stages
from diagnosis.errors.model import disturbance_about, refitted
from diagnosis.fit.misfit import Misfit
from diagnosis.fit.prediction import Predictor
from diagnosis.fit.solver import fit
from diagnosis.fit.whitening import sensor_noise_only
from diagnosis.search.for_a_while import asking, exact
from diagnosis.search.law import for_a_while, missing_law
from diagnosis.search.refit import Explanation
from diagnosis.search.spells import LASTS, NEVER, InEach, in_spell
from diagnosis.search.tables import Law
from grids.stages import Stage
from models.mechanisms.table_force import MECHANISM
from models.tables import KNOTS, SIDES, row
from tests.diagnosis.search.hidden_law import base, windows

DASHPOT = MECHANISM.nulls | {row("damping", side, k): -1.2 for side in SIDES for k in range(KNOTS)}
WHEN = {1: (2.0, 4.6), 2: (3.3, 6.0), 3: (4.25, 6.7)}
"""s, by the seed of a recording."""


def acting(*seeds: int) -> dict[str, tuple[Stage, ...]]:
    return {"table_force": tuple(Stage(f"run_{seed}", *WHEN[seed]) for seed in seeds)}


@pytest.fixture(scope="module")
def law() -> Law:
    plain = base(windows((1, 2), DASHPOT, 0, acting(1, 2)))
    fitted, errors = refitted(plain.fitted, disturbance_about(plain.fitted))
    found = missing_law(Explanation((), fitted), Explanation((), fitted), errors)
    assert found is not None
    return found


def test_a_dashpot_that_engages_in_each_recording_is_found(law: Law) -> None:
    assert [one.recording for one in law.stages] == ["run_1", "run_2"]
    for one, seed in zip(law.stages, (1, 2), strict=True):
        assert one.begins == pytest.approx(WHEN[seed][0], abs=0.7) or seed == 1  # it rocks from 2.7 s on
        assert one.ends == pytest.approx(WHEN[seed][1], abs=0.7)
    assert "It comes and goes in each recording" in comes_and_goes([asdict(one) for one in law.stages])[0]


def test_another_recording_says_when_it_acts_there_and_is_predicted(law: Law) -> None:
    other = windows((3,), DASHPOT, 1, acting(3))
    predictor = Predictor(other)
    fitted = law.explanation.fitted
    misfit = Misfit(predictor, sensor_noise_only(predictor), (), {**fitted.misfit.fixed, **fitted.values})
    (held,) = held_stages(law.explanation, misfit, other.states)
    assert held.found_there and held.effect == "table_force"
    assert held.begins == pytest.approx(WHEN[3][0], abs=0.2)  # its windows begin at 3.8 and 4.7 s
    assert held.ends == pytest.approx(WHEN[3][1], abs=1.0)

    def chi2(stages: dict[str, tuple[Stage, ...]]) -> float:
        acts = replace(misfit, predictor=replace(predictor, stages=stages))
        found = fit(acts, np.zeros(0), other.states)
        return float(np.sum(acts.residuals([found.point])[0] ** 2) / other.count.sum())

    never = chi2({"table_force": (Stage("run_3", *NEVER),)})
    assert never > 1.5 and (never - chi2(dict(as_stages([held])))) / (never - 1.0) > 0.7


def test_a_recording_in_which_nothing_asks_for_it_is_left_alone(law: Law) -> None:
    other = windows((3,), MECHANISM.nulls, 1)
    predictor = Predictor(other)
    fitted = law.explanation.fitted
    misfit = Misfit(predictor, sensor_noise_only(predictor), (), {**fitted.misfit.fixed, **fitted.values})
    (held,) = held_stages(law.explanation, misfit, other.states)
    assert (held.begins, held.ends) == NEVER


def test_the_run_that_asks_ends_with_its_recording() -> None:
    m = windows((1, 2), MECHANISM.nulls, 0)
    own = np.flatnonzero(m.recording_of == 1)
    gained = np.full(len(m.windows), -1.0)
    gained[own[2:]] = 10.0
    begins, ends = asking(m, 1, gained, 15.0)
    assert begins == m.windows[own[2]].first * m.recordings[1].time_step and ends == LASTS
    assert asking(m, 0, gained, 15.0) == NEVER
    staged = in_spell(base(m).fitted.misfit, "table_force", InEach((NEVER, (begins, ends))))
    assert staged.predictor.stages["table_force"][1] == Stage("run_2", begins, LASTS)


def test_what_always_acts_does_not_come_and_go() -> None:
    plain = base(windows((1, 2), DASHPOT, 0))
    _, errors = refitted(plain.fitted, disturbance_about(plain.fitted))
    law = for_a_while(plain, errors)
    assert law is not None and law.stages == ()


def test_a_recording_without_a_window_keeps_its_interval(law: Law) -> None:
    """Nothing in it tells an instant; it ended in an index out of bounds."""
    fitted = law.explanation.fitted
    first = fitted.misfit.of_windows(np.flatnonzero(fitted.measured.recording_of == 0))
    interval = (1.0, 6.0)
    assert exact(first.undisturbed, law.mechanism.name, fitted.states[:0], 1, interval) == interval
