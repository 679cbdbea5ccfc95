"""What a mechanism does, as the rows of a table: the values with which the table would do the same."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from diagnosis.answer.missing_force import missing_force
from diagnosis.errors.model import calibrated
from diagnosis.fit.setup import measure
from diagnosis.fit.solver import fit
from diagnosis.forces.columns import motions_of
from diagnosis.progress import Stages
from diagnosis.search.candidates import candidates
from diagnosis.search.refit import Explanation, extend
from diagnosis.search.tables import Table
from grids.specimen import Specimen
from models.base import Mechanism
from models.errors import InputError
from models.interface.table import units
from models.mechanisms.table_force import OF_WALL
from models.tables import KNOTS
from tests.diagnosis.made import SPECIMEN, recording
from tests.diagnosis.walls import TRUE, WALL, misfit, recorded

RATE, COUPLE, SPRING = 0.6, 4.0e3, 3.0e5


def curves(
    base: Explanation, specimen: Specimen, mechanism: Mechanism, name: str, size: float, reaches: dict[str, float]
) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """By term, rows and what a mechanism of a size does at those that were visited."""
    one = next(c for c in candidates(base.measured, specimen) if c.name == name)
    u = one.null
    u[0] = one.unknowns[0].coordinate(size)
    nearest = extend(base, one, u, 0)
    tables = []
    for term, reach in reaches.items():
        side = np.linspace(0.0, reach, KNOTS)
        at = np.concatenate([-side[::-1], side])
        tables.append(Table(term, at, 0.0 * at, 0.0 * at, 0.0 * at, 20.0))
    law: Any = SimpleNamespace(mechanism=mechanism, tables=tables, values={}, stages=(), oscillator={})
    found: Any = SimpleNamespace(singles=[nearest])
    answer = missing_force(found, law, Stages())
    assert answer["nearest"] == name
    told = {}
    for term in answer["terms"]:
        if term["nearest"] is not None:
            value = np.array([np.nan if v is None else v for v in term["nearest"]], float)
            told[term["term"]] = np.array(term["at"])[np.isfinite(value)], value[np.isfinite(value)]
    return told


def wall() -> Explanation:
    measured = measure(WALL, [recorded(seed) for seed in (1, 2)])
    one = misfit(measured)
    return Explanation((), fit(one, np.array([x.coordinate(TRUE[x.name]) for x in one.unknowns]), measured.states, 0))


def test_a_dashpot_of_a_block_is_a_constant_table_times_the_rate() -> None:
    measured = measure(SPECIMEN, [recording("a", 1)])
    base = Explanation((), calibrated(SPECIMEN, measured)[0])
    (form,) = [one for one in measured.model.mechanisms.values() if one.tabulated]
    told = curves(base, SPECIMEN, form, "viscous_damping", RATE, {"damping": 0.05})
    assert told["damping"][1] == pytest.approx(-RATE, rel=0.02)


def test_a_law_whose_doing_cannot_be_told_costs_its_curves_only(monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(*_: Any) -> None:
        raise InputError("a run cannot be cut there")

    monkeypatch.setattr("diagnosis.answer.missing_force.action", refused)
    measured = measure(SPECIMEN, [recording("a", 1)])
    base = Explanation((), calibrated(SPECIMEN, measured)[0])
    dashpot = next(c for c in candidates(measured, SPECIMEN) if c.name == "viscous_damping")
    found: Any = SimpleNamespace(singles=[extend(base, dashpot, dashpot.null, 0)])
    side = np.linspace(0.0, 0.05, KNOTS)
    table = Table("damping", np.concatenate([-side[::-1], side]), *np.ones((3, 2 * KNOTS)), 20.0)
    (form,) = [one for one in measured.model.mechanisms.values() if one.tabulated]
    law: Any = SimpleNamespace(mechanism=form, tables=[table], values={}, stages=(), oscillator={})
    stages = Stages()
    answer = missing_force(found, law, stages)
    assert stages.failed == {"what the nearest law (viscous_damping) does": "a run cannot be cut there"}
    assert answer["nearest"] is None and answer["terms"][0]["nearest"] is None
    assert answer["terms"][0]["value"] == [1.0] * (2 * KNOTS)


@pytest.mark.parametrize(
    ("name", "size", "over"), [("viscous_damping", COUPLE, "rate"), ("added_stiffness", SPRING, "rotation")]
)
def test_what_acts_on_a_wall_is_told_in_the_joint_that_it_acts_in(name: str, size: float, over: str) -> None:
    """And next to nothing in the other one; a force on the upper block has no curve."""
    base = wall()
    m = base.measured
    built = m.model.build(base.fitted.point.values, base.fitted.misfit.predictor.options)
    unit = {port: float(np.ravel(x)[0]) for port, x in units(built).items()}
    known, weight = base.fitted.point.values, 9.81 * base.fitted.point.values["top_mass"]
    assert unit["block"] == pytest.approx(weight, rel=1e-3)
    assert unit["top"] == pytest.approx(0.5 * weight * known["top_length"], rel=1e-3)
    assert unit["base"] == pytest.approx(
        0.5 * (weight + 9.81 * known["wall_mass"]) * known["wall_length"], rel=1e-3
    )  # fmt: skip
    of_joint = motions_of(base.fitted)
    in_base, in_top = f"{over}_base", f"{over}_top"
    reaches = {}
    for joint in ("base", "top"):
        along = of_joint[joint].rate if over == "rate" else of_joint[joint].coordinate
        reaches[f"{over}_{joint}"] = 0.6 * float(np.max(np.abs(along)))
    told = curves(base, WALL, OF_WALL, name, size, {**reaches, "displacement_block": 0.1})
    at, value = told[in_base]
    expected = -size * at / unit["base"]
    assert at.size > KNOTS
    largest = float(np.max(np.abs(expected)))
    np.testing.assert_allclose(value, expected, atol=0.1 * largest)
    assert np.max(np.abs(told[in_top][1])) * unit["top"] / unit["base"] < 0.1 * largest
    assert "displacement_block" not in told
