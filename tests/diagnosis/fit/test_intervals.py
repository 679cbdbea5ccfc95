"""A profile that finds a better optimum takes the fit there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diagnosis.fit.intervals import estimates, settled
from diagnosis.fit.setup import base_fit, measure
from diagnosis.fit.solver import Fitted, fit
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


def within(fitted: Fitted, low: float) -> Fitted:
    """The same fit with the width between ``low`` and twice its estimate."""
    unknowns = [
        replace(x, low=low, high=2.0 * fitted.values["width"]) if x.name == "width" else x
        for x in fitted.misfit.unknowns
    ]
    return replace(fitted, misfit=replace(fitted.misfit, unknowns=tuple(unknowns)))


def test_a_shape_follows_its_profile_where_its_symmetric_interval_leaves_the_range() -> None:
    best = base_fit(SPECIMEN, measure(SPECIMEN, [recording("a", 1)]))
    plain = estimates(best)["width"]
    roomy, near = within(best, 0.5 * plain.estimate), within(best, 0.5 * (plain.low95 + plain.estimate))
    assert estimates(roomy, (), ["width"]) == estimates(roomy)
    assert estimates(near, (), ["width"]) == estimates(near, ["width"]) != estimates(near)
