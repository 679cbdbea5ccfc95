"""The tests for constancy of one fit under the same errors are made once."""

from __future__ import annotations

from dataclasses import replace

from diagnosis.errors.model import calibrated
from diagnosis.fit.setup import measure
from diagnosis.forces import constancy
from diagnosis.search.found import Search
from diagnosis.search.refit import Explanation
from tests.diagnosis.made import SPECIMEN, recording


def test_a_fit_is_tested_again_under_other_errors_only() -> None:
    fitted, errors = calibrated(SPECIMEN, measure(SPECIMEN, [recording("a", 1)]))
    found = Search(Explanation((), fitted), (), errors)
    first = found.tested(found.base)
    assert first.tested == constancy.tests(first.forces, errors) and found.tested(found.base) is first
    assert replace(found).tested(Explanation((), fitted)) is first  # the same fit, of a copy of the search
    found.errors = replace(errors)
    assert found.tested(found.base) is not first
    second = found.about
    assert found.tested(Explanation((), replace(fitted))) is not second
    assert first.flags(1e9) == () and len(first.flags(0.0)) > 0
