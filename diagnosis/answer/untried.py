"""What the search's budget of work did not reach, in the words of the statement."""

from __future__ import annotations

import numpy as np

from diagnosis.answer.result import Diagnosis
from diagnosis.search.budget import ENDED

SUSPECT = 0.2
"""Share of the screen's statistic of what is named from which on another mechanism should have been tried."""


def left_out(found: Diagnosis) -> list[str]:
    """Of an answer outside the library, whatever was left: the library may say more than it did."""
    return _said([name for name, why in found.not_tried.items() if why == ENDED])


def suspects_left_out(found: Diagnosis) -> list[str]:
    """Of an answer that names effects, the mechanisms that the screen made suspects beside them."""
    named = {effect.name for effect in found.effects}
    least = SUSPECT * max((line.score for line in found.screen if line.name in named), default=np.inf)
    suspects = [line.name for line in found.screen if line.score > least and line.gain is None]
    return _said([name for name in suspects if found.not_tried.get(name) == ENDED])


def _said(names: list[str]) -> list[str]:
    listed = ", ".join(name.replace("_", " ") for name in names)
    return [f"{ENDED[0].upper()}{ENDED[1:]} had tried: {listed}."] if names else []
