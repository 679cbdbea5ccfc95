"""What is read off the state after a step of one lane; inlined into the loop over lanes."""

from __future__ import annotations

from models.interface.lanes import rows as r
from models.lanes.arrays import Table
from models.lanes.compiler import inlined

HALF_TURN = 1.5707963267948966
NEVER = 1e300
TINY = 1e-60


@inlined
def read_joints(
    w: Table, i: int, z1: float, z2: float, s1: float, sr: float, y1: float, y2: float, rb: float, rt: float
) -> bool:
    """Time up, closings, first uplift, edges; False where a lane whose events are logged opens or closes a joint.

    The height by which the freer end is from pressing (`models.interface.reference.watch.uplift`) is taken as
    linear in time over the step.
    """
    late_b, late_t = w[r.LATE_B, i], w[r.LATE_T, i]
    b1, bt = w[r.B1, i], w[r.BT, i]
    lean_b, lean_t = b1 * abs(s1), bt * abs(sr)
    w[r.EDGE_B, i] = max(w[r.EDGE_B, i], lean_b - z1)
    w[r.EDGE_T, i] = max(w[r.EDGE_T, i], lean_t - z2)
    now_b = z1 + max(lean_b, late_b * y1 + b1 * abs(s1 + late_b * rb))
    now_t = z2 + max(lean_t, late_t * y2 + bt * abs(sr + late_t * rt))
    was_b, was_t = w[r.LIFT_B, i], w[r.LIFT_T, i]
    w[r.LIFT_B, i], w[r.LIFT_T, i] = now_b, now_t
    size_b, size_t = abs(now_b) + abs(was_b) + TINY, abs(now_t) + abs(was_t) + TINY
    inverse = 1.0 / (size_b * size_t)
    part_b = (max(now_b, 0.0) + max(was_b, 0.0)) * (inverse * size_t)
    part_t = (max(now_t, 0.0) + max(was_t, 0.0)) * (inverse * size_b)
    w[r.UP_B, i] += part_b
    w[r.UP_T, i] += part_t
    clock = w[r.CLOCK, i]
    w[r.CLOCK, i] = clock + 1.0
    up_b, up_t = now_b > 0.0, now_t > 0.0
    were_b, were_t = was_b > 0.0, was_t > 0.0
    first_b, first_t = clock + 1.0 - part_b, clock + 1.0 - part_t
    w[r.ONSET_B, i] = min(w[r.ONSET_B, i], first_b if up_b & (not were_b) else NEVER)
    w[r.ONSET_T, i] = min(w[r.ONSET_T, i], first_t if up_t & (not were_t) else NEVER)
    w[r.CLOSED_B, i] += 1.0 if were_b & (not up_b) else 0.0
    w[r.CLOSED_T, i] += 1.0 if were_t & (not up_t) else 0.0
    return bool((w[r.LOGGED, i] == 0.0) | ((were_b == up_b) & (were_t == up_t)))


@inlined
def read_bodies(w: Table, i: int, t1: float, t2: float, kinetic: float) -> bool:
    """Peaks of rotation and of the kinetic energy (any multiple of it); whether both bodies stand."""
    w[r.WINDOW, i] = max(w[r.WINDOW, i], kinetic)
    size_1, size_2 = abs(t1), abs(t2)
    w[r.PEAK_1, i] = max(w[r.PEAK_1, i], size_1)
    w[r.PEAK_2, i] = max(w[r.PEAK_2, i], size_2)
    return (size_1 < HALF_TURN) & (size_2 < HALF_TURN)


@inlined
def account_joints(
    w: Table, i: int, px: float, pz: float, ux: float, uz: float, power_b: float, power_t: float
) -> None:
    """Worst friction demand of both joints, without a division, and the work of the strips (over h/2)."""
    along, across = abs(ux), max(uz, 0.0)
    worse = along * w[r.ACROSS_T, i] > w[r.ALONG_T, i] * across
    w[r.ALONG_T, i] = along if worse else w[r.ALONG_T, i]
    w[r.ACROSS_T, i] = across if worse else w[r.ACROSS_T, i]
    along, across = abs(px), max(pz, 0.0)
    worse = along * w[r.ACROSS_B, i] > w[r.ALONG_B, i] * across
    w[r.ALONG_B, i] = along if worse else w[r.ALONG_B, i]
    w[r.ACROSS_B, i] = across if worse else w[r.ACROSS_B, i]
    w[r.WORK_B, i] += w[r.POWER_B, i] + power_b
    w[r.WORK_T, i] += w[r.POWER_T, i] + power_t
    w[r.POWER_B, i], w[r.POWER_T, i] = power_b, power_t
