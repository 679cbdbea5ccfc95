"""The missing force of a wall on rubber as a model: a law that no mechanism describes is found, and predicts."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from diagnosis.data.measured import Measured
from diagnosis.fit.misfit import Misfit
from diagnosis.fit.prediction import Predictor
from diagnosis.fit.setup import measure
from diagnosis.fit.solver import fit
from diagnosis.fit.whitening import sensor_noise_only
from diagnosis.search.refit import Explanation
from diagnosis.search.tables import Law, estimate
from models.mechanisms.table_force import OF_WALL
from models.tables import KNOTS, row
from tests.diagnosis.walls import TRUE, WALL, misfit, recorded

REACHES = {"reach_rotation_base": 0.02, "reach_rate_base": 0.3, "reach_velocity": 0.5}


def dotted(law: dict[str, float]) -> tuple[tuple[str, float], ...]:
    return tuple((f"{OF_WALL.name}.{name}", value) for name, value in (OF_WALL.nulls | REACHES | law).items())


ONE_SIDED = dotted({row("damping_base", "above", k): -0.6 * (k > 0) for k in range(KNOTS)})
DRAG = dotted({row("velocity_block", "above", k): -0.02 * k / (KNOTS - 1) for k in range(KNOTS)})


@cache
def base(law: tuple[tuple[str, float], ...]) -> Explanation:
    measured = measure(WALL, [recorded(seed, law) for seed in (1, 2)])
    one = misfit(measured)
    u = np.array([x.coordinate(TRUE[x.name]) for x in one.unknowns])
    return Explanation((), fit(one, u, measured.states))


def chi2(fitted: Misfit, values: dict[str, float], measured: Measured) -> float:
    """Squared misfit a sample on other windows, parameters frozen, states refitted."""
    predictor = Predictor(measured, coordinates=fitted.predictor.coordinates)
    alone = Misfit(predictor, sensor_noise_only(predictor), (), {**fitted.fixed, **values})
    found = fit(alone, np.zeros(0), measured.states)
    return float(np.sum(alone.residuals([found.point])[0] ** 2) / measured.count.sum())


def predicts(plain: Explanation, law: Law, hidden: tuple[tuple[str, float], ...]) -> tuple[float, float]:
    other = measure(WALL, [recorded(3, hidden)])
    first, then = plain.fitted, law.explanation.fitted
    return chi2(first.misfit, first.values, other), chi2(then.misfit, then.values, other)


@pytest.mark.parametrize(("hidden", "terms"), [(ONE_SIDED, {"damping_base"}), (DRAG, {"velocity_block", "rate_base"})])
def test_a_law_on_one_side_is_found_and_predicts(hidden: tuple[tuple[str, float], ...], terms: set[str]) -> None:
    """The block moves as one with the wall: a drag on it is like a couple in the base with the wall's velocity."""
    plain = base(hidden)
    law = estimate(plain)
    assert law is not None and law.tables[0].term in terms
    before, after = predicts(plain, law, hidden)
    assert before > 1.3 and (before - after) / (before - 1.0) > 0.7


def test_noise_alone_asks_for_no_law() -> None:
    assert estimate(base(())) is None
