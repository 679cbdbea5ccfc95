"""Which of explanations that recordings cannot tell apart is named."""

from __future__ import annotations

import numpy as np

from diagnosis.search.candidates import Candidate
from diagnosis.search.found import GAP, Search, adjusted
from diagnosis.search.refit import Explanation

TIE = 0.5
"""Gain within which two explanations are one for the data: the earlier in the catalogue is named."""
LOGGER = 25.0
"""Hz: loggers filter above it, and every logger filters."""
LAG = np.sqrt(2.0) / (2.0 * np.pi * LOGGER)
"""s that a second-order low-pass at that corner delays slow motions by."""


def settle_ties(found: Search) -> None:
    """Name the earlier in the catalogue of equal explanations, and a low-pass where it explains a short lag as well.

    A delay of that length is rarer than a filter, and so is a clock that runs off by so little; recordings rarely tell
    the three apart.
    """
    if found.best is None:
        return
    place = {c: k for k, c in enumerate(found.candidates)}
    same = [e for e in [found.best, *found.tried] if len(e.candidates) == len(found.best.candidates)]
    near = [e for e in same if adjusted(e) - adjusted(found.best) < TIE]
    found.tried.append(found.best)
    found.best = min(near, key=lambda e: (sum(place[c] for c in e.candidates), adjusted(e)))
    lagging = [c for c in found.best.candidates if "clock" in c.mechanism.acts]
    if len(lagging) != 1 or not 0.0 < mean_lag(found.best, lagging[0]) < LAG:
        return
    kept = set(found.best.names) - {lagging[0].name}
    filtered = [
        e for e in same
        if kept < set(e.names) and "filter.corner_hz" in e.fitted.values and adjusted(e) - adjusted(found.best) < GAP
    ]  # fmt: skip
    if filtered:
        found.tried.append(found.best)
        found.best = min(filtered, key=adjusted)


def mean_lag(explanation: Explanation, candidate: Candidate) -> float:
    """s by which the responses are late on the mean of what was compared, recorded(t) = true((1 + rate) t - lag)."""
    values = {p.name: explanation.fitted.values[f"{candidate.name}.{p.name}"] for p in candidate.mechanism.parameters}
    rate, lag = candidate.mechanism.acts["clock"](values)
    measured = explanation.measured
    times = [measured.times(w)[mask.any(axis=0)] for w, mask in enumerate(measured.mask)]
    return float(lag - rate * np.concatenate(times).mean())
