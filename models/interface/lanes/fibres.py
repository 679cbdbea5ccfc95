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
from models.interface.lanes.rows import W
from models.lanes.compiler import inlined
from models.lanes.elementary import exponential_decay, sine_cosine

Table = Any
FIBRES = 16
NODES, WEIGHTS = np.polynomial.legendre.leggauss(FIBRES)
COMPRESSION, ARM, ZETA, LARGEST, SET = range(5)
"""Hidden rows of a fibre: u at the last step, Maxwell's spring, zeta, largest u, permanent compression."""
N_HIDDEN = 5


@inlined
def predicted_strips(w: Table, i: int) -> None:
    """z, S, z', S' of both strips at the predictor of the coming step."""
    h = w[r.STEP * W + i]
    half = 0.5 * h * h
    v1, v2 = w[r.V1 * W + i] + h * w[r.A1 * W + i], w[r.V2 * W + i] + h * w[r.A2 * W + i]
    t1 = w[r.T1 * W + i] + h * w[r.V1 * W + i] + half * w[r.A1 * W + i]
    t2 = w[r.T2 * W + i] + h * w[r.V2 * W + i] + half * w[r.A2 * W + i]
    s1, c1 = sine_cosine(t1)
    s2, c2 = sine_cosine(t2)
    w[r.FZ_B * W + i] = w[r.Z1 * W + i] + h * w[r.Y1 * W + i] + half * w[r.AZ1 * W + i]
    w[r.FZ_T * W + i] = w[r.Z2 * W + i] + h * w[r.Y2 * W + i] + half * w[r.AZ2 * W + i]
    w[r.FY_B * W + i], w[r.FY_T * W + i] = (
        w[r.Y1 * W + i] + h * w[r.AZ1 * W + i],
        w[r.Y2 * W + i] + h * w[r.AZ2 * W + i],
    )
    w[r.FS_B * W + i], w[r.FS_T * W + i] = s1, s2 * c1 - c2 * s1
    w[r.FR_B * W + i], w[r.FR_T * W + i] = c1 * v1, (c2 * c1 + s2 * s1) * (v2 - v1)
    for row in range(10):
        w[(r.FN_B + row) * W + i] = 0.0


