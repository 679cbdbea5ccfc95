"""What a joint does where a watched value becomes positive; see `models.interface_linear.equation`."""

from __future__ import annotations

from models.interface_linear.equation import (
    FULL,
    HALF_LEFT,
    HALF_RIGHT,
    HELD_LEFT,
    HELD_RIGHT,
    KICK,
    STATES,
)
from models.interface_linear.lanes.rows import B_B, BRIEF, A, G
from models.lanes.arrays import Table
from models.lanes.compiler import called, inlined


@inlined
def opening(system: Table, c: int, joint: int, arm: float, x: Table) -> float:
    """h'' of a joint in configuration c, ``arm`` = s b."""
    found = 0.0
    for k in range(10):
        weight = x[k] if k < 8 else (x[A] if k == 8 else x[G])
        turn = system[c, k, 1] - system[c, k, 0] if joint == 1 else system[c, k, 0]
        found += (system[c, k, 2 + joint] + arm * turn) * weight
    return float(found)


@inlined
def with_state(c: int, joint: int, state: int) -> int:
    return STATES * state + c % STATES if joint == 0 else c - c % STATES + state


@inlined
def hold(given: Table, lane: int, system: Table, held: int, joint: int, side: float, x: Table) -> None:
    """Put the state on h = h' = 0 of a joint that is held in configuration ``held`` (mu d does it)."""
    arm = side * given[lane, B_B + joint]
    x[2 + joint] = -arm * (x[1] - x[0] if joint == 1 else x[0])
    rate = x[6 + joint] + arm * (x[5] - x[4] if joint == 1 else x[4])
    for k in range(4):
        x[4 + k] -= rate * system[held, 4 * joint + k, KICK]


@called
def successor(given: Table, lane: int, system: Table, c: int, event: int, x: Table) -> int:
    """The configuration after watched value ``event``; a joint that comes to be held loses its h and h'.

    At a switch between full and half contact the joint is held where both sides lead back (h'' > 0 in full,
    < 0 in half contact) and the coming excursion, 2 |h'|/|h''|, is shorter than ``BRIEF``.
    """
    joint, second = event // 2, event % 2 == 1
    state = c // STATES if joint == 0 else c % STATES
    if state in (HELD_RIGHT, HELD_LEFT):
        half = HALF_RIGHT if state == HELD_RIGHT else HALF_LEFT
        hold(given, lane, system, c, joint, 1.0 if half == HALF_RIGHT else -1.0, x)
        return with_state(c, joint, half if second else FULL)
    if second and state != FULL:
        return with_state(c, joint, HALF_LEFT if state == HALF_RIGHT else HALF_RIGHT)
    half = state
    if state == FULL:
        half = HALF_LEFT if second else HALF_RIGHT
    side = 1.0 if half == HALF_RIGHT else -1.0
    arm = side * given[lane, B_B + joint]
    in_full = opening(system, with_state(c, joint, FULL), joint, arm, x)
    in_half = opening(system, with_state(c, joint, half), joint, arm, x)
    rate = x[6 + joint] + arm * (x[5] - x[4] if joint == 1 else x[4])
    after = in_half if state == FULL else in_full
    if in_full > 0.0 and in_half < 0.0 and 2.0 * abs(rate) <= given[lane, BRIEF] * abs(after):
        held = with_state(c, joint, HELD_RIGHT if half == HALF_RIGHT else HELD_LEFT)
        hold(given, lane, system, held, joint, side, x)
        return held
    return with_state(c, joint, half if state == FULL else FULL)
