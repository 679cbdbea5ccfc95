"""Energy in the springs of both layers, at the start and the end of a lane; see `models.interface.fibres`."""

from __future__ import annotations

import math
from typing import Any

from models.interface.lanes import rows as r
from models.interface.lanes.fibres import ARM, LARGEST, NODES, SET, WEIGHTS, ZETA, constants
from models.interface.lanes.rows import FIBRES, N_HIDDEN, W
from models.lanes.compiler import called, inlined
from models.lanes.elementary import exponential_decay

Table = Any


@inlined
def linear(k: float, b: float, z: float, s: float) -> float:
    """Of the exact linear strip, in J."""
    lean = abs(s)
    low = -b if z + lean * b <= 0.0 else min(b, max(-b, z / lean))
    d1, d2, d3 = b - low, 0.5 * (b * b - low * low), (b * b * b - low * low * low) / 3.0
    return float(0.5 * k * (z * z * d1 - 2.0 * z * lean * d2 + lean * lean * d3)) if d1 > 0.0 else 0.0


@inlined
def fibre(w: Table, joint: int, f: int, slot: int, u: float, numbers: Any) -> float:
    """What the laws of one fibre store beyond k u^2/2 (J m-2)."""
    cubic, arm_stiffness, _, _, hysteretic, _, _, softening, per_strain, _, _ = numbers
    own = (r.W_FIBRES + (joint * FIBRES + f) * N_HIDDEN) * W + slot
    k = w[(r.KB + joint) * W + slot]
    arm, zeta, kept = w[own + ARM * W], w[own + ZETA * W], w[own + SET * W]
    lost = softening - softening * exponential_decay(max(w[own + LARGEST * W], u) * per_strain)
    more = 0.25 * cubic * u * u * u * u - 0.5 * lost * u * u + k * kept * (0.5 * kept - u)
    more += 0.5 * arm_stiffness * arm * arm + 0.5 * hysteretic * (zeta * zeta - u * u)
    if w[r.CLIP * W + slot] > 0.0:
        stress = (k - lost + cubic * u * u) * u + arm_stiffness * arm + hysteretic * (zeta - u) - k * kept
        pull = min(stress, 0.0)
        more -= 0.5 * pull * pull / (k - lost + 3.0 * cubic * u * u + arm_stiffness)
    return float(more)


@called
def stored(w: Table, joint: int, slot: int, laws: Any) -> float:
    """Of one layer, base 0 or top 1, in J."""
    k, b, z = w[(r.KB + joint) * W + slot], w[(r.B1 + joint) * W + slot], w[(r.Z1 + joint) * W + slot]
    turn = w[r.T2 * W + slot] - w[r.T1 * W + slot] if joint == 1 else w[r.T1 * W + slot]
    s = math.sin(turn)
    found = linear(k, b, z, s)
    if laws is not None:
        numbers = constants(w, joint, slot, laws)[1]
        for f in range(FIBRES):
            found += b * WEIGHTS[f] * fibre(w, joint, f, slot, max(b * NODES[f] * s - z, 0.0), numbers)
    return float(found)
