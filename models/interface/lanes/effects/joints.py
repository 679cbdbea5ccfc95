"""What the layers of lanes with effects carry at the predictor: forces, moments and their slopes, for all lanes.

The base is two exact strips, one under each half, where the halves differ, are bonded, worn or frozen; what is bonded
still adds the difference between the linear law and the strip on its stretch.
"""

from __future__ import annotations

from models.interface.lanes import rows as r
from models.interface.lanes.effects import rows as e
from models.interface.lanes.rows import W
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
def keep(t: Table, which: int, i: int, found: Sums) -> None:
    t[e.N_B + which * W + i], t[e.M_B + which * W + i] = found[0], found[1]
    t[e.D1_B + which * W + i], t[e.D2_B + which * W + i], t[e.D3_B + which * W + i] = found[2], found[3], found[4]
    t[e.LENGTH_B + which * W + i] = found[5]


@inlined
def frozen_share(opening: float, per_opening: float) -> float:
    """Share of the half that lifts; see `models.interface.stored.frozen_share`."""
    by = min(max(opening * per_opening, 0.0), 1.0)
    return 1.0 - by * by * (3.0 - 2.0 * by)


@inlined
def tears(t: Table, i: int, b: float, z: float, s: float) -> tuple[float, float]:
    """Ends of what is bonded still at z, S."""
    front = (z - t[e.TEARING + i]) / (s + TINY if s >= 0.0 else s - TINY)
    left, right = t[e.TORN_LEFT + i], t[e.TORN_RIGHT + i]
    left = max(left, min(front, b)) if s > 0.0 else left
    return left, min(right, max(front, -b)) if s < 0.0 else right


@called
def base_by_halves(t: Table) -> None:
    lanes = min(W, t.size)
    for i in range(lanes):
        c, clip, s = t[r.CB * W + i], t[r.CLIP * W + i], t[e.S1 + i]
        near, far, half = t[r.NEAR * W + i], t[r.FAR * W + i], 0.5 * t[r.B1 * W + i]
        wear = 1.0 - t[e.LOSS + i] * (1.0 - exponential_decay(t[e.CLOSINGS + i] * t[e.PER_CLOSING + i]))
        t[r.FACTOR_L * W + i], t[r.FACTOR_R * W + i] = wear * t[e.LEFT + i], wear * t[e.RIGHT + i]
        left, right = t[r.KB * W + i] * t[r.FACTOR_L * W + i], t[r.KB * W + i] * t[r.FACTOR_R * W + i]
        motion = (t[e.Q + 2 * W + i], t[e.V + 2 * W + i], s, t[e.C1 + i] * t[e.V + i])
        one = piece(-half, half, clip, motion, left, c, far * c + near * left)
        other = piece(half, half, clip, motion, right, c, far * c + near * right)
        keep(t, 0, i, plus((*one[:5], one[5] + other[5]), 1.0, other))


@called
def bonds(t: Table) -> None:
    """What is bonded still, on either half."""
    lanes = min(W, t.size)
    for i in range(lanes):
        b, c, clip, s = t[r.B1 * W + i], t[r.CB * W + i], t[r.CLIP * W + i], t[e.S1 + i]
        motion = (t[e.Q + 2 * W + i], t[e.V + 2 * W + i], s, t[e.C1 + i] * t[e.V + i])
        ends = tears(t, i, b, t[e.Q + 2 * W + i], s)
        found = sums(t, i)
        for side in range(2):
            k = t[r.KB * W + i] * t[(r.FACTOR_L + side) * W + i]
            stiff = t[r.FAR * W + i] * c + t[r.NEAR * W + i] * k
            low, high = (side - 1.0) * b, side * b
            first, last = min(max(ends[0], low), high), min(max(ends[1], low), high)
            half, middle = 0.5 * max(last - first, 0.0), 0.5 * (first + last)
            found = plus(found, 1.0, whole(middle, half, motion, k, c, stiff))
            found = plus(found, -1.0, piece(middle, half, clip, motion, k, c, stiff))
        keep(t, 0, i, found)


