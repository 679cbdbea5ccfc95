"""Windows that end where small changes no longer leave small ones.

Where a body comes close to rest a slightly larger rate means one event more: what happens then tells nothing, and a fit
ends in one of many small valleys.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diagnosis.errors.kicks import kicks
from diagnosis.fit.growing import cut_again
from diagnosis.fit.setup import with_noise_of_the_base
from diagnosis.fit.solver import Fitted, fit_thoroughly


def followed(fitted: Fitted) -> Fitted:
    """The base fit with windows that end there, and without those too short."""
    m = fitted.measured
    last = kicks(fitted.misfit.predictor, fitted.point).followed
    if m.lengths is None or all(n >= window.samples for n, window in zip(last, m.windows, strict=True)):
        return fitted
    steps = np.array([m.recordings[window.recording].time_step for window in m.windows])
    whole = last >= np.array([window.samples for window in m.windows])
    keep = np.flatnonzero(whole | (last * steps >= m.lengths.shortest))
    if not keep.size:
        return fitted
    windows = [replace(m.windows[w], samples=min(m.windows[w].samples, int(last[w]))) for w in keep]
    plain = cut_again(fitted.misfit.of_windows(keep), windows)
    return with_noise_of_the_base(fit_thoroughly(plain, fitted.u, fitted.states[keep]))
