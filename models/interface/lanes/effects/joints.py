"""What the layers of lanes with effects carry at the predictor: forces, moments and their slopes, for all lanes.

The base is two exact strips, one under each half, where the halves differ, are bonded, worn or frozen; what is bonded
still adds the difference between the linear law and the strip on its stretch.
"""

from __future__ import annotations

from models.interface.lanes import rows as r
from models.interface.lanes.effects import rows as e
from models.interface.lanes.effects.rows import More
from models.interface.lanes.strip import TINY, resultants, slopes
from models.lanes.arrays import Table
from models.lanes.compiler import called, inlined
from models.lanes.elementary import exponential_decay

Sums = tuple[float, float, float, float, float, float]


@inlined
def piece(
    middle: float, half: float, clip: float, motion: tuple[float, float, float, float], k: float, c: float, stiff: float
) -> Sums:
    """Of the strip of half width ``half`` about x = ``middle``; motion: z, z', S, S'. See `resultants`."""
    z, z_rate, s, s_rate = motion
    z, z_rate = z - middle * s, z_rate - middle * s_rate
    slope, steep, lean = slopes(k, c, s, s_rate)
    n, m, d1, d2, d3, length = resultants(
        half, clip, z, k * z + c * z_rate, s, slope, steep, lean, 1.0 / (lean * steep), stiff
    )
    return about(middle, n, m, d1, d2, d3, length)


@inlined
def whole(
    middle: float, half: float, motion: tuple[float, float, float, float], k: float, c: float, stiff: float
) -> Sums:
    """The same of a stretch that all carries, pressed or pulled."""
    z, z_rate, s, s_rate = motion
    length = 2.0 * half
    own = length * length * length * (1.0 / 12.0)
    force = -length * (k * (z - middle * s) + c * (z_rate - middle * s_rate))
    return about(middle, force, own * (k * s + c * s_rate), length * stiff, 0.0, own * stiff, length)


@inlined
def about(middle: float, n: float, m: float, d1: float, d2: float, d3: float, length: float) -> Sums:
    """From sums about a stretch's middle to those about the middle of the joint."""
    return n, m + middle * n, d1, d2 + middle * d1, d3 + middle * (2.0 * d2 + middle * d1), length


@inlined
def plus(one: Sums, share: float, other: Sums) -> Sums:
    """One, and a share of the other; the length is that of the first."""
    return (
        one[0] + share * other[0], one[1] + share * other[1], one[2] + share * other[2], one[3] + share * other[3],
        one[4] + share * other[4], one[5],
    )  # fmt: skip


@inlined
def keep(joint: Table, which: int, i: int, found: Sums) -> None:
    joint[e.N_B + which, i], joint[e.M_B + which, i] = found[0], found[1]
    joint[e.D1_B + which, i], joint[e.D2_B + which, i], joint[e.D3_B + which, i] = found[2], found[3], found[4]
    joint[e.LENGTH_B + which, i] = found[5]


@inlined
def frozen_share(opening: float, per_opening: float) -> float:
    """Share of the half that lifts; see `models.interface.stored.frozen_share`."""
    by = min(max(opening * per_opening, 0.0), 1.0)
    return 1.0 - by * by * (3.0 - 2.0 * by)


@inlined
def tears(own: Table, i: int, b: float, z: float, s: float) -> tuple[float, float]:
    """Ends of what is bonded still at z, S."""
    front = (z - own[e.TEARING, i]) / (s + TINY if s >= 0.0 else s - TINY)
    left, right = own[e.TORN_LEFT, i], own[e.TORN_RIGHT, i]
    left = max(left, min(front, b)) if s > 0.0 else left
    return left, min(right, max(front, -b)) if s < 0.0 else right


@called
def base_by_halves(w: Table, m: More) -> None:
    own, joint, lanes = m.own, m.joint, m.q.shape[1]
    for i in range(lanes):
        c, clip, s = w[r.CB, i], w[r.CLIP, i], joint[e.S1, i]
        near, far, half = w[r.NEAR, i], w[r.FAR, i], 0.5 * w[r.B1, i]
        wear = 1.0 - own[e.LOSS, i] * (1.0 - exponential_decay(own[e.CLOSINGS, i] * own[e.PER_CLOSING, i]))
        w[r.FACTOR_L, i], w[r.FACTOR_R, i] = wear * own[e.LEFT, i], wear * own[e.RIGHT, i]
        left, right = w[r.KB, i] * w[r.FACTOR_L, i], w[r.KB, i] * w[r.FACTOR_R, i]
        motion = (m.q[2, i], m.v[2, i], s, joint[e.C1, i] * m.v[0, i])
        one = piece(-half, half, clip, motion, left, c, far * c + near * left)
        other = piece(half, half, clip, motion, right, c, far * c + near * right)
        keep(joint, 0, i, plus((*one[:5], one[5] + other[5]), 1.0, other))


