"""Rubber laws along both strips: 16 Gauss fibres of the difference to the linear law, for all lanes.

For every fibre, the loop over the W lanes has no branches. Hidden states advance over the step in
which the compression is taken as linear in time: exactly for the Maxwell arm (exponential), by the
exponential Rosenbrock-Euler rule for Bouc-Wen, at the mean compression for the permanent set.
What each law adds to the force, and its slope, is summed into the rows that the step rule reads.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from models.interface.lanes import rows as r
from models.interface.lanes.rows import FIBRES, N_HIDDEN, W
from models.lanes.compiler import inlined
from models.lanes.elementary import exponential_decay, sine_cosine

Table = Any
NODES, WEIGHTS = np.polynomial.legendre.leggauss(FIBRES)
FIRST, SECOND = WEIGHTS * NODES, WEIGHTS * NODES**2
UNBOUNDED = 1e300
COMPRESSION, ARM, ZETA, LARGEST, SET = range(5)
"""Hidden rows of a fibre: u at the last step, Maxwell's spring, zeta, largest u, permanent compression."""


@inlined
def predicted_strips(w: Table, i: int) -> None:
    """z, S, z', S' of both strips at the predictor of the coming step."""
    h = w[r.STEP * W + i]
    half = 0.5 * h * h
    v1, v2 = w[r.V1 * W + i] + h * w[r.A1 * W + i], w[r.V2 * W + i] + h * w[r.A2 * W + i]
    t1 = w[r.T1 * W + i] + h * w[r.V1 * W + i] + half * w[r.A1 * W + i]
    t2 = w[r.T2 * W + i] + h * w[r.V2 * W + i] + half * w[r.A2 * W + i]
    s1, c1 = sine_cosine(t1)
    sr, cr = sine_cosine(t2 - t1)
    w[r.FZ_B * W + i] = w[r.Z1 * W + i] + h * w[r.Y1 * W + i] + half * w[r.AZ1 * W + i]
    w[r.FZ_T * W + i] = w[r.Z2 * W + i] + h * w[r.Y2 * W + i] + half * w[r.AZ2 * W + i]
    w[r.FY_B * W + i], w[r.FY_T * W + i] = (
        w[r.Y1 * W + i] + h * w[r.AZ1 * W + i],
        w[r.Y2 * W + i] + h * w[r.AZ2 * W + i],
    )
    w[r.FS_B * W + i], w[r.FS_T * W + i] = s1, sr
    w[r.FR_B * W + i], w[r.FR_T * W + i] = c1 * v1, cr * (v2 - v1)
    for row in range(10):
        w[(r.FN_B + row) * W + i] = 0.0


@inlined
def constants(w: Table, joint: int, i: int, laws: Any) -> Any:
    """What the fibres of one joint share: the strip's motion, its layer, the numbers of the laws in use."""
    hardening, maxwell, bouc_wen, mullins, permanent_set = laws
    own = r.W_LAWS + joint * r.N_LAW
    b, k = w[(r.B1 + joint) * W + i], w[(r.KB + joint) * W + i]
    strip = (
        b * w[(r.FS_B + joint) * W + i], w[(r.FZ_B + joint) * W + i],
        b * w[(r.FR_B + joint) * W + i], w[(r.FY_B + joint) * W + i],
        k, w[(r.CB + joint) * W + i], 0.0 if w[r.CLIP * W + i] > 0.0 else -UNBOUNDED,
    )  # fmt: skip
    cubic, arm, decay, gain, hysteretic, yielding, order = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0
    softening, per_strain, flow, limit = 0.0, 0.0, 0.0, 0.0
    if hardening is not None:
        cubic = k * w[(own + r.P_HARDENING) * W + i]
    if maxwell is not None:
        arm, decay = w[(own + r.P_ARM) * W + i], w[(own + r.P_ARM_DECAY) * W + i]
        gain = w[(own + r.P_ARM_GAIN) * W + i]
    if bouc_wen is not None:
        hysteretic, yielding = w[(own + r.P_HYSTERETIC) * W + i], w[(own + r.P_YIELD) * W + i]
        order = w[(own + r.P_ORDER) * W + i]
    if mullins is not None:
        softening, per_strain = k * w[(own + r.P_SOFTENING) * W + i], w[(own + r.P_PER_STRAIN) * W + i]
    if permanent_set is not None:
        flow, limit = w[(own + r.P_SET) * W + i], w[(own + r.P_LIMIT) * W + i]
    return strip, (cubic, arm, decay, gain, hysteretic, yielding, order, softening, per_strain, flow, limit)


