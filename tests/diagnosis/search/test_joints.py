"""A law of both layers is found from where the same law in one of them stands."""

from __future__ import annotations

import numpy as np
import pytest

from diagnosis.errors.model import disturbance_about, estimate
from diagnosis.fit.setup import measure
from diagnosis.fit.solver import fit
from diagnosis.search import joints
from diagnosis.search.candidates import candidates
from diagnosis.search.found import Search, adequate
from diagnosis.search.joints import at_other_joints
from diagnosis.search.refit import QUICK, Explanation, extend
from tests.diagnosis.walls import MAXWELL, TRUE, WALL, misfit, recorded


def test_the_arm_of_one_layer_leads_to_those_of_both(monkeypatch: pytest.MonkeyPatch) -> None:
    measured = measure(WALL, [recorded(1, tuple(MAXWELL.items()))])
    one = misfit(measured)
    arms = [c for c in candidates(measured, WALL) if c.name == "maxwell"]
    both, of_top = arms[0], next(c for c in arms if c.unknowns[0].name.endswith("_top"))
    u = np.array([x.coordinate(TRUE[x.name]) for x in one.unknowns])
    base = Explanation((), fit(one, u, measured.states, QUICK))
    own = np.array([x.coordinate(MAXWELL[x.name.removesuffix("_top")]) for x in of_top.unknowns])
    leader = extend(base, of_top, own)
    assert not adequate(leader)
    found = Search(base, tuple(arms), estimate(base.fitted, disturbance_about(base.fitted)), singles=[leader])
    at_other_joints(found)
    first = found.singles[0]
    assert first.candidates == (both,) and adequate(first)
    assert first.fitted.values["maxwell.relaxation_time"] == pytest.approx(MAXWELL["maxwell.relaxation_time"], rel=0.1)
    assert leader in found.singles

    monkeypatch.setattr(joints, "extend", lambda *_: pytest.fail("the first explains all"))
    at_other_joints(found)
