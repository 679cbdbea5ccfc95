"""What has a frequency of its own is found with it, and predicts other recordings; noise alone asks for none."""

from __future__ import annotations

import pytest

from diagnosis.answer.missing_force import missing_force
from diagnosis.answer.statement import oscillator_text
from diagnosis.errors.model import disturbance_about, refitted
from diagnosis.progress import Stages
from diagnosis.search.driven import with_oscillator
from diagnosis.search.found import Search
from diagnosis.search.law import missing_law
from diagnosis.search.refit import Explanation
from models.mechanisms.table_force import MECHANISM
from tests.diagnosis.search.hidden_law import base, chi2, windows

FOUNDATION = {"oscillator_motion": 0.25, "oscillator_frequency": 3.4, "oscillator_damping": 0.05}


@pytest.mark.parametrize(("gain", "size"), [("motion", 0.25), ("force", 0.2)])
def test_a_support_that_moves_and_a_mass_that_swings_are_told_apart(gain: str, size: float) -> None:
    hidden = MECHANISM.nulls | FOUNDATION | {"oscillator_motion": 0.0, f"oscillator_{gain}": size}
    plain = base(windows((1, 2), hidden, 0))
    fitted, errors = refitted(plain.fitted, disturbance_about(plain.fitted))
    without = Explanation((), fitted)
    law = missing_law(without, without, errors)
    assert law is not None
    found = law.oscillator
    assert found["oscillator_frequency"][0] == pytest.approx(3.4, rel=0.03)
    other = "force" if gain == "motion" else "motion"
    assert found[f"oscillator_{gain}"][0] == pytest.approx(size, abs=0.25 * size)
    assert abs(found[f"oscillator_{other}"][0]) < 0.4 * size
    others = windows((3, 4), hidden, 1)
    before, after = chi2(plain, others), chi2(plain, others, law)
    assert before > 1.5 and (before - after) / (before - 1.0) > 0.7
    told = missing_force(Search(without, (), errors), law, Stages())
    assert "an oscillator of 3." in oscillator_text(told["oscillator"])


def test_noise_alone_asks_for_no_oscillator() -> None:
    assert with_oscillator(base(windows((1, 2), MECHANISM.nulls, 0))) is None