@inlined
def fibre(w: Table, x: Table, p: Table, joint: int, f: int, i: int, node: float, weight: float, laws: Any) -> None:
    """One fibre of one lane: advances its hidden state, adds its force, moment and slopes."""
    hardening, maxwell, bouc_wen, mullins, permanent_set = laws
    b = w[(r.B1 + joint) * W + i]
    k, c = w[(r.KB + joint) * W + i], w[(r.CB + joint) * W + i]
    place = node * b
    down = place * w[(r.FS_B + joint) * W + i] - w[(r.FZ_B + joint) * W + i]
    u = max(down, 0.0)
    fast = place * w[(r.FR_B + joint) * W + i] - w[(r.FY_B + joint) * W + i]
    own = (joint * FIBRES + f) * N_HIDDEN * W
    change = u - x[own + COMPRESSION * W + i]
    middle = u - 0.5 * change
    x[own + COMPRESSION * W + i] = u
    more, slope = 0.0, 0.0
    if hardening is not None:
        grown = p[(joint * r.N_LAW + r.P_HARDENING) * W + i] * u * u
        more += k * u * grown
        slope += 3.0 * k * grown
    if maxwell is not None:
        gain = p[(joint * r.N_LAW + r.P_ARM_GAIN) * W + i]
        arm = p[(joint * r.N_LAW + r.P_ARM_DECAY) * W + i] * x[own + ARM * W + i] + gain * change
        x[own + ARM * W + i] = arm
        more += p[(joint * r.N_LAW + r.P_ARM) * W + i] * arm
        slope += p[(joint * r.N_LAW + r.P_ARM) * W + i] * gain
    if bouc_wen is not None:
        zeta = x[own + ZETA * W + i]
        yielding = p[(joint * r.N_LAW + r.P_YIELD) * W + i]
        order = p[(joint * r.N_LAW + r.P_ORDER) * W + i]
        way = 1.0 if change >= 0.0 else -1.0
        loaded = min(max(way * zeta * yielding, 0.0), 1.0)
        # |zeta/u_y|^(n-1), n = 1, 2, 3, 4
        second, third = loaded if order > 1.5 else 1.0, loaded if order > 2.5 else 1.0
        lower = second * third * (loaded if order > 3.5 else 1.0)
        eased = order * lower * yielding * abs(change) + 1e-8
        part = (1.0 - lower * loaded) * (1.0 - exponential_decay(eased)) / eased
        zeta += change * part
        x[own + ZETA * W + i] = zeta
        more += p[(joint * r.N_LAW + r.P_HYSTERETIC) * W + i] * (zeta - u)
        slope += p[(joint * r.N_LAW + r.P_HYSTERETIC) * W + i] * (part - 1.0)
    if mullins is not None:
        largest = max(x[own + LARGEST * W + i], u)
        x[own + LARGEST * W + i] = largest
        lost = (
            k
            * p[(joint * r.N_LAW + r.P_SOFTENING) * W + i]
            * (1.0 - exponential_decay(largest * p[(joint * r.N_LAW + r.P_PER_STRAIN) * W + i]))
        )
        more -= lost * u
        slope -= lost
    if permanent_set is not None:
        kept = x[own + SET * W + i]
        kept += (
            max(middle - kept - p[(joint * r.N_LAW + r.P_LIMIT) * W + i], 0.0) * p[(joint * r.N_LAW + r.P_SET) * W + i]
        )
        x[own + SET * W + i] = kept
        more -= k * kept
    linear = k * u + c * fast
    total = linear + more
    clip = w[r.CLIP * W + i] > 0.0
    carried = max(total, 0.0) if clip else total
    spared = max(linear, 0.0) if clip else linear
    touching = down > 0.0
    stress = weight * b * (carried - spared) if touching else 0.0
    slope = weight * b * slope if touching & (carried != 0.0) else 0.0
    w[(r.FN_B + joint) * W + i] += stress
    w[(r.FM_B + joint) * W + i] += stress * place
    w[(r.F1_B + joint) * W + i] += slope
    w[(r.F2_B + joint) * W + i] += slope * place
    w[(r.F3_B + joint) * W + i] += slope * place * place


@inlined
def fibres_all(w: Table, x: Table, p: Table, laws: Any) -> None:
    """The fibres of all lanes at the predictor of the coming step."""
    for i in range(W):
        predicted_strips(w, i)
    for f in range(FIBRES):
        for i in range(W):
            fibre(w, x, p, 0, f, i, NODES[f], WEIGHTS[f], laws)
    for f in range(FIBRES):
        for i in range(W):
            fibre(w, x, p, 1, f, i, NODES[f], WEIGHTS[f], laws)


@inlined
def fibres_at_start(w: Table, x: Table, p: Table, given: Table, lane: int, slot: int, laws: Any) -> None:
    """Relaxed hidden states of a lane, and its fibres' forces in the state from which it starts."""
    for joint in range(2):
        for row in range(r.N_LAW):
            p[(joint * r.N_LAW + row) * W + slot] = given[lane, r.Q_LAWS + joint * r.N_LAW + row]
    w[r.STEP * W + slot], kept = 0.0, w[r.STEP * W + slot]
    predicted_strips(w, slot)
    for joint in range(2):
        for f in range(FIBRES):
            own = (joint * FIBRES + f) * N_HIDDEN * W
            # the state may be another than at rest: its forces first, then its history begins relaxed
            for again in range(2):
                u = given[lane, r.Q_RELAXED + 2 * joint]
                x[own + COMPRESSION * W + slot], x[own + ARM * W + slot], x[own + SET * W + slot] = u, 0.0, 0.0
                x[own + ZETA * W + slot] = given[lane, r.Q_RELAXED + 2 * joint + 1]
                x[own + LARGEST * W + slot] = u
                if again == 0:
                    fibre(w, x, p, joint, f, slot, NODES[f], WEIGHTS[f], laws)
    w[r.STEP * W + slot] = kept
