"""The nine configurations of two stacked blocks, and a state in one of them.

s1 = 1 or -1: the wall is up and turns about its right or left corner; 0: the base joint is closed
(theta_1 = 0). s2 likewise for block 2 on the wall (0: theta_2 = theta_1).
Patterns (Psycharis 1990): 1 both rock to one side, 2 both rock to opposite sides, 3 as one body,
4 only the upper block; each has two signs. And rest.
"""

from __future__ import annotations

from typing import NamedTuple

CONFIGURATIONS: tuple[tuple[int, int], ...] = (
    (1, 1), (-1, -1), (1, -1), (-1, 1), (1, 0), (-1, 0), (0, 1), (0, -1), (0, 0),
)  # fmt: skip
NAMES = (
    "pattern_1_right", "pattern_1_left", "pattern_2_right", "pattern_2_left", "pattern_3_right",
    "pattern_3_left", "pattern_4_right", "pattern_4_left", "rest",
)  # fmt: skip
"""right: the lowest joint that is up turns about its right corner (clockwise)."""
BASE, TOP = JOINTS = (0, 1)


def index(s1: int, s2: int) -> int:
    """Where (s1, s2) stands in `CONFIGURATIONS`; also its bit in the mask of visited ones."""
    return CONFIGURATIONS.index((s1, s2))


class State(NamedTuple):
    """A configuration (``sides``: s1, s2), ``q`` = (theta_1, r) in rad and ``rate`` in rad s-1.

    A closed joint (side 0) has zero opening and rate. ``way``: the sign of theta_1' that dry friction acts against,
    0 where it holds the wall; without meaning where the base joint is closed or nothing rubs.
    """

    sides: tuple[int, int]
    q: tuple[float, float]
    rate: tuple[float, float]
    way: int = 1

    @property
    def corners(self) -> tuple[int, int]:
        """Pivots to write the equations about: either serves at a closed joint."""
        return self.sides[0] or 1, self.sides[1] or 1

    @property
    def free(self) -> tuple[int, int]:
        """``sides``, with 0 for a wall that friction holds too: where 0, the joint's rate stays zero."""
        return self.sides[0] if self.way else 0, self.sides[1]

    @property
    def theta(self) -> tuple[float, float]:
        """Rotations of both bodies against the base, in rad."""
        return self.q[0], self.q[0] + self.q[1]
