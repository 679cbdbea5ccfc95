"""A search ends when its work is done, in seconds of a typical core that are counted, so that an answer depends on no
machine (`models.runs.Work`)."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from models.runs import DONE

MOST = 90.0
"""s of the search for the first effect."""
JOINTS = 45.0
"""s for the law of the strongest single at other joints."""
UNTRIED = 60.0
"""s for what is left of the screen, in the place of the strongest single."""
DECLARED = 80.0
"""s for pairs from the specimen as declared, where no mechanism alone explains much."""
FURTHER = 150.0
"""s for effects beside the first, kept back from all that comes before: where two act, the first explains little."""
THIRD = 60.0
"""s at least for a third effect, where two leave something."""
WEIGHING = 20.0
"""s at least to weigh mechanisms alone against each other, each under errors of its own."""
NUMBERS = 30.0
"""s for other whole numbers of two effects, whatever was spent before."""
LAST = 60.0
"""s for others in the place of each of several effects at the end, whatever was spent before."""
RESERVED = 110.0
"""s for effects that begin or end: they may explain everything."""
LADDER = 90.0
"""s after which no further base model is tried."""
SEARCH, ANSWER = 250.0, 265.0
"""s of all searches together, calibration included, and of an answer with the law in a table that it may lack."""
ENDED = "the search's budget of work ended before it"


@dataclass(frozen=True)
class Budget:
    """``most`` s of work from the moment on at which it ``began``."""

    most: float = MOST
    began: float = field(default_factory=lambda: DONE.seconds)

    @property
    def left(self) -> float:
        return self.most - (DONE.seconds - self.began)

    @property
    def spent(self) -> bool:
        return self.left < 0.0

    def after(self, other: Budget) -> Budget:
        """This budget once ``other``, begun later, has been worked on."""
        return replace(self, began=self.began + DONE.seconds - other.began)
