"""Cells that a figure cannot show by a value: what became of them, and how each kind is marked."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.patches import Patch
from numpy.typing import NDArray

from study.status import FAILED, NOT_CONVERGED, NOT_RUN, OUTSIDE_MODEL, OVERTURNED


@dataclass(frozen=True)
class Outcome:
    """A flag of ``status`` with its words, its colour in a map and its marker beside curves."""

    flag: int
    words: str
    colour: str
    marker: str

    def patch(self) -> Patch:
        return Patch(facecolor=self.colour, edgecolor="0.4", label=self.words)


OUTCOMES = (
    Outcome(OVERTURNED, "overturned", "#D55E00", "x"),
    Outcome(OUTSIDE_MODEL, "outside the model", "#CC79A7", "d"),
    Outcome(NOT_CONVERGED, "not converged", "#56B4E9", "+"),
    Outcome(FAILED, "failed", "#000000", "*"),
    Outcome(NOT_RUN, "not run", "#ffffff", "."),
)
OF_OVERTURNED = ("overturned", "overturning_time", "status")
"""Beginnings of the names of outputs that are meaningful for an overturned wall too."""


def marked(output: str, status: NDArray[np.integer]) -> list[Outcome]:
    """The outcomes among ``status`` whose cells hold no ordinary value of ``output``."""
    present = set(np.unique(status).tolist())
    shows_overturned = output.startswith(OF_OVERTURNED)
    return [o for o in OUTCOMES if o.flag in present and not (shows_overturned and o.flag == OVERTURNED)]
