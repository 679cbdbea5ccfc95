"""Values with a constant ratio: ``{ geomspace = [low, high, count], unit = "..." }``."""

from __future__ import annotations

import numpy as np

from grids.axes.base import Axis, AxisKind, Request, number_axis
from models.errors import InputError


def _read(request: Request) -> Axis:
    low, high, count = request.span("geomspace")
    if low <= 0.0:
        raise InputError(
            f"{request.where}: geomspace starts at {low:.6g} {request.target().unit}; start above zero or use linspace."
        )
    return number_axis(request, np.geomspace(low, high, count))


KIND = AxisKind("geomspace", ("unit",), _read)
