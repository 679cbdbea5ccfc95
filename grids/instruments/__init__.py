"""What instruments do to a signal, one file a mechanism.

`moved` and `recorded` apply them to whole records, `grids.instruments.windowed` to windows.
"""

from __future__ import annotations

from grids.instruments.catalogue import INSTRUMENTS
from grids.instruments.whole import moved, recorded

__all__ = ["INSTRUMENTS", "moved", "recorded"]
