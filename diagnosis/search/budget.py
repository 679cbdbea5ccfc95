"""A search ends when its work is done: lane-steps of the kernels, so that an answer does not depend on the machine."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from models.runs import DONE

MOST = 150_000_000
"""Lane-steps of the search for the first effect: about a minute of one core, by what each of them costs."""
FURTHER = 200_000_000
"""Lane-steps for effects beside the first, whatever was spent before: where two act, the first explains little."""
RESERVED = 60_000_000
"""Lane-steps for effects that begin or end, whatever was spent before: they come last and may explain everything."""
LADDER = 60_000_000
"""Lane-steps after which no further base model is tried."""
ENDED = "the search's budget of work ended before it"


@dataclass(frozen=True)
class Budget:
    """Lane-steps from ``begin`` on."""

    most: int = MOST
    begin: int = field(default_factory=lambda: DONE.steps)

    @property
    def spent(self) -> bool:
        return DONE.steps - self.begin > self.most

    def after(self, other: Budget) -> Budget:
        """This budget once ``other``, begun later, has been worked on."""
        return replace(self, begin=self.begin + DONE.steps - other.begin)
