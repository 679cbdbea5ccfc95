"""What rubber laws add along one joint: four of its 16 Gauss fibres at a time, for all lanes.

The loop over the W lanes has no branches; joint and fibres are constants of each loop, so that it becomes vector code.
Each law takes all fibres on by itself.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from models.interface.fibres import COUNT, NODES, WEIGHTS
from models.interface.lanes import rows as r
from models.interface.lanes.rows import W
from models.lanes.arrays import Table
from models.lanes.compiler import inlined
from models.rubber import lanes as rubber
from models.rubber.base import RubberLaw

FIRST, SECOND = WEIGHTS * NODES, WEIGHTS * NODES**2

# --- work beyond the rows of `rows`, base and top: u of every fibre at the last step, hidden states, numbers
P_LAWS = tuple((r.N_WORK + joint * rubber.N_NUMBERS) * W for joint in range(2))
APART = COUNT + 1
"""Rows between those of a fibre: not a power of two, at which a store would hold up the load of the next one."""
LAST = tuple((r.N_WORK + 2 * rubber.N_NUMBERS + joint * (1 + rubber.N_HIDDEN) * APART) * W for joint in range(2))
_GOING = r.N_WORK + 2 * rubber.N_NUMBERS + 2 * (1 + rubber.N_HIDDEN) * APART
GOING = _GOING * W
"""What passes from law to law, four rows of every fibre: u, its change, stress beyond k u, slope."""
N_WORK_LAWS = _GOING + 4 * APART
PLACES = [rubber.Places(LAST[joint] + APART * W, APART * W, P_LAWS[joint], W) for joint in range(2)]


@inlined
def _strip(w: Table, joint: int, f0: int, i: int, sided: bool) -> Any:
    """Of a joint of one lane: b S, z, c b S', c z', k, the least stress, and the factor on the springs from f0 on."""
    return (
        w[(r.FS_B + joint) * W + i], w[(r.FZ_B + joint) * W + i], w[(r.FR_B + joint) * W + i],
        w[(r.FY_B + joint) * W + i], w[(r.KB + joint) * W + i], w[r.FLOOR * W + i],
        w[(r.FACTOR_L + (0 if f0 < COUNT // 2 else 1)) * W + i] if sided else 1.0,
    )  # fmt: skip


@inlined
def _beyond(f: int, strip: Any, u: float, more: float, slope: float) -> tuple[float, float]:
    """Stress of one fibre beyond the linear one, both clipped under law B, and its slope."""
    turn, z, turn_drag, drag, k, floor, factor = strip
    linear = factor * k * u + (NODES[f] * turn_drag - drag)
    total = linear + factor * more
    touching = NODES[f] * turn - z > 0.0
    stress = max(total, floor) - max(linear, floor) if touching else 0.0
    return stress, factor * slope if touching & (total > floor) else 0.0


@inlined
def _add(w: Table, joint: int, f0: int, i: int, four: Any) -> None:
    """Add stresses and slopes of the four fibres from f0 on to the sums of a joint of one lane."""
    (s0, d0), (s1, d1), (s2, d2), (s3, d3) = four
    f1, f2, f3 = f0 + 1, f0 + 2, f0 + 3
    w[(r.FN_B + joint) * W + i] += WEIGHTS[f0] * s0 + WEIGHTS[f1] * s1 + WEIGHTS[f2] * s2 + WEIGHTS[f3] * s3
    w[(r.FM_B + joint) * W + i] += FIRST[f0] * s0 + FIRST[f1] * s1 + FIRST[f2] * s2 + FIRST[f3] * s3
    w[(r.F1_B + joint) * W + i] += WEIGHTS[f0] * d0 + WEIGHTS[f1] * d1 + WEIGHTS[f2] * d2 + WEIGHTS[f3] * d3
    w[(r.F2_B + joint) * W + i] += FIRST[f0] * d0 + FIRST[f1] * d1 + FIRST[f2] * d2 + FIRST[f3] * d3
    w[(r.F3_B + joint) * W + i] += SECOND[f0] * d0 + SECOND[f1] * d1 + SECOND[f2] * d2 + SECOND[f3] * d3


def _begin(joint: int) -> Callable[..., None]:
    """Compiled ``(w, f0, i)``: u and its change of four fibres, for the first of the laws."""
    last = LAST[joint]

    @inlined
    def fibre(w: Table, f: int, i: int, turn: float, z: float) -> None:
        u, j = max(NODES[f] * turn - z, 0.0), f * W + i
        w[GOING + j], w[GOING + APART * W + j] = u, u - w[last + j]
        w[GOING + 2 * APART * W + j], w[GOING + 3 * APART * W + j] = 0.0, 0.0
        w[last + j] = u

    @inlined
    def four(w: Table, f0: int, i: int) -> None:
        turn, z = w[(r.FS_B + joint) * W + i], w[(r.FZ_B + joint) * W + i]
        fibre(w, f0, i, turn, z)
        fibre(w, f0 + 1, i, turn, z)
        fibre(w, f0 + 2, i, turn, z)
        fibre(w, f0 + 3, i, turn, z)

    return four


def _pass(law: RubberLaw, joint: int) -> Callable[..., None]:
    """Compiled ``(w, f0, i)``: one law takes four fibres on."""
    numbers, go_on = rubber.passing(law, PLACES[joint], GOING)

    @inlined
    def four(w: Table, f0: int, i: int) -> None:
        k, n, j = w[(r.KB + joint) * W + i], numbers(w, i), f0 * W + i
        go_on(w, j, k, n)
        go_on(w, j + W, k, n)
        go_on(w, j + 2 * W, k, n)
        go_on(w, j + 3 * W, k, n)

    return four


def _end(joint: int, sided: bool) -> Callable[..., None]:
    """Compiled ``(w, f0, i)``: what the laws add to the sums by four fibres."""

    @inlined
    def fibre(w: Table, f: int, i: int, strip: Any) -> tuple[float, float]:
        j = f * W + i
        u = max(NODES[f] * strip[0] - strip[1], 0.0)
        return _beyond(f, strip, u, w[GOING + 2 * APART * W + j], w[GOING + 3 * APART * W + j])

    @inlined
    def four(w: Table, f0: int, i: int) -> None:
        strip = _strip(w, joint, f0, i, sided)
        _add(
            w, joint, f0, i,
            (fibre(w, f0, i, strip), fibre(w, f0 + 1, i, strip), fibre(w, f0 + 2, i, strip),
             fibre(w, f0 + 3, i, strip)),
        )  # fmt: skip

    return four


def _over_all(four: Callable[..., None]) -> Callable[..., None]:
    """Compiled ``(w)``: ``four`` over all fibres of all lanes."""

    @inlined
    def all_fibres(w: Table) -> None:
        # a length that the compiler does not know: else it unrolls the loops instead of making vector code
        lanes = min(W, w.size)
        for f in range(0, COUNT, 4):
            for i in range(lanes):
                four(w, f, i)

    return all_fibres


def _joint(joint: int, sided: bool = False) -> Callable[..., None]:
    """Compiled ``(w, acting)``: the fibres of one joint of all lanes; ``sided``: a factor on the springs of a half.

    ``acting``: which laws, as of `models.rubber.lanes.acting`.
    """
    begin, end = _over_all(_begin(joint)), _over_all(_end(joint, sided))
    passes = rubber.guarded([_over_all(_pass(law, joint)) for law in rubber.ORDER])

    @inlined
    def all_laws(w: Table, acting: int) -> None:
        if acting:
            begin(w)
            passes(w, acting)
            end(w)

    return all_laws


base_fibres, top_fibres = _joint(0), _joint(1)
sided_base_fibres = _joint(0, sided=True)
