"""Steps of the model longer than by its own rule, and what they change at a fit taken off every prediction near it.

A search makes thousands of runs that differ little from one another, and so do the errors that their steps make: that
of long steps, which is larger, is told by two runs at the fit, one of them in steps far shorter than the rule has them.
What is left of it is in proportion to how far a point is from the fit. Where the error itself is not small (a wall that
nearly overturns) nothing is taken off.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diagnosis.fit.solver import Fitted
from diagnosis.fit.unknowns import without_instruments

FEWER, MORE = 0.6, 2
"""Steps in a sample over those of the rule: those of a search, and those that their error is told by."""
LARGEST = 0.25
"""Squared error of the steps per sample of a window, in noise, up to which it is taken off."""


def in_long_steps(fitted: Fitted) -> Fitted:
    """The same point in long steps of the model, their error there taken off; as it is where they are no longer."""
    misfit, plain = fitted.misfit, fitted.measured.in_own_steps
    if not plain.model.steps_chosen:
        return fitted
    sample = plain.recordings[0].time_step
    own = plain.model.steps_a_sample(without_instruments(fitted.point.values), sample, misfit.predictor.options)
    fewer = max(1, round(FEWER * own))
    if fewer >= own:
        return replace(fitted, misfit=replace(misfit, predictor=replace(misfit.predictor, measured=plain)))
    predictors = [
        replace(misfit.predictor, measured=replace(plain, model=plain.model.stepping(sample / steps)))
        for steps in (fewer, MORE * own)
    ]
    long, short = (one.predict([fitted.point])[0] for one in predictors)
    residuals = misfit.whitened(np.stack([long, short]))
    small = np.sum((residuals[0] - residuals[1]) ** 2, axis=1) <= LARGEST * plain.count
    error = np.where(small[:, None, None] & plain.mask, long - short, 0.0)
    measured = replace(predictors[0].measured, step_error=np.where(np.isfinite(error), error, 0.0))
    return replace(fitted, misfit=replace(misfit, predictor=replace(misfit.predictor, measured=measured)))
