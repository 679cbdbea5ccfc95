"""Whether a force is the same in every window, whatever it might depend on: what no single dependence shows.

A loss that comes and goes, a dashpot that works now and then: each window gets a share of its own of the force, random
with variance tau^2 about the same one for all. The test is what the restricted likelihood gains by tau^2, the other
variances estimated anew (`diagnosis.errors.evidence`): the scatter of single events is among them, so what is seen is
that the events of one window err alike; and the smooth error of the model, whose size is judged by itself: shares that
differ from window to window would stand for it. Without such a change the gain is half a chi-squared with one degree of
freedom, half zero (Self and Liang, J. Am. Stat. Assoc. 82, 1987).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diagnosis.errors.evidence import Without
from diagnosis.errors.model import Errors
from diagnosis.fit.solver import Fitted
from diagnosis.forces.columns import Forces
from diagnosis.forces.constancy import Tested

WINDOW = "window"


def varying(forces: Forces, errors: Errors, least: float) -> list[Tested]:
    """One test a kind of force, strongest first; ``errors``: those estimated about the fit of the forces itself.

    ``least``: the statistic that counts. None about a law that wears: it changes from window to window itself, by
    counts of events not known exactly.
    """
    found: list[Tested] = []
    if _wears(forces.fitted):
        return found
    for kind in forces.kinds:
        column = forces.predicted(kind)
        if not column.any():  # nothing of this kind happens
            continue
        without = Without.estimated(errors, forces.fitted.measured, column[..., None], smooth_error=True)
        found.append(Tested(kind.name, WINDOW, without.from_window_to_window(column, least)))
    return sorted(found, key=lambda t: -t.statistic)


def _wears(fitted: Fitted) -> bool:
    """Whether what came before a window changes what is predicted in it."""
    m, point = fitted.measured, fitted.point
    blank = replace(m, memory={name: np.zeros_like(values) for name, values in m.memory.items()})
    fresh, worn = (replace(fitted.misfit.predictor, measured=one).predict([point])[0] for one in (blank, m))
    return not np.array_equal(fresh[m.mask], worn[m.mask], equal_nan=True)
