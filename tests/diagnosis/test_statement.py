"""The paragraph: what it says, when, and that it never says the opposite of its numbers."""

from __future__ import annotations

import pytest

from diagnosis.report.suspects import suspect_of
from diagnosis.result import Effect, Estimate
from diagnosis.sensors import SENSORS
from diagnosis.statement import effect_told

ORDER = {"order": Estimate(1.0, 1.0, 1.0, "1")}
HIGH = Effect("filter", "filter", {"high_pass_hz": Estimate(3.6, 3.0, 4.4, "Hz"), **ORDER}, 80.0, 1e-6)
LOW = Effect("filter", "filter", {"corner_hz": Estimate(12.0, 10.0, 15.0, "Hz"), **ORDER}, 80.0, 1e-6)


@pytest.mark.parametrize(
    ("effect", "said", "unsaid"),
    [(HIGH, "high-pass of order 1 at 3.6 Hz", "low-pass"), (LOW, "low-pass of order 1 at 12 Hz", "high-pass")],
)
def test_a_filter_is_told_by_what_it_lets_through(effect: Effect, said: str, unsaid: str) -> None:
    values = {name: value.estimate for name, value in effect.parameters.items()}
    for text in (effect_told(effect, SENSORS["filter"]), suspect_of("filter", "housner").says(values)):
        assert said in text and unsaid not in text and "inf" not in text