@called
def bonds(w: Table, m: More) -> None:
    """What is bonded still, on either half."""
    own, joint, lanes = m.own, m.joint, m.q.shape[1]
    for i in range(lanes):
        b, c, clip, s = w[r.B1, i], w[r.CB, i], w[r.CLIP, i], joint[e.S1, i]
        motion = (m.q[2, i], m.v[2, i], s, joint[e.C1, i] * m.v[0, i])
        ends = tears(own, i, b, m.q[2, i], s)
        found = sums(joint, i)
        for side in range(2):
            k = w[r.KB, i] * w[r.FACTOR_L + side, i]
            stiff = w[r.FAR, i] * c + w[r.NEAR, i] * k
            low, high = (side - 1.0) * b, side * b
            first, last = min(max(ends[0], low), high), min(max(ends[1], low), high)
            half, middle = 0.5 * max(last - first, 0.0), 0.5 * (first + last)
            found = plus(found, 1.0, whole(middle, half, motion, k, c, stiff))
            found = plus(found, -1.0, piece(middle, half, clip, motion, k, c, stiff))
        keep(joint, 0, i, found)


@inlined
def sums(joint: Table, i: int) -> Sums:
    return (
        joint[e.N_B, i], joint[e.M_B, i], joint[e.D1_B, i], joint[e.D2_B, i], joint[e.D3_B, i], joint[e.LENGTH_B, i],
    )  # fmt: skip


@called
def top_strip(w: Table, m: More) -> None:
    joint, lanes = m.joint, m.q.shape[1]
    for i in range(lanes):
        k, c = w[r.KT, i], w[r.CT, i]
        motion = (m.q[3, i], m.v[3, i], joint[e.SR, i], joint[e.CR, i] * (m.v[1, i] - m.v[6, i]))
        found = piece(0.0, w[r.BT, i], w[r.CLIP, i], motion, k, c, w[r.FAR, i] * c + w[r.NEAR, i] * k)
        keep(joint, 1, i, found)


@called
def base_strip(w: Table, m: More) -> None:
    joint, lanes = m.joint, m.q.shape[1]
    for i in range(lanes):
        k, c = w[r.KB, i], w[r.CB, i]
        motion = (m.q[2, i], m.v[2, i], joint[e.S1, i], joint[e.C1, i] * m.v[0, i])
        found = piece(0.0, w[r.B1, i], w[r.CLIP, i], motion, k, c, w[r.FAR, i] * c + w[r.NEAR, i] * k)
        keep(joint, 0, i, found)


@called
def add_laws(w: Table, m: More) -> None:
    """What the fibres add."""
    joint, lanes = m.joint, m.q.shape[1]
    for which in range(2):
        for i in range(lanes):
            near = w[r.NEAR, i]
            joint[e.N_B + which, i] += w[r.FN_B + which, i]
            joint[e.M_B + which, i] += w[r.FM_B + which, i]
            joint[e.D1_B + which, i] += near * w[r.F1_B + which, i]
            joint[e.D2_B + which, i] += near * w[r.F2_B + which, i]
            joint[e.D3_B + which, i] += near * w[r.F3_B + which, i]


@called
def freeze(w: Table, m: More) -> None:
    """Mix the forces with those of contacts frozen at half."""
    own, joint, lanes = m.own, m.joint, m.q.shape[1]
    for which in range(2):
        for i in range(lanes):
            b, c, s = w[r.B1 + which, i], w[r.CB + which, i], joint[e.S1 if which == 0 else e.SR, i]
            rate = joint[e.C1, i] * m.v[0, i] if which == 0 else joint[e.CR, i] * (m.v[1, i] - m.v[6, i])
            motion = (m.q[2 + which, i], m.v[2 + which, i], s, rate)
            share = frozen_share(motion[0] + b * abs(s), own[e.PER_OPENING_B + which, i])
            phi = own[e.FROZEN_B + which, i]
            for row in (e.N_B, e.M_B, e.D1_B, e.D2_B, e.D3_B):
                joint[row + which, i] *= 1.0 - phi
            for side in range(2):
                k = w[r.KB + which, i] * (w[r.FACTOR_L + side, i] if which == 0 else 1.0)
                stiff = w[r.FAR, i] * c + w[r.NEAR, i] * k
                half = whole((side - 0.5) * b, 0.5 * b, motion, k, c, stiff)
                part = phi * (1.0 if (s >= 0.0) == (side == 1) else share)
                joint[e.N_B + which, i] += part * half[0]
                joint[e.M_B + which, i] += part * half[1]
                joint[e.D1_B + which, i] += part * half[2]
                joint[e.D2_B + which, i] += part * half[3]
                joint[e.D3_B + which, i] += part * half[4]
