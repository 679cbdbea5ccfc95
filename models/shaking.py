"""The motion of the base as the models see it."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeVar, cast

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline

T = TypeVar("T")
KEPT = 8
"""Results that a motion keeps (`Shaking.once`)."""


@dataclass(frozen=True)
class Shaking:
    """Base acceleration sampled at a constant step, linear between samples.

    ``horizontal`` (n,) is positive to the right and ``vertical`` (n,) positive up, both in m s-2,
    at times 0, time_step, 2 time_step ... Before the first and after the last sample the base is
    at rest (zero acceleration). ``vertical_acts`` false: the base model leaves the vertical component
    out, and only the mechanism `vertical_acceleration` looks at it.
    """

    time_step: float
    horizontal: NDArray[np.float64]
    vertical: NDArray[np.float64] | None = None
    vertical_acts: bool = True

    def __post_init__(self) -> None:
        for name in ("horizontal", "vertical"):
            values = getattr(self, name)
            if values is not None:
                array = np.ascontiguousarray(values, dtype=np.float64)
                array.flags.writeable = False
                object.__setattr__(self, name, array)
        if not self.time_step > 0.0:
            raise ValueError(f"time_step is {self.time_step!r} s: give a positive time step")
        if self.vertical is not None and self.vertical.shape != self.horizontal.shape:
            raise ValueError(
                f"vertical has {self.vertical.size} samples, horizontal {self.horizontal.size}: "
                "cut both components to one length"
            )

    @property
    def duration(self) -> float:
        """Time of the last sample, in s."""
        return (self.horizontal.size - 1) * self.time_step

    @property
    def time(self) -> NDArray[np.float64]:
        """Times (n,) of the samples, in s."""
        return np.asarray(np.arange(self.horizontal.size) * self.time_step, np.float64)

    @cached_property
    def splines(self) -> tuple[CubicSpline, CubicSpline | None]:
        """Cubic splines through both components over `time`, m s-2; made once, for readings off the samples."""
        from scipy.interpolate import CubicSpline

        time = self.time
        return CubicSpline(time, self.horizontal), None if self.vertical is None else CubicSpline(time, self.vertical)

    @cached_property
    def _kept(self) -> dict[Hashable, Any]:
        return {}

    def once(self, key: Hashable, make: Callable[[], T]) -> T:
        """What ``make`` gives, made once for each of the last `KEPT` keys: many runs under a motion read the same."""
        if key not in self._kept:
            self._kept[key] = make()
            while len(self._kept) > KEPT:
                del self._kept[next(iter(self._kept))]
        return cast(T, self._kept[key])

    def scaled(self, factor: float) -> Shaking:
        """The same motion with both components times ``factor``."""
        vertical = None if self.vertical is None else factor * self.vertical
        return replace(self, horizontal=factor * self.horizontal, vertical=vertical)

    @property
    def pga(self) -> float:
        """Largest absolute horizontal acceleration, in m s-2."""
        return float(np.max(np.abs(self.horizontal)))

    @classmethod
    def silence(cls, duration: float, time_step: float) -> Shaking:
        """No shaking for ``duration`` seconds (free rocking)."""
        return cls(time_step, np.zeros(round(duration / time_step) + 1))
