"""A fit of whole runs, which have no free states, with one unknown and with none."""

from __future__ import annotations

from dataclasses import replace

import pytest

from diagnosis.fit.setup import base_fit, measure
from tests.diagnosis.buildings import BEARINGS, SPECIMEN, made


@pytest.mark.parametrize("unknown", [True, False])
def test_a_building_with_one_unknown_or_none(unknown: bool) -> None:
    """Holding the only one, as a profile does, left nothing to take derivatives of."""
    wall = replace(
        SPECIMEN,
        parameters={**SPECIMEN.parameters, **BEARINGS},
        calibrate={},
        tolerance={"bearing_stiffness": 0.1} if unknown else {},
    )
    fitted = base_fit(wall, measure(wall, [made("a", 0.3, 1)]))
    linear = fitted.misfit.linearise(fitted.u, fitted.states)
    assert linear.by_state.shape == (*linear.residual.shape, 0)
    if unknown:
        assert fitted.values["bearing_stiffness"] == pytest.approx(BEARINGS["bearing_stiffness"], rel=0.02)
    else:
        assert fitted.u.size == 0 and linear.by_unknown.shape[:2] == linear.residual.shape
