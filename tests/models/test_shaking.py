"""What a motion of the base keeps for the runs under it."""

from __future__ import annotations

import numpy as np

from models.shaking import KEPT, Shaking


def test_a_result_is_made_once_and_the_oldest_is_forgotten() -> None:
    shaking = Shaking(0.01, np.zeros(5))
    made: list[int] = []

    def make(k: int) -> int:
        made.append(k)
        return k

    for k in (*range(KEPT), *range(KEPT)):
        assert shaking.once(("record", k), lambda k=k: make(k)) == k
    assert made == list(range(KEPT))
    shaking.once(("record", KEPT), lambda: make(KEPT))
    shaking.once(("record", 0), lambda: make(0))  # it had been the oldest
    assert made == [*range(KEPT), KEPT, 0]
    assert Shaking(0.01, np.zeros(5)).once(("record", 0), lambda: 7) == 7
