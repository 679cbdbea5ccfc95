"""The catalogue of what instruments do to a signal, one file a sensor mechanism.

`moved` and `recorded` apply them to whole records; windows are treated in `diagnosis.fit.prediction`.
"""

from __future__ import annotations

from grids.instruments import (
    accelerometer_offset,
    base_gain,
    clock,
    cross_axis,
    delay,
    filter,
    gain,
    offset,
    saturation,
)  # fmt: skip
from grids.instruments.whole import moved, recorded
from models.base import Mechanism

INSTRUMENTS: dict[str, Mechanism] = {
    module.MECHANISM.name: module.MECHANISM
    for module in (
        accelerometer_offset, base_gain, delay, clock, cross_axis, gain, offset, filter, saturation
    )
}  # fmt: skip
"""In the order in which they act on a signal."""

__all__ = ["INSTRUMENTS", "moved", "recorded"]
