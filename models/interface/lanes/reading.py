"""What is read off the state after a step of one lane, in the flat table; inlined into the loop over lanes."""

from __future__ import annotations

from models.interface.lanes import rows as r
from models.interface.lanes.rows import W
from models.lanes.arrays import Table
from models.lanes.compiler import inlined

HALF_TURN = 1.5707963267948966
NEVER = 1e300
TINY = 1e-60


@inlined
def read_joints(
    t: Table, i: int, z1: float, z2: float, s1: float, sr: float, y1: float, y2: float, rb: float, rt: float
) -> bool:
    """Time up, closings, first uplift, edges; False where a lane whose events are logged opens or closes a joint.

    The height by which the freer end is from pressing (`models.interface.reference.watch.uplift`) is taken as
    linear in time over the step.
    """
    late_b, late_t = t[r.LATE_B * W + i], t[r.LATE_T * W + i]
    b1, bt = t[r.B1 * W + i], t[r.BT * W + i]
    lean_b, lean_t = b1 * abs(s1), bt * abs(sr)
    t[r.EDGE_B * W + i] = max(t[r.EDGE_B * W + i], lean_b - z1)
    t[r.EDGE_T * W + i] = max(t[r.EDGE_T * W + i], lean_t - z2)
    now_b = z1 + max(lean_b, late_b * y1 + b1 * abs(s1 + late_b * rb))
    now_t = z2 + max(lean_t, late_t * y2 + bt * abs(sr + late_t * rt))
    was_b, was_t = t[r.LIFT_B * W + i], t[r.LIFT_T * W + i]
    t[r.LIFT_B * W + i], t[r.LIFT_T * W + i] = now_b, now_t
    size_b, size_t = abs(now_b) + abs(was_b) + TINY, abs(now_t) + abs(was_t) + TINY
    inverse = 1.0 / (size_b * size_t)
    part_b = (max(now_b, 0.0) + max(was_b, 0.0)) * (inverse * size_t)
    part_t = (max(now_t, 0.0) + max(was_t, 0.0)) * (inverse * size_b)
    t[r.UP_B * W + i] += part_b
    t[r.UP_T * W + i] += part_t
    clock = t[r.CLOCK * W + i]
    t[r.CLOCK * W + i] = clock + 1.0
    up_b, up_t = now_b > 0.0, now_t > 0.0
    were_b, were_t = was_b > 0.0, was_t > 0.0
    first_b, first_t = clock + 1.0 - part_b, clock + 1.0 - part_t
    t[r.ONSET_B * W + i] = min(t[r.ONSET_B * W + i], first_b if up_b & (not were_b) else NEVER)
    t[r.ONSET_T * W + i] = min(t[r.ONSET_T * W + i], first_t if up_t & (not were_t) else NEVER)
    t[r.CLOSED_B * W + i] += 1.0 if were_b & (not up_b) else 0.0
    t[r.CLOSED_T * W + i] += 1.0 if were_t & (not up_t) else 0.0
    return bool((t[r.LOGGED * W + i] == 0.0) | ((were_b == up_b) & (were_t == up_t)))


@inlined
def read_bodies(t: Table, i: int, t1: float, t2: float, kinetic: float) -> bool:
    """Peaks of rotation and of the kinetic energy (any multiple of it); whether both bodies stand."""
    t[r.WINDOW * W + i] = max(t[r.WINDOW * W + i], kinetic)
    size_1, size_2 = abs(t1), abs(t2)
    t[r.PEAK_1 * W + i] = max(t[r.PEAK_1 * W + i], size_1)
    t[r.PEAK_2 * W + i] = max(t[r.PEAK_2 * W + i], size_2)
    return (size_1 < HALF_TURN) & (size_2 < HALF_TURN)


@inlined
def account_joints(
    t: Table, i: int, px: float, pz: float, ux: float, uz: float, power_b: float, power_t: float
) -> None:
    """Worst friction demand of both joints, without a division, and the work of the strips (over h/2)."""
    along, across = abs(ux), max(uz, 0.0)
    worse = along * t[r.ACROSS_T * W + i] > t[r.ALONG_T * W + i] * across
    t[r.ALONG_T * W + i] = along if worse else t[r.ALONG_T * W + i]
    t[r.ACROSS_T * W + i] = across if worse else t[r.ACROSS_T * W + i]
    along, across = abs(px), max(pz, 0.0)
    worse = along * t[r.ACROSS_B * W + i] > t[r.ALONG_B * W + i] * across
    t[r.ALONG_B * W + i] = along if worse else t[r.ALONG_B * W + i]
    t[r.ACROSS_B * W + i] = across if worse else t[r.ACROSS_B * W + i]
    t[r.WORK_B * W + i] += t[r.POWER_B * W + i] + power_b
    t[r.WORK_T * W + i] += t[r.POWER_T * W + i] + power_t
    t[r.POWER_B * W + i], t[r.POWER_T * W + i] = power_b, power_t
