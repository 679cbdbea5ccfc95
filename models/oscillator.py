"""A base motion felt through an oscillator that it drives: what swings in, on or under a block, to first order.

    u'' + 2 zeta omega u' + omega^2 u = -a(t),   felt: a + motion u'' + force (u'' + a)

``u`` is the oscillator's displacement against the base, at rest at the sample before the record, of which the shaking
may be the later part (`Shaking.earlier`). A foundation that moves on soft ground carries the block with it
(``motion``); a mass that swings on top or a liquid that sloshes pushes it with the force that accelerates it
(``force``), as far as the block's own rocking does not drive them. What still swings when the record ends is not
followed.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.signal import cont2discrete, lfilter, ss2tf

from models.base import FloatArray
from models.shaking import Shaking


def acceleration(base: FloatArray, time_step: float, frequency: float, damping: float) -> FloatArray:
    """u'' + a (n,) in m s-2 at the samples of a base acceleration that is linear between them (exact for it)."""
    omega = 2.0 * np.pi * frequency
    matrix = np.array([[0.0, 1.0], [-(omega**2), -2.0 * damping * omega]])
    out = np.array([[-(omega**2), -2.0 * damping * omega]])
    system = cont2discrete((matrix, np.array([[0.0], [-1.0]]), out, np.zeros((1, 1))), time_step, "foh")
    numerator, denominator = ss2tf(*system[:4])
    return np.asarray(lfilter(numerator[0], denominator, base))


def felt(shaking: Shaking, motion: float, force: float, frequency: float, damping: float) -> Shaking:
    """The motion as it is felt; the same object without either gain. ``frequency`` in Hz, ``damping`` over critical."""
    if motion == 0.0 and force == 0.0:
        return shaking

    def make() -> Shaking:
        cut = 0 if shaking.earlier is None else shaking.earlier.size
        base = shaking.horizontal if shaking.earlier is None else np.append(shaking.earlier, shaking.horizontal)
        total = acceleration(base, shaking.time_step, frequency, damping)
        whole = base + motion * (total - base) + force * total
        return replace(shaking, horizontal=whole[cut:], earlier=whole[:cut] if cut else None)  # filters follow it

    return shaking.once((__name__, motion, force, frequency, damping), make)
