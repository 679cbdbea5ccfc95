"""What happens to a lane with effects now and then: it starts, its accelerations are made consistent, it ends."""

from __future__ import annotations

from typing import Any

from models.interface.effects import CELLS
from models.interface.lanes import rows as r
from models.interface.lanes.effects import rows as e
from models.interface.lanes.effects.landing import touch
from models.interface.lanes.effects.rows import More
from models.interface.lanes.effects.step import predict, step
from models.interface.lanes.rows import W
from models.interface.lanes.step import AM
from models.lanes.arrays import Table
from models.lanes.compiler import called
from models.lanes.elementary import exponential_decay


@called
def put(t: Table, m: More, lane: int, slot: int) -> None:
    """A lane's constants, state and memory; ``t`` holds those of the plain kernel already."""
    vacate(t, slot)
    for k in range(e.G_STATE):
        t[e.PITCH + k * W + slot] = m.given[lane, k]
    for k in range(8):
        t[e.X1 + k * W + slot] = m.given[lane, e.G_STATE + k]
    for k in range(4):
        t[e.CLOSINGS + k * W + slot] = m.given[lane, e.G_MEMORY + k]
    for k in range(2 * CELLS):
        t[e.LANDED + k * W + slot] = m.given[lane, e.G_LANDED + k]
    for k in range(e.N_LAW):
        t[e.REACH + k * W + slot] = m.given[lane, e.G_LAW + k]
    follow(t, slot, 0.0, 0.0)
    touch(t, slot)
    wear = 1.0 - t[e.LOSS + slot] * (1.0 - exponential_decay(t[e.CLOSINGS + slot] * t[e.PER_CLOSING + slot]))
    t[r.FACTOR_L * W + slot], t[r.FACTOR_R * W + slot] = wear * t[e.LEFT + slot], wear * t[e.RIGHT + slot]


@called
def follow(t: Table, slot: int, turn: float, rate: float) -> None:
    """The upper half of a wall goes with the lower one, set anew by ``turn`` (rad) and ``rate``: its bend stays."""
    if t[e.FREE_M + slot] == 0.0:
        t[e.TM + slot], t[e.VTM + slot] = t[r.T1 * W + slot], t[r.V1 * W + slot]
    else:
        t[e.TM + slot] += turn
        t[e.VTM + slot] += rate


@called
def vacate(t: Table, slot: int) -> None:
    """A slot without a lane: bodies of unit mass that nothing turns."""
    for k in range(e.N_OWN + e.N_LANDED):
        t[e.OWN + k * W + slot] = 0.0
    for k in range(e.N_LAW + 2):
        t[e.REACH + k * W + slot] = 0.0
    t[e.HALF_MASS + slot], t[e.HALF_INERTIA + slot], t[e.LENGTH + slot] = 1.0, 1.0, 1.0


@called
def settle(t: Table, m: More, slot: int, a: float, v: float, laws: Any) -> None:
    """The acceleration of a lane's state under the record's values a and v; nothing else changes."""
    alone = t.copy()
    alone[r.RA * W + slot], alone[r.RV * W + slot] = a, v
    for row in (r.STEP, r.HALF, r.NEAR, r.FAR):
        alone[row * W + slot] = 0.0
    for k in range(4):
        alone[(r.A1 + k) * W + slot], alone[e.AX1 + k * W + slot] = 0.0, 0.0
    # a step of no length from no acceleration: (1 - am) M d = Q - n
    predict(alone, m)
    step(alone, m, laws)
    for k in range(4):
        t[(r.A1 + k) * W + slot] = (1.0 - AM) * alone[(r.A1 + k) * W + slot]
        t[e.AX1 + k * W + slot] = (1.0 - AM) * alone[e.AX1 + k * W + slot]
    for row in (r.POWER_B, r.POWER_T, r.LIFT_B, r.LIFT_T, r.EDGE_B, r.EDGE_T):
        t[row * W + slot] = alone[row * W + slot]
    for row in (r.ALONG_B, r.ALONG_T, r.ACROSS_B, r.ACROSS_T):
        t[row * W + slot] = alone[row * W + slot]


@called
def load_pitch(t: Table, m: More, slot: int, record: Table, sample: int, shaken: int, n: float) -> None:
    """The pitch at ``sample`` and its growth over each of the n steps that follow."""
    if m.acts & e.PITCHES:
        for row in range(2):
            value = record[2 + row, sample] if sample < shaken else 0.0
            growth = (record[2 + row, sample + 1] - value) / n if sample < shaken else 0.0
            t[e.PSI + row * W + slot], t[e.GROWTH_PSI + row * W + slot] = value, growth


@called
def pitch_on(t: Table, m: More) -> None:
    """The pitch at the end of the coming step."""
    if m.acts & e.PITCHES:
        for i in range(min(W, t.size)):
            t[e.PSI + i] += t[e.GROWTH_PSI + i]
            t[e.PSI_SECOND + i] += t[e.GROWTH_SECOND + i]


@called
def put_on_record(t: Table, m: More, lane: int, slot: int) -> None:
    """Coordinates, rates and memory of a lane that ends."""
    for k in range(8):
        m.ended[lane, k] = t[e.X1 + k * W + slot]
    for k in range(4):
        m.ended[lane, 8 + k] = t[e.CLOSINGS + k * W + slot]
    for k in range(2 * CELLS):
        m.ended[lane, 12 + k] = t[e.LANDED + k * W + slot]
