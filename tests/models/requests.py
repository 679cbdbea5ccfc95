"""Requests of runs as the tests put them together."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from models.runs import Request, Run
from models.shaking import Shaking


def asked(
    shaking: Shaking,
    scale: Any = 1.0,
    *,
    samples: int = 0,
    duration: float | None = None,
    tail: float = 0.0,
    initial: Mapping[str, Any] | None = None,
    log: int = 0,
) -> Request:
    """Lanes under ``scale`` times the shaking; a ``duration`` (s) asks for the history up to there."""
    scale = np.atleast_1d(np.asarray(scale, dtype=np.float64))
    begun = {k: np.broadcast_to(np.asarray(v, dtype=np.float64), scale.shape) for k, v in (initial or {}).items()}
    last = None
    if duration is not None:
        end = round(duration / shaking.time_step)
        samples, last, tail = end + 1, np.full(scale.size, end), max(0.0, duration - shaking.duration)
    return Request(shaking, scale, tail=tail, initial=begun, last=last, samples=samples, log=log)


def outputs_of(run: Run, lane: int = 0) -> dict[str, float]:
    """The outputs of one lane as plain floats."""
    return {name: float(values[lane]) for name, values in run.outputs.items()}
