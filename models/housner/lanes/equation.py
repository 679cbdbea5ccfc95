"""The equation of motion and one Runge-Kutta step of one lane; inlined into the loop over lanes.

Each function takes ``general`` and ``linear`` as None or True: a compiled variant holds only the
branch in use. A ``general`` of 1 knows a law in a table too.
With x = (h cos + s b sin) M/I_O and z = (s b cos - h sin) M/I_O

    plain    theta'' = -(G z + a x)
    linear   the same with x = h M/I_O and z = (s b - h theta) M/I_O
    general  J theta'' = -(a - G psi) X - G f Z - rho Z theta'^2 - couples/M - (I/M + h^2) psi''

where, for a corner of radius rho, X = rho + s (b-rho) sin + (h-rho) cos,
Z = s (b-rho) cos - (h-rho) sin, J = I/M + X^2 + Z^2 and f = 1 - exp(-|theta|/joint angle).
"""

from __future__ import annotations

from typing import Any

from models.housner.lanes import rows as r
from models.housner.lanes.table import table_acceleration
from models.lanes.arrays import Table
from models.lanes.compiler import inlined
from models.lanes.elementary import exponential_decay, sine_cosine

MOST_INSET = 0.35


@inlined
def present_half_width(w: Table, lane: int, theta: float) -> float:
    """b after crushing: inset = min(.35, rate times the largest rotation so far)."""
    largest = max(w[r.PEAK, lane], abs(theta))
    return float(w[r.B, lane] * (1.0 - min(MOST_INSET, w[r.CRUSH, lane] * largest)))


@inlined
def acceleration(
    w: Table, lane: int, theta: float, omega: float, a: float, g: float, psi: float, psi2: float,
    general: Any, linear: Any,
) -> tuple[float, float, float, float]:  # fmt: skip
    """theta'', and for the reactions: X_theta, Z_theta (m), and the power lost in couples over M."""
    if general is not None:
        s = w[r.SIDE, lane]
        rho = w[r.RHO, lane]
        half = present_half_width(w, lane, theta)
        height = w[r.H, lane]
        sine, cosine = sine_cosine(theta)
        bp = s * (half - rho)
        hp = height - rho
        x = rho + bp * sine + hp * cosine
        z = bp * cosine - hp * sine
        inertia = w[r.IM, lane]
        jm = inertia + x * x + z * z
        corner = inertia + height * height + half * half
        size = abs(theta)
        joint = w[r.JOINT, lane]
        share = 1.0 - exponential_decay(size * max(joint, 0.0))
        share = share if joint >= 0.0 else 1.0
        couple = w[r.K, lane] * max(size - w[r.GAP, lane], 0.0) * s
        damping = (
            corner * (w[r.VISCOUS, lane] * omega + w[r.QUADRATIC, lane] * omega * abs(omega))
            + w[r.COULOMB, lane] * w[r.DIRECTION, lane]
            - corner * table_acceleration(w, r.TABLE, lane, theta, omega, a, s, w[r.DIRECTION, lane], general)
        )
        # rounding must not tell the general equation at its nulls from the plain one by more than an ulp or two
        moment = (a - g * psi) * x + g * share * z + rho * z * omega * omega
        return (
            -(moment + couple + damping + (inertia + height * height) * psi2) / jm,
            x,
            z,
            damping * omega,
        )
    cb = w[r.CB, lane]
    ch = w[r.CH, lane]
    size = w[r.LAMBDA, lane]
    if linear is not None:
        z = cb - ch * theta
        return -(g * z + a * ch), size * ch, size * z, 0.0
    sine, cosine = sine_cosine(theta)
    x = ch * cosine + cb * sine
    z = cb * cosine - ch * sine
    return -(g * z + a * x), size * x, size * z, 0.0


@inlined
def friction_demand(
    w: Table, lane: int, accel: float, omega: float, x: float, z: float, a: float, g: float, general: Any
) -> float:
    """|H|/N at the pivot (inf for N <= 0), from H/M = a + X'' and N/M = G + Z''."""
    square = omega * omega
    across = a + x * accel + z * square
    if general is not None:
        rho = w[r.RHO, lane]
        up = g + z * accel - (x - rho) * square
    else:
        up = g + z * accel - x * square
    ratio = abs(across) / up
    return ratio if up > 0.0 else 1e300


@inlined
def rk4(
    w: Table, lane: int, theta: float, omega: float, step: float,
    a0: float, a1: float, g0: float, g1: float, p0: float, p1: float, q0: float, q1: float,
    general: Any, linear: Any,
) -> tuple[float, float, float, float]:  # fmt: skip
    """theta and theta' after ``step``, the friction demand at its start, the work in couples over M.

    Inputs are linear over the step: base acceleration a, apparent gravity g, pitch p and its second
    derivative q.
    """
    half = 0.5 * step
    am, gm, pm, qm = 0.5 * (a0 + a1), 0.5 * (g0 + g1), 0.5 * (p0 + p1), 0.5 * (q0 + q1)
    k1, x1, z1, e1 = acceleration(w, lane, theta, omega, a0, g0, p0, q0, general, linear)
    base = a0
    if general is not None:
        base = a0 - g0 * p0 + w[r.H, lane] * q0
    demand = friction_demand(w, lane, k1, omega, x1, z1, base, g0, general)
    o2 = omega + half * k1
    k2, _, _, e2 = acceleration(w, lane, theta + half * omega, o2, am, gm, pm, qm, general, linear)
    o3 = omega + half * k2
    k3, _, _, e3 = acceleration(w, lane, theta + half * o2, o3, am, gm, pm, qm, general, linear)
    o4 = omega + step * k3
    k4, _, _, e4 = acceleration(w, lane, theta + step * o3, o4, a1, g1, p1, q1, general, linear)
    sixth = step * (1.0 / 6.0)
    return (
        theta + sixth * (omega + 2.0 * (o2 + o3) + o4),
        omega + sixth * (k1 + 2.0 * (k2 + k3) + k4),
        demand,
        sixth * (e1 + 2.0 * (e2 + e3) + e4),
    )
