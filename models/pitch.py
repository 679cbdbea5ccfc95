"""The pitching of the table that carries the block.

    psi(t) = pitch_per_acceleration * lowpass(a(t)),  clockwise positive

with a second-order Butterworth low-pass run forwards and backwards (no phase). Against the table,
which turns about the middle of the block's base, a base acceleration a - G psi acts on the mass centre
(height h), to first order in psi, and the frame's angular acceleration adds the couple
-(I + M h^2) psi''. (The frame's Coriolis force does no work, its centrifugal one is of second order.)
"""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.signal import butter, sosfiltfilt

from models.base import FloatArray
from models.shaking import Shaking


def pitch(shaking: Shaking, low_pass: float) -> tuple[FloatArray, FloatArray]:
    """psi and psi'' per unit of ``pitch_per_acceleration`` at the samples of ``shaking``.

    ``low_pass`` in Hz; from half the sampling rate on it does nothing. The base is still before and
    after the record, of which ``shaking`` may be the later part (`Shaking.earlier`).
    psi'' belongs to the cubic spline through psi, so it is linear between samples.
    """
    time_step, before = shaking.time_step, np.zeros(0) if shaking.earlier is None else shaking.earlier
    acceleration = np.concatenate([before, shaking.horizontal])
    margin = int(np.ceil(2.0 / (low_pass * time_step)))
    padded = np.pad(acceleration, margin)
    filtered = padded
    if low_pass < 0.5 / time_step:
        sections = butter(2, low_pass, fs=1.0 / time_step, output="sos")
        filtered = sosfiltfilt(sections, padded, padtype=None)
    spline = CubicSpline(np.arange(padded.size) * time_step, filtered)
    inside = slice(margin + before.size, margin + acceleration.size)
    return filtered[inside], spline(spline.x, 2)[inside]
