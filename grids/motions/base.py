"""A ground motion, and what may be done to it without touching its meaning."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from grids.arrays import real_number, real_numbers
from models.errors import InputError
from models.shaking import Shaking

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Motion:
    """Acceleration of the ground, linear between samples at 0, ``time_step``, 2 ``time_step`` ... (s).

    ``horizontal`` (n,) and ``vertical`` (n,) or None in m s-2, the vertical positive up; zero before
    the first and after the last sample. ``components`` names the channels used, ``source`` says
    where they come from, ``notes`` what was done to them, in order.
    """

    name: str
    time_step: float
    horizontal: FloatArray
    vertical: FloatArray | None = None
    components: Mapping[str, str] = field(default_factory=dict)
    source: Mapping[str, Any] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        step = real_number(self.time_step)
        if step is None or not 0.0 < step < math.inf:
            raise InputError(f"motion {self.name}: time_step is {self.time_step!r}: give a positive number, in s")
        object.__setattr__(self, "time_step", step)
        for name in ("horizontal", "vertical"):
            values = getattr(self, name)
            if values is None:
                continue
            array = np.array(real_numbers(values, f"motion {self.name}: {name}"))
            if array.ndim != 1 or array.size < 2:
                raise InputError(f"motion {self.name}: {name} has shape {array.shape}: give at least 2 samples")
            if not np.isfinite(array).all():
                raise InputError(f"motion {self.name}: {name} holds values that are not finite: repair them")
            array.flags.writeable = False
            object.__setattr__(self, name, array)
        if self.vertical is not None and self.vertical.size != self.horizontal.size:
            raise InputError(
                f"motion {self.name}: vertical has {self.vertical.size} samples, horizontal "
                f"{self.horizontal.size}: cut both to one length"
            )

    def __repr__(self) -> str:
        used = ", ".join(f"{role} {name}" for role, name in self.components.items())
        return (
            f"Motion {self.name}: {self.horizontal.size} samples at {self.time_step:g} s "
            f"({self.duration:.4g} s), PGA {self.pga:.4g} m s-2, {used or 'horizontal'}"
            + ("" if self.vertical is not None else ", no vertical")
        )

    @property
    def duration(self) -> float:
        """Time of the last sample, s."""
        return (self.horizontal.size - 1) * self.time_step

    @property
    def time(self) -> FloatArray:
        """Times of the samples (n,), s."""
        return np.arange(self.horizontal.size, dtype=np.float64) * self.time_step

    @property
    def pga(self) -> float:
        """Largest absolute horizontal acceleration, m s-2."""
        return float(np.max(np.abs(self.horizontal)))

    @cached_property
    def fingerprint(self) -> str:
        """sha256 of the time step and the samples: equal for equal shaking, whatever its name."""
        digest = hashlib.sha256(np.float64(self.time_step).astype("<f8").tobytes())
        for values in (self.horizontal, self.vertical):
            digest.update(b"none" if values is None else values.astype("<f8").tobytes())
        return digest.hexdigest()

    def shaking(self, *, vertical_acts: bool = True) -> Shaking:
        """The motion as the models see it; ``vertical_acts`` as in `Shaking`."""
        return Shaking(self.time_step, self.horizontal, self.vertical, vertical_acts)

    def without_vertical(self) -> Motion:
        """The horizontal component alone."""
        kept = {role: name for role, name in self.components.items() if role != "vertical"}
        return replace(self, vertical=None, components=kept)

    def scaled(self, factor: float) -> Motion:
        """Both components multiplied by ``factor``."""
        if not math.isfinite(factor):
            raise InputError(f"motion {self.name}: scale factor is {factor!r}: give a finite number")
        vertical = None if self.vertical is None else self.vertical * factor
        return self._noted(f"scaled by {factor:.6g}", horizontal=self.horizontal * factor, vertical=vertical)

    def scaled_to_pga(self, value: float) -> Motion:
        """Both components by one factor that brings the horizontal peak to ``value`` (m s-2)."""
        if not (math.isfinite(value) and value >= 0.0):
            raise InputError(f"motion {self.name}: PGA is {value!r} m s-2: give zero or a positive number")
        if self.pga == 0.0:
            raise InputError(f"motion {self.name}: horizontal is zero throughout: it cannot be scaled to a PGA")
        return self.scaled(value / self.pga)

    def time_scaled(self, factor: float) -> Motion:
        """Time stretched by ``factor``, accelerations kept: similitude of a model test."""
        if not (math.isfinite(factor) and factor > 0.0):
            raise InputError(f"motion {self.name}: time_scale is {factor!r}: give a positive number")
        return self._noted(f"time stretched by {factor:.6g}", time_step=self.time_step * factor)

    def cut(self, start: float = 0.0, end: float | None = None) -> Motion:
        """The samples from ``start`` to ``end`` (s, both included); time starts anew at zero."""
        last = self.duration if end is None else end
        if not 0.0 <= start < last <= self.duration * (1 + 1e-9):
            raise InputError(
                f"motion {self.name}: cannot be cut to {start:g} .. {last:g} s: choose an interval "
                f"within 0 .. {self.duration:g} s"
            )
        first = math.ceil(start / self.time_step - 1e-6)
        stop = math.floor(last / self.time_step + 1e-6) + 1
        if stop - first < 2:
            raise InputError(
                f"motion {self.name}: {start:g} .. {last:g} s holds {stop - first} sample(s) at "
                f"{self.time_step:g} s: choose a longer interval"
            )
        vertical = None if self.vertical is None else self.vertical[first:stop]
        note = f"cut to {first * self.time_step:g} .. {(stop - 1) * self.time_step:g} s"
        return self._noted(note, horizontal=self.horizontal[first:stop], vertical=vertical)

    def resampled(self, time_step: float) -> Motion:
        """Band-limited to the narrower of both rates, see `grids.motions.resample.resample`."""
        from grids.motions.resample import resample

        where = f"motion {self.name}"
        horizontal = resample(self.horizontal, self.time_step, time_step, where)
        vertical = None if self.vertical is None else resample(self.vertical, self.time_step, time_step, where)
        note = f"resampled from {self.time_step:.6g} to {time_step:.6g} s (band-limited)"
        return self._noted(note, time_step=time_step, horizontal=horizontal, vertical=vertical)

    def _noted(self, note: str, **changes: Any) -> Motion:
        return replace(self, notes=(*self.notes, note), **changes)
