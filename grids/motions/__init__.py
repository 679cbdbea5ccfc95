"""Ground motions: readers, pulses, artificial motions, transformations, spectra, intensity measures."""

from __future__ import annotations

from grids.motions.artificial import make_artificial
from grids.motions.base import Motion
from grids.motions.locate import find, list_shipped
from grids.motions.pulses import make_pulse
from grids.motions.read import read_motion

__all__ = ["Motion", "find", "list_shipped", "make_artificial", "make_pulse", "read_motion"]
