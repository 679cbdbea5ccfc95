"""The motion of the base as the models see it."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
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
    """Base acceleration sampled at a constant step; models take it as linear between samples (`lines`).

    ``horizontal`` (n,) is positive to the right and ``vertical`` (n,) positive up, both in m s-2,
    at times 0, time_step, 2 time_step ... Before the first and after the last sample the base is
    at rest (zero acceleration). ``vertical_acts`` false: the base model leaves the vertical component
    out, and only the mechanism `vertical_acceleration` looks at it. ``band_limited``: the samples are of a smooth
    motion without content above half the sampling frequency, as a recording is. ``earlier`` (m,): horizontal samples
    before time 0 of a motion that was cut, for filters over the whole record; nothing else reads them.
    """

    time_step: float
    horizontal: NDArray[np.float64]
    vertical: NDArray[np.float64] | None = None
    vertical_acts: bool = True
    band_limited: bool = False
    earlier: NDArray[np.float64] | None = None

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
    def lines(self) -> Shaking:
        """The motion as models run it: linear between samples, with the displacements of the true one.

        Straight lines between the samples of a sine of frequency f hold sinc^2(f dt) of it, .8 % less at 5 Hz and
        3.3 % at 10 Hz at a step dt of .01 s. Those of a band-limited motion are therefore drawn between
        x - D x / 12 + D^2 x / 90, D x_i = x_i-1 - 2 x_i + x_i+1: 1 / sinc^2, in error by .11 (pi f dt)^6.
        The corners of the lines, above half the sampling frequency, leave an error of fourth order in responses.
        """
        if not self.band_limited:
            return self
        vertical = None if self.vertical is None else _sharpened(self.vertical)
        return replace(self, horizontal=_sharpened(self.horizontal), vertical=vertical, band_limited=False)

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
        vertical, earlier = (None if x is None else factor * x for x in (self.vertical, self.earlier))
        return replace(self, horizontal=factor * self.horizontal, vertical=vertical, earlier=earlier)

    @property
    def pga(self) -> float:
        """Largest absolute horizontal acceleration, in m s-2."""
        return float(np.max(np.abs(self.horizontal)))

    @classmethod
    def silence(cls, duration: float, time_step: float) -> Shaking:
        """No shaking for ``duration`` seconds (free rocking)."""
        return cls(time_step, np.zeros(round(duration / time_step) + 1))


@dataclass(frozen=True)
class Shakings:
    """The motions of n lanes: lane k is under ``each[of[k]]``; all of one step, with a vertical motion or none."""

    each: tuple[Shaking, ...]
    of: NDArray[np.int64]

    def __post_init__(self) -> None:
        if len({(one.time_step, one.vertical is None, one.vertical_acts) for one in self.each}) != 1:
            raise ValueError("lanes run together under motions of one step, with a vertical motion in all or in none")

    @classmethod
    def of_lanes(cls, lanes: Sequence[Shaking]) -> Shakings:
        """Lanes under these motions, the same object in several lanes held once."""
        each = {id(one): one for one in lanes}
        place = {key: k for k, key in enumerate(each)}
        return cls(tuple(each.values()), np.array([place[id(one)] for one in lanes], np.int64))

    @classmethod
    def over(cls, shaking: Shaking | Shakings, lanes: int) -> Shakings:
        """The motion of each lane, where one may be that of all."""
        return shaking if isinstance(shaking, Shakings) else cls((shaking,), np.zeros(lanes, np.int64))

    @property
    def first(self) -> Shaking:
        return self.each[0]

    @cached_property
    def lines(self) -> Shakings:
        """Each as models run it (`Shaking.lines`)."""
        return Shakings(tuple(one.lines for one in self.each), self.of)

    @property
    def ends(self) -> NDArray[np.int64]:
        """The last sample of each lane's motion (n,)."""
        return np.array([one.horizontal.size - 1 for one in self.each], np.int64)[self.of]

    def take(self, lanes: Any) -> Shakings:
        """Those of the lanes of an index array, slice or mask; motions that none of them is under are left out."""
        used, of = np.unique(self.of[lanes], return_inverse=True)
        return Shakings(tuple(self.each[k] for k in used), of)


def _sharpened(samples: NDArray[np.float64]) -> NDArray[np.float64]:
    """Between which straight lines hold as much of every slow sine as these ``samples`` (n,); see `Shaking.lines`."""
    once = np.diff(np.pad(samples, 1, mode="edge"), 2)
    return np.asarray(samples - once / 12.0 + np.diff(np.pad(once, 1, mode="edge"), 2) / 90.0)
