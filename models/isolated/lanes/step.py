"""One step of all W lanes: the linear chain exactly, the rest of the bearings' force to second order.

    y1 = P y0 + G (a0, a1, f0, f1), y = (x, x'); a linear between samples, f(u, ...) linear over a step,

an exponential rule: stiff storeys, however stiff, set no bound on the step, and with linear bearings the step has no
error at all. ``size`` is a tuple as long as the (padded) chain, so that the compiler knows its length;
``laws`` None: linear bearings, else which laws act (`models.rubber.lanes.acting`).
"""

from __future__ import annotations

from typing import Any

from models.isolated.lanes import rows as r
from models.isolated.lanes.bearing import bearing_all
from models.isolated.lanes.rows import Table, W
from models.isolated.lanes.tables import Lent
from models.lanes.compiler import inlined


@inlined
def read_one(s: Table, y: Table, new: Table, link: Table, mass: Table, size: Any, i: int) -> None:
    """Peaks, kinetic energy and the work of the shaking over the step that led to ``new``, one lane.

    ``link`` (3, levels, W): spring, dashpot and 1 for a storey (0 below the slab and beyond the chain);
    ``mass`` (2, levels, W): masses and their inverses.
    """
    levels = len(size)
    above, acceleration, drift, kinetic = 0.0, 0.0, 0.0, 0.0
    momentum, moment, moment_was, momentum_was = 0.0, 0.0, 0.0, 0.0
    for back in range(levels):
        j = levels - 1 - back
        x, v = new[j, i], new[levels + j, i]
        below_x, below_v = (new[j - 1, i], new[levels + j - 1, i]) if j > 0 else (0.0, 0.0)
        force = link[0, j, i] * (x - below_x) + link[1, j, i] * (v - below_v)
        if j == 0:
            force += s[r.FORCE, i]
        acceleration = max(acceleration, abs((above - force) * mass[1, j, i]))
        drift = max(drift, abs(x - below_x) * link[2, j, i])
        above = force
        m = mass[0, j, i]
        kinetic += m * v * v
        moment += m * x
        momentum += m * v
        moment_was += m * y[j, i]
        momentum_was += m * y[levels + j, i]
    # u between the ends of the step too: where u', taken as linear, is zero
    h, rate_was, rate = s[r.STEP, i], y[levels, i], new[levels, i]
    turned = rate_was * rate < 0.0
    reached = y[0, i] + (0.5 * h * rate_was * rate_was / (rate_was - rate) if turned else 0.0)
    s[r.PEAK_U, i] = max(s[r.PEAK_U, i], max(abs(new[0, i]), abs(reached)))
    s[r.PEAK_ACCELERATION, i] = max(s[r.PEAK_ACCELERATION, i], acceleration)
    s[r.PEAK_DRIFT, i] = max(s[r.PEAK_DRIFT, i], drift)
    s[r.KINETIC, i] = max(s[r.KINETIC, i], kinetic)
    s[r.WINDOW, i] = max(s[r.WINDOW, i], kinetic)
    # -integral of a sum(m x') by parts, with the cubic through both ends of the step
    a0, a1 = s[r.AT, i], s[r.NEXT, i]
    mean = 0.5 * (moment + moment_was) + h / 12.0 * (momentum_was - momentum)
    s[r.WORK, i] -= a1 * moment - a0 * moment_was - (a1 - a0) * mean


@inlined
def step_all(work: Lent, size: Any, laws: Any) -> None:
    """One step of all lanes."""
    s, y, new, g, transition = work.scalars, work.state, work.new, work.gains, work.transition
    levels = len(size)
    for i in range(W):
        s[r.NEXT, i] = s[r.AT, i] + s[r.GROWTH, i]
    for row in range(2 * levels):
        for i in range(W):
            total = g[row, 0, i] * s[r.AT, i] + g[row, 1, i] * s[r.NEXT, i]
            for column in range(2 * levels):
                total += transition[row, column, i] * y[column, i]
            new[row, i] = total
    if laws is not None:
        bearing_all(work, laws, levels)
        for row in range(2 * levels):
            for i in range(W):
                new[row, i] += g[row, 2, i] * s[r.BEFORE, i] + g[row, 3, i] * s[r.AFTER, i]
    for i in range(W):
        read_one(s, y, new, work.links, work.masses, size, i)
    for row in range(2 * levels):
        for i in range(W):
            y[row, i] = new[row, i]
    for i in range(W):
        s[r.AT, i] = s[r.NEXT, i]
