"""Rubber laws along both strips: 16 Gauss fibres of the difference to the linear law, for all lanes.

At the predictor of the coming step every fibre's compression goes on linearly in time over the step. What the laws
add to the force, and its slope, is summed into the rows that the step rule reads; see `models.interface.lanes.along`.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from models.interface.fibres import COUNT, NODES
from models.interface.lanes import rows as r
from models.interface.lanes.along import APART, LAST, P_LAWS, base_fibres, sided_base_fibres, top_fibres
from models.interface.lanes.rows import W
from models.lanes.arrays import Table
from models.lanes.compiler import called, inlined
from models.lanes.elementary import sine_cosine
from models.rubber import lanes as rubber

UNBOUNDED = 1e300


class Rubber(NamedTuple):
    """The laws of n walls, as the kernel is given them: base and top on the second axis."""

    numbers: Table
    """(n, 2, `N_NUMBERS` of `models.rubber.lanes`)."""
    hidden: Table
    """(n, 2, `N_HIDDEN`, 16) at the start."""
    ended: Table
    """The same at the end, for the kernel to fill."""
    base: int
    """Which laws act at the base, as of `models.rubber.lanes.acting`."""
    top: int


@inlined
def predicted_strips(w: Table, i: int) -> None:
    """z, b S, c z', c b S' of both strips at the predictor of the coming step, and the least stress."""
    h = w[r.STEP * W + i]
    half = 0.5 * h * h
    v1, v2 = w[r.V1 * W + i] + h * w[r.A1 * W + i], w[r.V2 * W + i] + h * w[r.A2 * W + i]
    t1 = w[r.T1 * W + i] + h * w[r.V1 * W + i] + half * w[r.A1 * W + i]
    t2 = w[r.T2 * W + i] + h * w[r.V2 * W + i] + half * w[r.A2 * W + i]
    s1, c1 = sine_cosine(t1)
    sr, cr = sine_cosine(t2 - t1)
    w[r.FZ_B * W + i] = w[r.Z1 * W + i] + h * w[r.Y1 * W + i] + half * w[r.AZ1 * W + i]
    w[r.FZ_T * W + i] = w[r.Z2 * W + i] + h * w[r.Y2 * W + i] + half * w[r.AZ2 * W + i]
    cb, ct = w[r.CB * W + i], w[r.CT * W + i]
    w[r.FY_B * W + i] = cb * (w[r.Y1 * W + i] + h * w[r.AZ1 * W + i])
    w[r.FY_T * W + i] = ct * (w[r.Y2 * W + i] + h * w[r.AZ2 * W + i])
    b1, bt = w[r.B1 * W + i], w[r.BT * W + i]
    w[r.FS_B * W + i], w[r.FS_T * W + i] = b1 * s1, bt * sr
    w[r.FR_B * W + i], w[r.FR_T * W + i] = cb * b1 * (c1 * v1), ct * bt * (cr * (v2 - v1))
    w[r.FLOOR * W + i] = 0.0 if w[r.CLIP * W + i] > 0.0 else -UNBOUNDED
    for row in range(10):
        w[(r.FN_B + row) * W + i] = 0.0


@inlined
def lengths(w: Table, joint: int, i: int) -> None:
    """From sums over [-1, 1] to integrals over a joint of one lane."""
    b = w[(r.B1 + joint) * W + i]
    w[(r.FN_B + joint) * W + i] *= b
    w[(r.FM_B + joint) * W + i] *= b * b
    w[(r.F1_B + joint) * W + i] *= b
    w[(r.F2_B + joint) * W + i] *= b * b
    w[(r.F3_B + joint) * W + i] *= b * b * b


@called
def fibres_all(w: Table, base: int, top: int) -> None:
    """The fibres of all lanes at the predictor of the coming step, with the laws of a `Rubber` that act."""
    for i in range(min(W, w.size)):
        predicted_strips(w, i)
    base_fibres(w, base)
    top_fibres(w, top)
    integrate(w)


@called
def sided_fibres(w: Table, base: int, top: int) -> None:
    """As `fibres_all` of lanes with effects, whose strips at the predictor are known."""
    sided_base_fibres(w, base)
    top_fibres(w, top)
    integrate(w)


@inlined
def integrate(w: Table) -> None:
    """The sums over [-1, 1] of all lanes to integrals over the joints."""
    for i in range(min(W, w.size)):
        # no loop over the joints: it would not become vector code
        lengths(w, 0, i)
        lengths(w, 1, i)


@called
def fibres_at_start(w: Table, laws: Rubber, lane: int, slot: int, more: Any, upper: float) -> None:
    """A lane's fibres in the state from which it starts: their forces there first, then its history begins.

    ``upper``: angle (rad) of what the block stands on; ``more``: None without effects.
    """
    w[r.STEP * W + slot], kept = 0.0, w[r.STEP * W + slot]
    predicted_strips(w, slot)
    w[r.FS_T * W + slot] = w[r.BT * W + slot] * sine_cosine(w[r.T2 * W + slot] - upper)[0]
    for joint in range(2):
        for row in range(rubber.N_NUMBERS):
            w[P_LAWS[joint] + row * W + slot] = laws.numbers[lane, joint, row]
        turn = w[(r.FS_B + joint) * W + slot]
        for f in range(COUNT):
            w[LAST[joint] + f * W + slot] = max(NODES[f] * turn - w[(r.FZ_B + joint) * W + slot], 0.0)
            for row in range(rubber.N_HIDDEN):
                w[LAST[joint] + ((row + 1) * APART + f) * W + slot] = laws.hidden[lane, joint, row, f]
    # in a table of its own, so that no history moves
    alone = w.copy()
    if more is None:
        fibres_all(alone, laws.base, laws.top)
    else:
        sided_fibres(alone, laws.base, laws.top)
    for row in range(r.FN_B, r.FN_B + 10):
        w[row * W + slot] = alone[row * W + slot]
    w[r.STEP * W + slot] = kept


@called
def fibres_at_end(w: Table, laws: Rubber, lane: int, slot: int) -> None:
    """The hidden states of a lane that ends, on record."""
    for joint in range(2):
        for row in range(rubber.N_HIDDEN):
            for f in range(COUNT):
                laws.ended[lane, joint, row, f] = w[LAST[joint] + ((row + 1) * APART + f) * W + slot]
