"""Right hand side, matrix and solution of the step's equations for all lanes: L D L^T, entry by entry."""

from __future__ import annotations

from models.interface.lanes import rows as r
from models.interface.lanes.effects import rows as e
from models.interface.lanes.effects.rows import More
from models.lanes.arrays import Table
from models.lanes.compiler import called


@called
def inertia(m: More, share: float) -> None:
    """Forces of inertia with q'' = o, and ``share`` times the mass matrix, below its diagonal."""
    shape, pull, weight, lanes = m.shape, m.pull, m.weight, m.q.shape[1]
    for row in range(9):
        for j in range(m.size):
            for i in range(lanes):
                pull[row, i] += shape[row, j, i] * m.o[j, i]
        for i in range(lanes):
            pull[row, i] *= weight[row, i]
    for j in range(m.size):
        for i in range(lanes):
            total = 0.0
            for row in range(9):
                total -= shape[row, j, i] * pull[row, i]
            m.f[j, i] = total
        for k in range(j + 1):
            for i in range(lanes):
                total = 0.0
                for row in range(9):
                    total += weight[row, i] * shape[row, j, i] * shape[row, k, i]
                m.matrix[j, k, i] = share * total


@called
def forces(w: Table, m: More) -> None:
    """Add those of layers, couples and the wall's bending, and their slopes."""
    own, joint, f, a, lanes = m.own, m.joint, m.f, m.matrix, m.q.shape[1]
    for i in range(lanes):
        near, far = w[r.NEAR, i], w[r.FAR, i]
        free_b, free_t, free_m = w[r.FREE_B, i], w[r.FREE_T, i], own[e.FREE_M, i]
        stiff = (1.0 - free_m) * free_b
        c1, cr = joint[e.C1, i] * free_b, joint[e.CR, i] * free_t
        # the top joint's angle over theta1 and theta2; over thetam where the wall bends
        ct, cm = -cr * stiff, -cr * free_m
        over = max(abs(m.q[0, i]) - own[e.COUPLE_GAP, i], 0.0)
        spring, dashpot = own[e.COUPLE_K, i], own[e.COUPLE_C, i]
        couple = dashpot * m.v[0, i] + (spring * over if m.q[0, i] >= 0.0 else -spring * over)
        mb, mt, d3 = joint[e.M_B, i], joint[e.M_T, i], joint[e.D3_T, i]
        f[0, i] -= mb * c1 + mt * ct + free_b * couple
        f[1, i] -= mt * cr
        f[2, i] += free_b * joint[e.N_B, i]
        f[3, i] += free_t * joint[e.N_T, i]
        a[0, 0, i] += joint[e.D3_B, i] * c1 * c1 + d3 * ct * ct + (near * spring if over > 0.0 else 0.0)
        a[0, 0, i] += far * dashpot + 1.0 - free_b
        a[1, 0, i] += d3 * cr * ct
        a[1, 1, i] += d3 * cr * cr + 1.0 - free_t
        a[2, 0, i] -= joint[e.D2_B, i] * c1
        a[2, 2, i] += joint[e.D1_B, i] * free_b + 1.0 - free_b
        a[3, 0, i] -= joint[e.D2_T, i] * ct
        a[3, 1, i] -= joint[e.D2_T, i] * cr
        a[3, 3, i] += joint[e.D1_T, i] * free_t + 1.0 - free_t
        if m.size > 4:
            for which in range(2):
                free = own[e.FREE_X1 + which, i]
                along = own[e.SHEAR_B + which, i] * joint[e.LENGTH_B + which, i]
                k, c = along * w[r.KB + which, i], along * w[r.CB + which, i]
                f[4 + which, i] -= free * (k * m.q[4 + which, i] + c * m.v[4 + which, i])
                a[4 + which, 4 + which, i] += free * (near * k + far * c) + 1.0 - free
        if m.size > 6:
            bend, axial = own[e.BEND, i], own[e.AXIAL, i]
            bent = bend * (m.q[6, i] - m.q[0, i])
            f[0, i] += free_b * bent
            f[6, i] -= free_m * (bent + mt * -joint[e.CR, i] * free_t)
            f[7, i] -= free_m * axial * m.q[7, i]
            a[0, 0, i] += near * bend * free_b
            a[6, 0, i] += d3 * ct * cm - near * bend * free_b
            a[6, 1, i] += d3 * cr * cm
            a[6, 3, i] -= joint[e.D2_T, i] * cm
            a[6, 6, i] += d3 * cm * cm + near * bend + 1.0 - free_m
            a[7, 7, i] += near * axial + 1.0 - free_m


@called
def factor(m: More) -> None:
    """M = L D L^T: L below the diagonal, L D above it, 1/D on it."""
    a, lanes = m.matrix, m.q.shape[1]
    for j in range(m.size):
        for k in range(j):
            for p in range(k):
                for i in range(lanes):
                    a[j, k, i] -= a[p, j, i] * a[k, p, i]
            for i in range(lanes):
                a[k, j, i] = a[j, k, i]
        for k in range(j):
            for i in range(lanes):
                a[j, k, i] = a[k, j, i] * a[k, k, i]
                a[j, j, i] -= a[k, j, i] * a[j, k, i]
        for i in range(lanes):
            a[j, j, i] = 1.0 / a[j, j, i]


@called
def solve(m: More, f: Table, d: Table) -> None:
    """d = M^-1 f, both (8, W)."""
    a, lanes = m.matrix, m.q.shape[1]
    for j in range(m.size):
        for i in range(lanes):
            d[j, i] = f[j, i]
        for p in range(j):
            for i in range(lanes):
                d[j, i] -= a[j, p, i] * d[p, i]
    for back in range(m.size):
        j = m.size - 1 - back
        for i in range(lanes):
            d[j, i] *= a[j, j, i]
        for p in range(j + 1, m.size):
            for i in range(lanes):
                d[j, i] -= a[p, j, i] * d[p, i]
