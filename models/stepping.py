"""How long the steps of a model's kernel are, where a caller may choose them."""

from __future__ import annotations

from collections.abc import Mapping
from copy import copy
from typing import Self

from models.base import Values


class Stepping:
    """The part of a model that says how long its kernel's steps are.

    ``step``: s, of all lanes alike; None: by the model's own rule, lane by lane.
    """

    step: float | None = None

    def steps_a_sample(self, values: Values, time_step: float, options: Mapping[str, str] | None = None) -> int:
        """Steps of the own rule in a sample of ``time_step`` (s), the most of any lane.

        0: there is no such rule, or it leaves no choice.
        """
        return 0

    def stepping(self, step: float | None) -> Self:
        """The same model with steps of ``step`` (s)."""
        if step == self.step:
            return self
        found = copy(self)
        found.step = step
        return found
