"""Levels of instruments over the true peak.

During a fit a level or offset is given over the largest *measured* value of the leading channel in the first
recording that moves. The catalogue gives it over the one that the model reaches there without these instruments, so the
estimates are converted at the end.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diagnosis.fit.intervals import Estimate
from diagnosis.fit.prediction import Point
from diagnosis.search.candidates import Candidate
from diagnosis.search.refit import Explanation
from grids.instruments.base import Level


def with_levels(candidate: Candidate) -> bool:
    """Whether a parameter of the mechanism is given over the reference peak."""
    return any(isinstance(parameter, Level) for parameter in candidate.mechanism.parameters)


def true_peak(explanation: Explanation) -> float | None:
    """Peak (rad) of the first recording with a window, as the model gives it without its levels; None without any."""
    names = {c.name for c in explanation.candidates if with_levels(c)}
    if not names:
        return None
    m, fitted = explanation.measured, explanation.fitted
    without = {k: v for k, v in fitted.point.values.items() if k.partition(".")[0] not in names}
    lead, moving = m.lead, m.windows[0].recording
    if m.identification.leads[0].channel in m.recordings[moving].estimated:
        # no rotation sensor whose level it could be
        return m.reference_peak
    motion = fitted.misfit.predictor.predict([Point(without, fitted.states)])[0][:, lead]
    first = m.recording_of == moving
    return float(np.max(np.abs(motion[first]) * m.mask[first, lead]))


def over_peak(
    parameters: dict[str, Estimate], candidate: Candidate, reference_peak: float, peak: float | None
) -> dict[str, Estimate]:
    """Estimates over ``reference_peak`` as estimates over ``peak`` (rad); those that are no levels as they are."""
    if peak is None or not with_levels(candidate):
        return parameters
    factor = reference_peak / peak
    return {
        name: replace(v, estimate=v.estimate * factor, low95=v.low95 * factor, high95=v.high95 * factor)
        for name, v in parameters.items()
    }
