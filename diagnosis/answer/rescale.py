"""Sensor levels over the true peak.

During a fit a level or offset is given over the largest *measured* rotation of the first recording.
The catalogue gives it over the rotation that the model reaches there without the effect, so the
estimate is converted at the end, and the reference is told with it.
"""

from __future__ import annotations

import numpy as np

from diagnosis.fit.intervals import Estimate
from diagnosis.fit.prediction import Point
from diagnosis.search.candidates import REFERENCE, Candidate
from diagnosis.search.refit import Explanation


def to_true_peak(
    explanation: Explanation, candidate: Candidate, parameters: dict[str, Estimate]
) -> dict[str, Estimate]:
    """Parameters with levels over the unspoilt peak of the first recording; others as they are."""
    if REFERENCE not in {p.name for p in candidate.mechanism.parameters}:
        return parameters
    fitted = explanation.fitted
    predictor, m = fitted.misfit.predictor, fitted.measured
    point = fitted.point
    without = {k: v for k, v in point.values.items() if k.partition(".")[0] != candidate.name}
    motion = predictor.predict([Point(without, fitted.states)])[0][:, 0]
    first = m.recording_of == 0
    peak = float(np.max(np.abs(motion[first]) * m.mask[first, 0])) if first.any() else m.reference_peak
    factor = m.reference_peak / peak
    found = {}
    for name, value in parameters.items():
        found[name] = Estimate(
            value.estimate * factor, value.low95 * factor, value.high95 * factor, value.unit, value.at_bound
        )
    found[REFERENCE] = Estimate(peak, peak, peak, "rad")
    return found
