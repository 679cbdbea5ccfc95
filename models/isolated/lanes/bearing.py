"""The bearings' force beyond the linear one over the coming step, for all lanes; see `models.isolated.bearing`.

u and u' at the step's end are predicted with the force held, to the third order in the step. The laws of
`models.rubber` advance from where they last looked, u linear between. Where Payne's amplitude or the count of
cycles changes inside the step, the force jumps there; the straight line that the step rule takes instead has the
same impulse and moment.
"""

from __future__ import annotations

from collections.abc import Callable

from models.isolated.lanes import rows as r
from models.isolated.lanes.rows import Table, W
from models.isolated.lanes.tables import Lent
from models.lanes.compiler import inlined
from models.lanes.elementary import exponential_decay
from models.rubber import lanes as rubber
from models.rubber.base import RubberLaw

# --- rows of the springs, W numbers each: u predicted, the springs' force there, u at the last look, stiffness; then
# the laws' hidden states and numbers
U, WHOLE, LAST, K, HIDDEN = (row * W for row in range(5))
P_LAWS = HIDDEN + rubber.N_HIDDEN * W
GOING = P_LAWS + rubber.N_NUMBERS * W
"""What passes from law to law: u, its change, force beyond k u, slope."""
N_SPRING = GOING + 4 * W
PLACES = rubber.Places(HIDDEN, W, P_LAWS, W)


@inlined
def predict(s: Table, spring: Table, y: Table, g: Table, levels: int, i: int) -> None:
    """u and u' at the step's end.

    ``y`` (2 levels, W): the state at the step's end without this force; ``g`` (2 levels, 4, W): the step's gains.
    """
    force = s[r.FORCE, i]
    spring[U + i] = y[0, i] + (g[0, 2, i] + g[0, 3, i]) * force
    s[r.RATE_NEXT, i] = y[levels, i] + (g[levels, 2, i] + g[levels, 3, i]) * force


@inlined
def close(s: Table, x: Table, p: Table, spring: Table, i: int) -> None:
    """Sets the force's ends BEFORE and AFTER for the step, FORCE for the next, and the memory."""
    u, rate, u_was, rate_was = spring[U + i], s[r.RATE_NEXT, i], x[r.U, i], x[r.RATE, i]
    force, size, linear, whole = s[r.FORCE, i], abs(u), p[r.K, i] * u, spring[WHOLE + i]
    # --- Payne: the amplitude before and after a reversal in this step
    amplitude, turned = x[r.AMPLITUDE, i], rate * rate_was < 0.0
    share = rate_was / (rate_was - rate) if turned else 1.0
    reached = abs(u_was + 0.5 * share * s[r.STEP, i] * rate_was) if turned else amplitude
    old = p[r.P_PAYNE, i] * (1.0 - exponential_decay(max(amplitude, size) * p[r.P_PER_AMPLITUDE, i]))
    new = p[r.P_PAYNE, i] * (1.0 - exponential_decay(max(reached, size) * p[r.P_PER_AMPLITUDE, i]))
    # --- wear: floor(crossings/2) full cycles
    worn, crossed = x[r.WEAR, i], u * u_was < 0.0
    crossings = x[r.CROSSINGS, i] + (1.0 if crossed else 0.0)
    wear = 1.0 - p[r.P_LOSS, i] * (1.0 - exponential_decay(float(int(0.5 * crossings)) * p[r.P_PER_CROSSING, i]))
    share = u_was / (u_was - u) if crossed else share
    # --- on the branch of the step's start, and after the jump
    before = worn * (whole - old * whole) - linear
    after = wear * (whole - new * whole) - linear
    left, jump = 1.0 - share, after - before
    s[r.BEFORE, i] = force + jump * left * (3.0 * left - 2.0)
    s[r.AFTER, i] = before + jump * left * (4.0 - 3.0 * left)
    s[r.FORCE, i] = after
    x[r.U, i], x[r.RATE, i] = u, rate
    x[r.AMPLITUDE, i], x[r.CROSSINGS, i], x[r.WEAR, i] = reached, crossings, wear


def _pass(law: RubberLaw) -> Callable[..., None]:
    """Compiled ``(spring)``: one law in all lanes."""
    numbers, go_on = rubber.passing(law, PLACES, GOING)

    @inlined
    def all_lanes(spring: Table) -> None:
        for i in range(W):
            go_on(spring, i, spring[K + i], numbers(spring, i))

    return all_lanes


_passes = rubber.guarded([_pass(law) for law in rubber.ORDER])


@inlined
def springs_all(spring: Table, acting: int) -> None:
    """The springs' force of all lanes; the laws that act go on from one look to the next."""
    for i in range(W):
        u = spring[U + i]
        spring[GOING + i], spring[GOING + W + i] = u, u - spring[LAST + i]
        spring[GOING + 2 * W + i], spring[GOING + 3 * W + i] = 0.0, 0.0
        spring[LAST + i] = u
    _passes(spring, acting)
    for i in range(W):
        spring[WHOLE + i] = spring[K + i] * spring[U + i] + spring[GOING + 2 * W + i]


@inlined
def bearing_all(work: Lent, laws: int, levels: int) -> None:
    """The bearings of all lanes with those ``laws`` that act, as of `models.rubber.lanes.acting`."""
    s, x, spring = work.scalars, work.memory, work.spring
    for i in range(W):
        predict(s, spring, work.new, work.gains, levels, i)
    springs_all(spring, laws)
    for i in range(W):
        close(s, x, work.numbers, spring, i)
