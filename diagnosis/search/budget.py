"""A search ends when its work is done: lane-steps and calls of kernels, so that an answer depends on no machine."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from models.runs import DONE

CALL = 50_000
"""What a call of a kernel costs beside its lane-steps, in lane-steps: coefficients, tables, instruments (5 ms)."""
MOST = 220_000_000
"""Lane-steps of the search for the first effect: half a minute to a minute of one core."""
JOINTS = 180_000_000
"""Lane-steps for the law of the strongest single at other joints."""
UNTRIED = 180_000_000
"""Lane-steps for what is left of the screen, in the place of the strongest single."""
FURTHER = 360_000_000
"""Lane-steps for effects beside the first, whatever was spent before: where two act, the first explains little."""
LAST = 150_000_000
"""Lane-steps for others in the place of each of several effects at the end, whatever was spent before."""
RESERVED = 700_000_000
"""Lane-steps for effects that begin or end, whatever was spent before: they come last and may explain everything."""
LADDER = 500_000_000
"""Lane-steps after which no further base model is tried."""
ENDED = "the search's budget of work ended before it"


@dataclass(frozen=True)
class Budget:
    """Work from so many ``steps`` and ``calls`` on, ``most`` in lane-steps of a wall's kernel.

    ``speed``: lane-steps a second of the model's kernel over those of a wall's (`Identification.speed`).
    """

    most: float = MOST
    speed: float = 1.0
    steps: int = field(default_factory=lambda: DONE.steps)
    calls: int = field(default_factory=lambda: DONE.calls)

    @property
    def spent(self) -> bool:
        return (DONE.steps - self.steps) / self.speed + CALL * (DONE.calls - self.calls) > self.most

    def after(self, other: Budget) -> Budget:
        """This budget once ``other``, begun later, has been worked on."""
        steps, calls = DONE.steps - other.steps, DONE.calls - other.calls
        return replace(self, steps=self.steps + steps, calls=self.calls + calls)
