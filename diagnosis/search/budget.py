"""A search ends when its work is done: lane-steps of the kernels, so that an answer does not depend on the machine."""

from __future__ import annotations

from dataclasses import dataclass, field

from models.runs import DONE

MOST = 400_000_000
"""Lane-steps of a search: about two minutes of one core with a mechanism that needs short steps."""
ENDED = "the search's budget of work ended before it"


@dataclass(frozen=True)
class Budget:
    """Lane-steps from ``begin`` on."""

    most: int = MOST
    begin: int = field(default_factory=lambda: DONE.steps)

    @property
    def spent(self) -> bool:
        return DONE.steps - self.begin > self.most