@inlined
def fibre(w: Table, joint: int, f: int, i: int, node: float, shared: Any, laws: Any) -> tuple[float, float]:
    """One fibre of one lane: advances its hidden state; the stress it adds, and its slope."""
    hardening, maxwell, bouc_wen, mullins, permanent_set = laws
    (turn, z, turn_rate, z_rate, k, c, floor), numbers = shared
    cubic, arm_stiffness, decay, gain, hysteretic, yielding, order, softening, per_strain, flow, limit = numbers
    own = (r.W_FIBRES + (joint * FIBRES + f) * N_HIDDEN) * W + i
    down = node * turn - z
    u = max(down, 0.0)
    more, slope = 0.0, 0.0
    change = 0.0
    if (maxwell is not None) or (bouc_wen is not None) or (permanent_set is not None):
        change = u - w[own + COMPRESSION * W]
        w[own + COMPRESSION * W] = u
    if hardening is not None:
        steeper = cubic * (u * u)
        more += steeper * u
        slope += 3.0 * steeper
    if maxwell is not None:
        arm = decay * w[own + ARM * W] + gain * change
        w[own + ARM * W] = arm
        more += arm_stiffness * arm
        slope += arm_stiffness * gain
    if bouc_wen is not None:
        zeta = w[own + ZETA * W]
        loaded = min(max((zeta if change >= 0.0 else -zeta) * yielding, 0.0), 1.0)
        # |zeta/u_y|^(n-1), n = 1, 2, 3, 4; 0 while unloading, where zeta follows u
        first = 1.0 if loaded > 0.0 else 0.0
        second, third = loaded if order > 1.5 else 1.0, loaded if order > 2.5 else 1.0
        lower = first * second * third * (loaded if order > 3.5 else 1.0)
        eased = order * yielding * lower * abs(change) + 1e-8
        part = (1.0 - lower * loaded) * (1.0 - exponential_decay(eased)) / eased
        zeta += change * part
        w[own + ZETA * W] = zeta
        more += hysteretic * (zeta - u)
        slope += hysteretic * (part - 1.0)
    if mullins is not None:
        largest = max(w[own + LARGEST * W], u)
        w[own + LARGEST * W] = largest
        lost = softening - softening * exponential_decay(largest * per_strain)
        more -= lost * u
        slope -= lost
    if permanent_set is not None:
        kept = w[own + SET * W]
        kept += flow * max(u - 0.5 * change - kept - limit, 0.0)
        w[own + SET * W] = kept
        more -= k * kept
    linear = k * u + c * (node * turn_rate - z_rate)
    total = linear + more
    touching = down > 0.0
    stress = max(total, floor) - max(linear, floor) if touching else 0.0
    return stress, slope if touching & (total > floor) else 0.0


