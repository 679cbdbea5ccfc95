"""What an answer is given for, and how far its making has come."""

from __future__ import annotations

from dataclasses import dataclass

from diagnosis.data.measured import Measured
from diagnosis.progress import Progress, Stages
from grids.specimen import Specimen


@dataclass(frozen=True)
class Task:
    """One diagnosis after its search.

    ``held``: the recordings held out; ``draws`` of the bootstrap; ``finished``: the search came to its end; ``stages``:
    those after it.
    """

    specimen: Specimen
    held: Measured | None
    draws: int
    progress: Progress
    seed: int
    finished: bool
    stages: Stages
