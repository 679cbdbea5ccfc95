"""What an impact leaves of the angular velocity: theta'_after = e theta'_before.

Angular momentum about the new pivot, the body turning about the old one until then:

    e_H = [I + M (h^2 - b_old b_new)] / [I + M (h^2 + b_new^2)]

b_old, b_new: present distances from the mass centre's foot to the old and the new point of contact
(insets, crushing and the rounding of the corner taken off). For b_old = b_new it is Housner's
1 - 2 M b^2 / I_O. The laws multiply it, or a given absolute ratio e_0:

    e = (e_0 or e_H) f [1 - c_a (b/h)^2] (theta_prev/theta_max)^c_t
        [1 - beta |theta'|/(p alpha)] max(floor, 1 - loss n)

f ``restitution_factor``, theta_prev the peak before this impact, theta_max the largest so far, n the
impacts before this one, p and alpha those of the side that tips first. An impact never adds energy:
0 <= e <= sqrt(I_O,old / I_O,new), which is 1 for b_old = b_new.

Sources: Housner (Bull. Seismol. Soc. Am. 53, 1963). The form of the aspect and amplitude law and its
coefficients are this project's, after a description in words of Mordant, Dietz, Degee (COMPDYN 2013).
"""

from __future__ import annotations

import numpy as np

from models.base import FloatArray
from models.housner.block import Block
from models.housner.reference.table import LawInTable


def momentum_restitution(block: Block, old: FloatArray, new: FloatArray) -> FloatArray:
    """e_H for half widths ``old`` and ``new`` (m), arrays ``(n,)``."""
    kept = block.inertia + block.mass * (block.height**2 - old * new)
    return kept / (block.inertia + block.mass * (block.height**2 + new**2))


def restitution(
    block: Block,
    old: FloatArray,
    new: FloatArray,
    *,
    rate: FloatArray,
    previous_peak: FloatArray,
    largest_peak: FloatArray,
    impacts: FloatArray,
) -> FloatArray:
    """e of one impact, ``(n,)``: the law of this module; ``rate`` is theta' before it (rad s-1)."""
    base = np.where(np.isnan(block.restitution), momentum_restitution(block, old, new), block.restitution)
    rocked = largest_peak > 0.0
    swing = np.where(rocked, previous_peak, 1.0) / np.where(rocked, largest_peak, 1.0)
    amplitude = swing**block.amplitude_exponent
    speed = np.abs(rate) / (block.frequency_parameter * block.slenderness)
    worn = np.maximum(block.restitution_floor, 1.0 - block.loss_per_impact * impacts)
    ratio = (
        base
        * block.restitution_factor
        * (1.0 - block.aspect_coefficient * block.aspect**2)
        * amplitude
        * (1.0 - block.velocity_slope * speed)
        * worn
    )
    for lane in np.flatnonzero(block.tabulated):
        ratio[lane] *= 1.0 + LawInTable(block.table[lane]).at_impact(float(np.broadcast_to(rate, ratio.shape)[lane]))
    square = block.inertia + block.mass * block.height**2
    neutral = np.sqrt((square + block.mass * old**2) / (square + block.mass * new**2))
    return np.clip(ratio, 0.0, neutral)
