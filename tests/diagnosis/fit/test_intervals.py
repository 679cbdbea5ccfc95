"""A profile that finds a better optimum takes the fit there."""

from __future__ import annotations

import numpy as np

from diagnosis.fit.intervals import settled
from diagnosis.fit.setup import base_fit, measure
from diagnosis.fit.solver import fit
from tests.diagnosis.made import SPECIMEN, recording


def test_a_profile_leads_back_to_the_optimum() -> None:
    best = base_fit(SPECIMEN, measure(SPECIMEN, [recording("a", 1)]))
    stuck = fit(best.misfit, best.u + np.array([0.0, 1.5]), best.states, iterations=0)
    assert stuck.loss > best.loss + 1.0
    found, intervals = settled(stuck, ["width"])
    assert found.loss < best.loss + 0.5
    assert intervals["width"].low95 < best.values["width"] < intervals["width"].high95
    same, _ = settled(best, ["width"])
    assert same is best
