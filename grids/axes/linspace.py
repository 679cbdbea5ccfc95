"""Evenly spaced values: ``{ linspace = [low, high, count], unit = "..." }``."""

from __future__ import annotations

import numpy as np

from grids.axes.base import Axis, AxisKind, Request, number_axis


def _read(request: Request) -> Axis:
    return number_axis(request, np.linspace(*request.span("linspace")))


KIND = AxisKind("linspace", ("unit",), _read)
