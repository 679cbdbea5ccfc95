"""Every instrument's effect by name, and those that a setting switches on."""

from __future__ import annotations

from grids.instruments import (
    accelerometer_offset,
    base_filter,
    base_gain,
    clock,
    cross_axis,
    delay,
    drift,
    filter,
    gain,
    integrated_displacement,
    offset,
    saturation,
)  # fmt: skip
from grids.instruments.base import Switched
from models.base import Mechanism

INSTRUMENTS: dict[str, Mechanism] = {
    module.MECHANISM.name: module.MECHANISM
    for module in (
        accelerometer_offset, base_filter, base_gain, delay, clock, cross_axis, gain, offset, drift, filter,
        saturation, integrated_displacement,
    )
}  # fmt: skip
"""In the order in which they act on a signal."""


def switched_on(mechanisms: Switched) -> list[tuple[Mechanism, dict[str, float]]]:
    """Instruments among ``mechanisms`` with all their values, in the order in which they act."""
    return [(one, {**one.nulls, **mechanisms[name]}) for name, one in INSTRUMENTS.items() if name in mechanisms]
