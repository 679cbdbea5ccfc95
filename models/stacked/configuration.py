"""The nine configurations of two stacked blocks, each a pair (s1, s2) of joint states.

s1 = 1 or -1: the wall is up and turns about its right or left corner; 0: the base joint is closed
(theta_1 = 0). s2 likewise for block 2 on the wall (0: theta_2 = theta_1).
Patterns (Psycharis 1990): 1 both rock to one side, 2 both rock to opposite sides, 3 as one body,
4 only the upper block; each has two signs. And rest.
"""

from __future__ import annotations

CONFIGURATIONS: tuple[tuple[int, int], ...] = (
    (1, 1), (-1, -1), (1, -1), (-1, 1), (1, 0), (-1, 0), (0, 1), (0, -1), (0, 0),
)  # fmt: skip
NAMES = (
    "pattern_1_right", "pattern_1_left", "pattern_2_right", "pattern_2_left", "pattern_3_right",
    "pattern_3_left", "pattern_4_right", "pattern_4_left", "rest",
)  # fmt: skip
"""right: the lowest joint that is up turns about its right corner (clockwise)."""
REST = 8


def index(s1: int, s2: int) -> int:
    """Where (s1, s2) stands in `CONFIGURATIONS`; also its bit in the mask of visited ones."""
    return CONFIGURATIONS.index((s1, s2))
