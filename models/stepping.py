"""How long the steps of a model's kernel are, where a caller may choose them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from copy import copy
from typing import Self

from models.base import Values
from models.errors import InputError


class Stepping:
    """The part of a model that says how long its kernel's steps are.

    ``step``: s, of all lanes alike, to the nearest whole number in a sample; None: by the model's own rule, lane by
    lane. ``steps_chosen``: whether they may be of another length than by that rule.
    """

    name: str
    step: float | None = None
    steps_chosen: bool = False

    def steps_a_sample(self, values: Values, time_step: float, options: Mapping[str, str] | None = None) -> int:
        """Steps of the own rule in a sample of ``time_step`` (s), the most of any lane, where they may be chosen."""
        raise InputError(self._not_chosen)

    def stepping(self, step: float | None) -> Self:
        """The same model with steps of ``step`` (s). Raises InputError where they cannot be of that length."""
        if step == self.step:
            return self
        if step is not None and not self.steps_chosen:
            raise InputError(self._not_chosen)
        if step is not None and not 0.0 < step < math.inf:
            raise InputError(f"step = {step:g} s: give a positive length.")
        found = copy(self)
        found.step = step
        return found

    @property
    def _not_chosen(self) -> str:
        return f"the steps of model {self.name} are its own and cannot be chosen; leave the step out."
