"""A number that is known, and how many of its digits the program finds."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

MOST_DIGITS = 15.9
"""Those of a double."""


@dataclass(frozen=True)
class Oracle:
    """``find()`` must agree with ``expected`` in ``digits``, those that the source gives and the method reaches."""

    model: str
    what: str
    source: str
    expected: float
    digits: float
    find: Callable[[], float]


@dataclass(frozen=True)
class Line:
    """One line of the table; ``error`` where nothing was found at all."""

    model: str
    what: str
    source: str
    digits: float
    required: float
    error: str = ""

    @property
    def passed(self) -> bool:
        return not self.error and self.digits >= self.required

    def __str__(self) -> str:
        verdict = "ok" if self.passed else "FAILS"
        found = self.error or f"{self.digits:4.1f} digits (at least {self.required:.1f})"
        return f"{verdict:<6} {self.model:<17} {self.what:<64} {found}  [{self.source}]"


def agreeing_digits(found: float, expected: float) -> float:
    """-log10 of the relative difference; of the absolute one where zero is expected; 0 for what is not finite."""
    if found == expected or (math.isnan(found) and math.isnan(expected)):
        return MOST_DIGITS
    if not (math.isfinite(found) and math.isfinite(expected)):
        return 0.0
    apart = abs(found - expected) / (abs(expected) or 1.0)
    return min(MOST_DIGITS, max(0.0, -math.log10(apart)))
