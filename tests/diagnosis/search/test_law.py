"""The missing force as a model: a law that no mechanism describes is found, banded, and predicts other windows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diagnosis.errors.model import disturbance_about, refitted
from diagnosis.search import law as law_of
from diagnosis.search.candidates import candidates
from diagnosis.search.law import missing_law
from diagnosis.search.refit import Explanation, extend
from diagnosis.search.tables import Law, estimate, prior_rows
from models.mechanisms.table_force import MECHANISM
from models.tables import KNOTS, SIDES, row
from tests.diagnosis.made import SPECIMEN
from tests.diagnosis.search.hidden_law import base, chi2, windows

RATE = 0.6
"""s-1, of a dashpot that works for rotations above zero only."""
HIDDEN = MECHANISM.nulls | {row("damping", "above", k): -RATE for k in range(KNOTS)}


def test_a_one_sided_dashpot_is_found_and_predicts() -> None:
    plain = base(windows((1, 2), HIDDEN, 0))
    law = estimate(plain)
    assert law is not None and law.tables[0].term == "damping"
    table = law.tables[0]
    above, below = table.at > 0.02, table.at < -0.02
    inside = (table.low95 <= np.where(table.at > 0.0, -RATE, 0.0)) & (
        np.where(table.at > 0.0, -RATE, 0.0) <= table.high95
    )
    assert np.mean(inside[above | below]) >= 0.7
    assert np.mean(table.value[above]) < -0.6 * RATE < 2.0 * np.mean(table.value[below])
    other = windows((3, 4), HIDDEN, 1)
    before, after = chi2(plain, other), chi2(plain, other, law)
    assert before > 1.5 and (before - after) / (before - 1.0) > 0.7


@pytest.mark.parametrize(
    ("term", "hidden", "learned", "others"),
    [
        ("friction", {row("friction", side, k): -0.12 for side in SIDES for k in range(3)}, (1, 2), (3, 4)),
        (
            "base_damping", {row("base_damping", side, k): -0.3 * k for side in SIDES for k in range(KNOTS)},
            (1, 2), (3, 4),
        ),
        # the motions of 2 and 4 go furthest beyond the gap
        ("outward", {row("outward", side, k): -3.0 for side in SIDES for k in range(2, KNOTS)}, (2, 4), (1, 3)),
    ],
)  # fmt: skip
def test_laws_of_two_variables_are_found_and_predict(
    term: str, hidden: dict[str, float], learned: tuple[int, int], others: tuple[int, int]
) -> None:
    """A guide that rubs near the upright position; a damper that grips while the base accelerates; a snubber."""
    hidden = MECHANISM.nulls | {"reach_rotation": 0.1, "reach_base": 3.0} | hidden
    plain = base(windows(learned, hidden, 0))
    law = estimate(plain)
    assert law is not None and law.tables[0].term == term
    other = windows(others, hidden, 1)
    before, after = chi2(plain, other), chi2(plain, other, law)
    assert before > 1.5 and (before - after) / (before - 1.0) > 0.7


def test_a_law_that_the_errors_hold_is_found_and_predicts() -> None:
    """Impacts on the right lose more: errors estimated without that take it for scatter of the impacts."""
    hidden = MECHANISM.nulls | {row("impact", "above", k): -0.06 for k in range(KNOTS)}
    plain = base(windows((1, 2), hidden, 0))
    fitted, errors = refitted(plain.fitted, disturbance_about(plain.fitted))
    held = Explanation((), fitted)
    other = windows((3, 4), hidden, 1)
    before = chi2(held, other)
    without = estimate(held)
    law = missing_law(held, held, errors)
    assert law is not None and law.tables[0].term == "impact"
    assert (before - chi2(held, other, law)) / (before - 1.0) > 0.8
    assert without is None or chi2(held, other, law) <= chi2(held, other, without) + 0.05
    hurried = missing_law(held, held, errors, lambda: False)  # no time for more than the errors as they are
    assert hurried is without is None or (hurried and without and hurried.values == without.values)


def test_what_was_named_is_left_out_where_the_law_leaves_it_nothing_to_do() -> None:
    """A dashpot on both sides was named for one that works on one side."""
    measured = windows((1, 2), HIDDEN, 0)
    some = {one.name: one for one in candidates(measured, SPECIMEN)}
    plain = base(measured)
    named = extend(plain, some["viscous_damping"], some["viscous_damping"].null + 1.0)
    fitted, errors = refitted(named.fitted, disturbance_about(named.fitted))
    law = missing_law(replace(named, fitted=fitted), plain, errors)
    assert law is not None and not law.explanation.candidates
    assert law.tables[0].term == "damping"
    other = windows((3, 4), HIDDEN, 1)
    before, after = chi2(named, other), chi2(named, other, law)
    assert before > 1.3 and (before - after) / (before - 1.0) > 0.7


def test_what_was_named_rightly_keeps_its_name_though_a_table_does_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    """A dashpot on both sides, even where it is held to do nothing: the table in its place predicts no better."""
    monkeypatch.setattr(law_of, "MISSING", np.inf)
    measured = windows((1, 2), {row("damping", side, k): -RATE for side in SIDES for k in range(KNOTS)}, 0)
    dashpot = next(one for one in candidates(measured, SPECIMEN) if one.name == "viscous_damping")
    named = extend(base(measured), dashpot, dashpot.null + 1.0)
    fitted, errors = refitted(named.fitted, disturbance_about(named.fitted))
    named = replace(named, fitted=fitted)
    law = Law(named, (), MECHANISM)
    assert law_of._beside_what_acts(law, named, errors, law_of._left_out(named)) is law
    assert not law_of._beside_what_acts(law, named, errors, 1.0).explanation.candidates


def test_noise_alone_asks_for_no_law() -> None:
    assert estimate(base(windows((1, 2), MECHANISM.nulls, 0))) is None


def test_what_was_named_rightly_does_not_give_way_to_a_law() -> None:
    """A dashpot that is named, and a law in a table about the model without it that would do the same."""
    hidden = MECHANISM.nulls | {row("damping", side, k): -0.6 for side in SIDES for k in range(KNOTS)}
    plain = base(windows((1, 2), hidden, 0))
    fitted, errors = refitted(plain.fitted, disturbance_about(plain.fitted))
    without = Explanation((), fitted)
    dashpot = next(c for c in candidates(without.measured, SPECIMEN) if c.name == "viscous_damping")
    named = extend(without, dashpot, np.array([dashpot.unknowns[0].coordinate(0.6)]))
    assert missing_law(named, without, errors) is None
    assert missing_law(without, without, errors) is not None


def test_beyond_what_the_motion_tells_a_table_bends_towards_holding_its_value() -> None:
    """The likeliest continuation, under the prior alone, of a table that rises from 0 to 1 between its first rows."""
    rows = prior_rows(jumps=True)[:, KNOTS:]
    known = np.array([0.0, 1.0])
    rest = np.linalg.lstsq(rows[:, 2:], -rows[:, :2] @ known, rcond=None)[0]
    assert np.all(np.diff(rest) > 0.0) and np.all(np.diff(rest, 2) < 0.0)
    assert rest[-1] < 0.7 * (KNOTS - 1)
