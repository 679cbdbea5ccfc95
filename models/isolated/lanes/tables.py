"""The tables of the kernel: what n lanes are given and give, and what the W lanes under way hold."""

from __future__ import annotations

from typing import NamedTuple

from models.isolated.lanes.rows import Table


class Given(NamedTuple):
    """What the lanes start from, one line (n, ...) a lane; rows as in `models.isolated.lanes.rows`."""

    scalars: Table
    memory: Table
    """Of the bearings (n, `N_MEMORY`)."""
    numbers: Table
    """Of Payne's law and wear (n, `N_LAW`)."""
    hidden: Table
    """Of the rubber's laws (n, hidden rows of `models.rubber.lanes`)."""
    rubber: Table
    """Numbers of the rubber's laws (n, rows of `models.rubber.lanes`)."""
    states: Table
    """y = (x, x') (n, 2 levels)."""
    transitions: Table
    """P (n, 2 levels, 2 levels) of `models.isolated.modes.exact_step`."""
    gains: Table
    """G (n, 2 levels, 4)."""
    links: Table
    """Spring, dashpot and mark of every level's lower link (n, 3, levels)."""
    masses: Table
    """Masses and their inverses (n, 2, levels)."""


class Lent(NamedTuple):
    """What the lanes under way hold, the last axis W lanes long; names as in `Given`."""

    scalars: Table
    memory: Table
    numbers: Table
    state: Table
    transition: Table
    gains: Table
    links: Table
    masses: Table
    new: Table
    """y at the end of the step under way."""
    spring: Table
    """The rubber's springs, their hidden states and numbers (`N_SPRING` of `models.isolated.lanes.bearing`,)."""


class Records(NamedTuple):
    """What comes back."""

    result: Table
    """(n, `N_RESULT`)."""
    states: Table
    """y at the end (n, 2 levels)."""
    memory: Table
    hidden: Table
    trace: Table
    """y and the bearings' force at every sample (n, m, 2 levels + 1), if m > 0."""