@inlined
def sums(t: Table, i: int) -> Sums:
    return (
        t[e.N_B + i], t[e.M_B + i], t[e.D1_B + i], t[e.D2_B + i], t[e.D3_B + i], t[e.LENGTH_B + i],
    )  # fmt: skip


@called
def top_strip(t: Table) -> None:
    lanes = min(W, t.size)
    for i in range(lanes):
        k, c = t[r.KT * W + i], t[r.CT * W + i]
        motion = (
            t[e.Q + 3 * W + i],
            t[e.V + 3 * W + i],
            t[e.SR + i],
            t[e.CR + i] * (t[e.V + W + i] - t[e.V + 6 * W + i]),
        )
        found = piece(
            0.0, t[r.BT * W + i], t[r.CLIP * W + i], motion, k, c, t[r.FAR * W + i] * c + t[r.NEAR * W + i] * k
        )
        keep(t, 1, i, found)


@called
def base_strip(t: Table) -> None:
    lanes = min(W, t.size)
    for i in range(lanes):
        k, c = t[r.KB * W + i], t[r.CB * W + i]
        motion = (t[e.Q + 2 * W + i], t[e.V + 2 * W + i], t[e.S1 + i], t[e.C1 + i] * t[e.V + i])
        found = piece(
            0.0, t[r.B1 * W + i], t[r.CLIP * W + i], motion, k, c, t[r.FAR * W + i] * c + t[r.NEAR * W + i] * k
        )
        keep(t, 0, i, found)


@called
def add_laws(t: Table) -> None:
    """What the fibres add."""
    lanes = min(W, t.size)
    for which in range(2):
        for i in range(lanes):
            near = t[r.NEAR * W + i]
            t[e.N_B + which * W + i] += t[(r.FN_B + which) * W + i]
            t[e.M_B + which * W + i] += t[(r.FM_B + which) * W + i]
            t[e.D1_B + which * W + i] += near * t[(r.F1_B + which) * W + i]
            t[e.D2_B + which * W + i] += near * t[(r.F2_B + which) * W + i]
            t[e.D3_B + which * W + i] += near * t[(r.F3_B + which) * W + i]


@called
def freeze(t: Table) -> None:
    """Mix the forces with those of contacts frozen at half."""
    lanes = min(W, t.size)
    for which in range(2):
        for i in range(lanes):
            b, c, s = t[(r.B1 + which) * W + i], t[(r.CB + which) * W + i], t[(e.S1 if which == 0 else e.SR) + i]
            rate = t[e.C1 + i] * t[e.V + i] if which == 0 else t[e.CR + i] * (t[e.V + W + i] - t[e.V + 6 * W + i])
            motion = (t[e.Q + (2 + which) * W + i], t[e.V + (2 + which) * W + i], s, rate)
            share = frozen_share(motion[0] + b * abs(s), t[e.PER_OPENING_B + which * W + i])
            phi = t[e.FROZEN_B + which * W + i]
            for row in (e.N_B, e.M_B, e.D1_B, e.D2_B, e.D3_B):
                t[row + which * W + i] *= 1.0 - phi
            for side in range(2):
                k = t[(r.KB + which) * W + i] * (t[(r.FACTOR_L + side) * W + i] if which == 0 else 1.0)
                stiff = t[r.FAR * W + i] * c + t[r.NEAR * W + i] * k
                half = whole((side - 0.5) * b, 0.5 * b, motion, k, c, stiff)
                part = phi * (1.0 if (s >= 0.0) == (side == 1) else share)
                t[e.N_B + which * W + i] += part * half[0]
                t[e.M_B + which * W + i] += part * half[1]
                t[e.D1_B + which * W + i] += part * half[2]
                t[e.D2_B + which * W + i] += part * half[3]
                t[e.D3_B + which * W + i] += part * half[4]
