"""Windows that are stuck far from where they were measured are found again."""

from __future__ import annotations

import pytest

from diagnosis.fit.setup import base_fit, measure
from diagnosis.fit.solver import fit, fit_thoroughly
from tests.diagnosis.made import SPECIMEN, recording


@pytest.mark.parametrize(("seed", "away"), [(1, 8.0), (4, -4.0)])
def test_windows_stuck_far_from_the_measured_states_come_back(seed: int, away: float) -> None:
    """Rates ``away`` times the scatter of the states' own: motions with other events, each in a minimum of its own."""
    best = base_fit(SPECIMEN, measure(SPECIMEN, [recording("a", seed)]))
    states = best.states.copy()
    states[:, 1] += away * best.measured.state_size[1]
    assert fit(best.misfit, best.u, states).loss > best.loss + 1000.0
    assert fit_thoroughly(best.misfit, best.u, states).loss < best.loss + 0.5