@inlined
def fibres_of(w: Table, joint: int, f: int, i: int, laws: Any) -> None:
    """Fibres f to f + 3 of a joint of one lane: what they add to its force, moment and slopes."""
    shared = constants(w, joint, i, laws)
    s0, d0 = fibre(w, joint, f, i, NODES[f], shared, laws)
    s1, d1 = fibre(w, joint, f + 1, i, NODES[f + 1], shared, laws)
    s2, d2 = fibre(w, joint, f + 2, i, NODES[f + 2], shared, laws)
    s3, d3 = fibre(w, joint, f + 3, i, NODES[f + 3], shared, laws)
    w[(r.FN_B + joint) * W + i] += WEIGHTS[f] * s0 + WEIGHTS[f + 1] * s1 + WEIGHTS[f + 2] * s2 + WEIGHTS[f + 3] * s3
    w[(r.FM_B + joint) * W + i] += FIRST[f] * s0 + FIRST[f + 1] * s1 + FIRST[f + 2] * s2 + FIRST[f + 3] * s3
    w[(r.F1_B + joint) * W + i] += WEIGHTS[f] * d0 + WEIGHTS[f + 1] * d1 + WEIGHTS[f + 2] * d2 + WEIGHTS[f + 3] * d3
    w[(r.F2_B + joint) * W + i] += FIRST[f] * d0 + FIRST[f + 1] * d1 + FIRST[f + 2] * d2 + FIRST[f + 3] * d3
    w[(r.F3_B + joint) * W + i] += SECOND[f] * d0 + SECOND[f + 1] * d1 + SECOND[f + 2] * d2 + SECOND[f + 3] * d3


@inlined
def lengths(w: Table, i: int) -> None:
    """From sums over [-1, 1] to integrals over both joints of one lane."""
    for joint in range(2):
        b = w[(r.B1 + joint) * W + i]
        w[(r.FN_B + joint) * W + i] *= b
        w[(r.FM_B + joint) * W + i] *= b * b
        w[(r.F1_B + joint) * W + i] *= b
        w[(r.F2_B + joint) * W + i] *= b * b
        w[(r.F3_B + joint) * W + i] *= b * b * b


@inlined
def fibres_all(w: Table, laws: Any) -> None:
    """The fibres of all lanes at the predictor of the coming step."""
    # a length read at run time: else the compiler unrolls the loops instead of making vector code
    lanes = w.size // r.N_WORK_LAWS
    for i in range(lanes):
        predicted_strips(w, i)
    for f in range(0, FIBRES, 4):
        for i in range(lanes):
            fibres_of(w, 0, f, i, laws)
    for f in range(0, FIBRES, 4):
        for i in range(lanes):
            fibres_of(w, 1, f, i, laws)
    for i in range(lanes):
        lengths(w, i)


@inlined
def fibres_at_start(w: Table, given: Table, lane: int, slot: int, laws: Any) -> None:
    """Relaxed hidden states of a lane, and its fibres' forces in the state from which it starts."""
    for joint in range(2):
        for row in range(r.N_LAW):
            w[(r.W_LAWS + joint * r.N_LAW + row) * W + slot] = given[lane, r.Q_LAWS + joint * r.N_LAW + row]
    w[r.STEP * W + slot], kept = 0.0, w[r.STEP * W + slot]
    predicted_strips(w, slot)
    # the state may be another than at rest: its forces first, then its history begins relaxed
    for again in range(2):
        for joint in range(2):
            turn, z = w[(r.B1 + joint) * W + slot] * w[(r.FS_B + joint) * W + slot], w[(r.FZ_B + joint) * W + slot]
            for f in range(FIBRES):
                own = (r.W_FIBRES + (joint * FIBRES + f) * N_HIDDEN) * W + slot
                w[own + COMPRESSION * W], w[own + ARM * W], w[own + SET * W] = max(NODES[f] * turn - z, 0.0), 0.0, 0.0
                w[own + ZETA * W] = given[lane, r.Q_RELAXED + 2 * joint + 1]
                w[own + LARGEST * W] = given[lane, r.Q_RELAXED + 2 * joint]
            if again == 0:
                for f in range(0, FIBRES, 4):
                    fibres_of(w, joint, f, slot, laws)
    lengths(w, slot)
    w[r.STEP * W + slot] = kept
