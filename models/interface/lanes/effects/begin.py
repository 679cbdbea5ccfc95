"""What happens to a lane with effects now and then: it starts, its accelerations are made consistent, it ends."""

from __future__ import annotations

from typing import Any

from models.interface.lanes import rows as r
from models.interface.lanes.effects import rows as e
from models.interface.lanes.effects.rows import More
from models.interface.lanes.effects.step import predict, step
from models.interface.lanes.step import AM
from models.lanes.arrays import Table
from models.lanes.compiler import called
from models.lanes.elementary import exponential_decay


@called
def put(w: Table, m: More, lane: int, slot: int) -> None:
    """A lane's constants, state and memory; ``w`` holds those of the plain kernel already."""
    own, given = m.own, m.given
    for k in range(e.N_OWN):
        own[k, slot] = 0.0
    for k in range(e.G_STATE):
        own[e.PITCH + k, slot] = given[lane, k]
    for k in range(8):
        own[e.X1 + k, slot] = given[lane, e.G_STATE + k]
    for k in range(4):
        own[e.CLOSINGS + k, slot] = given[lane, e.G_MEMORY + k]
    if own[e.FREE_M, slot] == 0.0:
        own[e.TM, slot], own[e.VTM, slot] = w[r.T1, slot], w[r.V1, slot]
    wear = 1.0 - own[e.LOSS, slot] * (1.0 - exponential_decay(own[e.CLOSINGS, slot] * own[e.PER_CLOSING, slot]))
    w[r.FACTOR_L, slot], w[r.FACTOR_R, slot] = wear * own[e.LEFT, slot], wear * own[e.RIGHT, slot]
    for body in range(2):
        m.weight[body, slot], m.weight[2 + body, slot] = own[e.HALF_MASS, slot], own[e.HALF_MASS, slot]
        m.weight[4 + body, slot], m.weight[6 + body, slot] = w[r.M2, slot], own[e.HALF_INERTIA, slot]
    m.weight[8, slot] = w[r.I2, slot]


@called
def vacate(m: More, slot: int) -> None:
    """A slot without a lane: bodies of unit mass that nothing turns."""
    for k in range(e.N_OWN):
        m.own[k, slot] = 0.0
    for row in range(9):
        m.weight[row, slot] = 1.0
    m.own[e.LENGTH, slot] = 1.0


@called
def settle(w: Table, m: More, slot: int, a: float, v: float, laws: Any) -> None:
    """The acceleration of a lane's state under the record's values a and v; nothing else changes."""
    kept, alone = m.own.copy(), w.copy()
    alone[r.RA, slot], alone[r.RV, slot] = a, v
    alone[r.STEP, slot], alone[r.HALF, slot], alone[r.NEAR, slot], alone[r.FAR, slot] = 0.0, 0.0, 0.0, 0.0
    for k in range(4):
        alone[r.A1 + k, slot], m.own[e.AX1 + k, slot] = 0.0, 0.0
    # a step of no length from no acceleration: (1 - am) M d = Q - n
    predict(alone, m)
    step(alone, m, laws)
    for k in range(4):
        w[r.A1 + k, slot] = (1.0 - AM) * alone[r.A1 + k, slot]
        kept[e.AX1 + k, slot] = (1.0 - AM) * m.own[e.AX1 + k, slot]
    for k in range(e.N_OWN):
        for i in range(m.q.shape[1]):
            m.own[k, i] = kept[k, i]
    for row in (r.POWER_B, r.POWER_T, r.LIFT_B, r.LIFT_T, r.EDGE_B, r.EDGE_T):
        w[row, slot] = alone[row, slot]
    for row in (r.ALONG_B, r.ALONG_T, r.ACROSS_B, r.ACROSS_T):
        w[row, slot] = alone[row, slot]


@called
def load_pitch(m: More, slot: int, record: Table, sample: int, shaken: int, n: float) -> None:
    """The pitch at ``sample`` and its growth over each of the n steps that follow."""
    if m.acts & e.PITCHES:
        for row in range(2):
            value = record[2 + row, sample] if sample < shaken else 0.0
            growth = (record[2 + row, sample + 1] - value) / n if sample < shaken else 0.0
            m.own[e.PSI + row, slot], m.own[e.GROWTH_PSI + row, slot] = value, growth


@called
def pitch_on(m: More) -> None:
    """The pitch at the end of the coming step."""
    if m.acts & e.PITCHES:
        for i in range(m.q.shape[1]):
            m.own[e.PSI, i] += m.own[e.GROWTH_PSI, i]
            m.own[e.PSI_SECOND, i] += m.own[e.GROWTH_SECOND, i]


@called
def put_on_record(m: More, lane: int, slot: int) -> None:
    """Coordinates, rates and memory of a lane that ends."""
    for k in range(8):
        m.ended[lane, k] = m.own[e.X1 + k, slot]
    for k in range(4):
        m.ended[lane, 8 + k] = m.own[e.CLOSINGS + k, slot]
