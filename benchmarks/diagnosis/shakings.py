"""Base motions of the cases: strong parts of recorded motions, low-passed, on an exact grid."""

from __future__ import annotations

from functools import cache

import numpy as np
from scipy.signal import butter, sosfiltfilt
from scipy.signal.windows import tukey

from grids.motions import read_motion
from grids.motions.locate import find, list_shipped
from models.errors import InputError
from models.shaking import Shaking

STEP = 0.005
"""Step (s) at which the true base acceleration is linear; a whole number of the fine steps."""
FINE = 8
"""Fine steps in one ``STEP``: a power of two, so that interpolated samples lie exactly on lines."""
QUIET = 0.5
"""Seconds of stillness before and after the shaking."""
LIBRARY = "strong_motion_83.npz:*"


@cache
def sources() -> tuple[str, ...]:
    """The motions to draw from: the library of strong motion where it is, else the shipped records."""
    try:
        return tuple(find(LIBRARY))
    except InputError:
        return list_shipped()


def draw(rng: np.random.Generator, low_pass: float) -> tuple[str, Shaking]:
    """A strong part of a motion drawn at random: its name, and both components at PGA 1 m s-2.

    It starts where 2-8 % of the squared acceleration have passed and lasts 9-16 s, on a step of ``STEP``
    and with nothing above ``low_pass`` (Hz).
    """
    source = str(rng.choice(sources()))
    motion = read_motion(source)
    start, length = rng.uniform(0.02, 0.08), rng.uniform(9.0, 16.0)
    energy = np.cumsum(motion.horizontal**2)
    begin = motion.time_step * float(np.searchsorted(energy, start * energy[-1]))
    motion = motion.cut(max(0.0, begin - 1.0), min(motion.duration, begin + length))
    if motion.time_step != STEP:
        motion = motion.resampled(STEP)
    window = tukey(motion.horizontal.size, 0.1)
    sections = butter(4, low_pass, fs=1.0 / STEP, output="sos")
    horizontal = window * sosfiltfilt(sections, motion.horizontal * window)
    peak = float(np.max(np.abs(horizontal)))
    quiet = round(QUIET / STEP)
    vertical = np.zeros_like(horizontal)
    if motion.vertical is not None:
        vertical = window * sosfiltfilt(sections, motion.vertical * window)
    name = source.rpartition("/")[2].partition(":")[2] or motion.name
    return name, Shaking(STEP, np.pad(horizontal / peak, quiet), np.pad(vertical / peak, quiet))


def scaled(shaking: Shaking, factor: float, vertical: bool) -> Shaking:
    """Times ``factor``, rounded so that `fine` puts its samples exactly on straight lines."""

    def exact(samples: np.ndarray) -> np.ndarray:
        quantum = FINE * 2.0**-20
        return np.asarray(np.round(factor * samples / quantum) * quantum)

    up = exact(shaking.vertical) if vertical and shaking.vertical is not None else None
    return Shaking(shaking.time_step, exact(shaking.horizontal), up)


def fine(samples: np.ndarray) -> np.ndarray:
    """Linear interpolation to ``STEP / FINE``."""
    return np.asarray(np.interp(np.arange((samples.size - 1) * FINE + 1) / FINE, np.arange(samples.size), samples))


def on_fine_grid(shaking: Shaking) -> Shaking:
    """The same motion at steps of ``STEP / FINE``."""
    vertical = None if shaking.vertical is None else fine(shaking.vertical)
    return Shaking(shaking.time_step / FINE, fine(shaking.horizontal), vertical)
