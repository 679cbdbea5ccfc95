"""The bearings' force beyond the linear one over the coming step, for all lanes; see `models.isolated.bearing`.

u and u' at the step's end are predicted with the force held, to the third order in the step. Hidden states advance
from where they last looked, u linear between: the Maxwell arm exactly, Bouc-Wen by the exponential
Rosenbrock-Euler rule. Where Payne's amplitude or the count of cycles changes inside the step, the force
jumps there; the straight line that the step rule takes instead has the same impulse and moment.
"""

from __future__ import annotations

from typing import Any

from models.isolated.lanes import rows as r
from models.lanes.compiler import inlined
from models.lanes.elementary import exponential_decay

Table = Any


@inlined
def bearing_one(s: Table, x: Table, p: Table, y: Table, g: Table, levels: int, i: int) -> None:
    """One lane: advances its memory, sets the force's ends BEFORE and AFTER for the step, FORCE for the next.

    ``y``: the state at the step's end without this force; ``g`` (2 levels, 4, W): the step's gains.
    """
    force = s[r.FORCE, i]
    u = y[0, i] + (g[0, 2, i] + g[0, 3, i]) * force
    rate = y[levels, i] + (g[levels, 2, i] + g[levels, 3, i]) * force
    u_was, rate_was = x[r.U, i], x[r.RATE, i]
    size, change = abs(u), u - u_was
    k = p[r.K, i]
    whole = k * u * p[r.P_HARDENING, i] * u * u
    arm = p[r.P_ARM_DECAY, i] * x[r.ARM, i] + p[r.P_ARM_GAIN, i] * change
    whole += p[r.P_ARM, i] * arm
    # --- Bouc-Wen: |zeta/u_y|^(n-1), n = 1, 2, 3, 4
    zeta, order = x[r.ZETA, i], p[r.P_ORDER, i]
    way = 1.0 if change >= 0.0 else -1.0
    loaded = min(max(way * zeta * p[r.P_YIELD, i], 0.0), 1.0)
    first, second = 1.0 if loaded > 0.0 else 0.0, loaded if order > 1.5 else 1.0
    lower = first * second * (loaded if order > 2.5 else 1.0) * (loaded if order > 3.5 else 1.0)
    eased = order * lower * p[r.P_YIELD, i] * abs(change) + 1e-8
    zeta += change * (1.0 - lower * loaded) * (1.0 - exponential_decay(eased)) / eased
    whole += p[r.P_HYSTERETIC, i] * (zeta - u)
    # --- Mullins
    largest = max(x[r.LARGEST, i], size)
    whole -= k * u * p[r.P_SOFTENING, i] * (1.0 - exponential_decay(largest * p[r.P_PER_STRAIN, i]))
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
    linear = k * u
    before = worn * (linear + whole - old * linear) - linear
    after = wear * (linear + whole - new * linear) - linear
    left, jump = 1.0 - share, after - before
    s[r.BEFORE, i] = force + jump * left * (3.0 * left - 2.0)
    s[r.AFTER, i] = before + jump * left * (4.0 - 3.0 * left)
    s[r.FORCE, i] = after
    x[r.U, i], x[r.RATE, i], x[r.ARM, i], x[r.ZETA, i] = u, rate, arm, zeta
    x[r.LARGEST, i], x[r.AMPLITUDE, i], x[r.CROSSINGS, i], x[r.WEAR, i] = largest, reached, crossings, wear
