"""Two stacked rigid blocks: impacts with published numbers, and the start from rest."""

from __future__ import annotations

from functools import partial

import numpy as np

import models
from models.shaking import Shaking
from models.stacked.configuration import BASE, TOP, State
from models.stacked.model import MODEL as STACKED
from models.stacked.reference.impact import impact
from study.verify.base import Oracle

WALL = {
    "wall_length": 1.0, "wall_height": 3.0, "wall_mass": 1000.0, "top_mass": 500.0, "top_length": 0.6,
    "top_height": 1.2, "gravity": 9.81,
}  # fmt: skip
IMPACTS = (
    (BASE, (1, 1), (0.0, 0.05), (-1.0, 0.5), (-0.7872007, -0.52644442)),
    (BASE, (1, -1), (0.0, -0.03), (-1.0, -0.2), (-0.96779452, 0.16873162)),
    (TOP, (1, 1), (0.04, 0.0), (0.3, -0.4), (0.24583152, -0.04916195)),
)
"""Joint, sides, opening, angular velocities before, and after: inelastic projection in the kinetic metric."""
LANES = 64


def after_impact(case: int, body: int) -> float:
    joint, sides, opening, before, _ = IMPACTS[case]
    found = impact(STACKED.build(WALL).one(), joint, State(sides, opening, (before[0], before[1] - before[0])), False)
    return float(found.rate[0] + (found.rate[1] if body == 2 else 0.0))


def start(top_height: float) -> float:
    """Smallest constant acceleration, in g, under which anything rocks."""
    model, wall = models.get(STACKED.name), {**WALL, "top_height": top_height}
    low, high = 0.1, 0.3
    while high - low > 1e-9:
        scale = np.linspace(low, high, LANES)
        rotation = model.evaluate(
            wall, Shaking(0.01, np.ones(3)), scale * WALL["gravity"], outputs=["peak_rotation"], tail=0.0
        )["peak_rotation"]
        first = int(np.argmax(rotation > 0.0))
        low, high = float(scale[first - 1]), float(scale[first])
    return 0.5 * (low + high)


def oracles() -> list[Oracle]:
    of = partial(Oracle, STACKED.name)
    found = [
        of(f"impact {case + 1}, angular velocity of block {body} after it", "derived", IMPACTS[case][4][body - 1], 6.5,
           partial(after_impact, case, body))
        for case in range(len(IMPACTS)) for body in (1, 2)
    ]  # fmt: skip
    return [
        *found,
        of("rocking as one body starts at, in g: b M/S", "closed form", 750.0 / 3300.0, 8.0, partial(start, 1.2)),
        of("the upper block alone starts at, in g: b2/h2", "closed form", 0.3 / 1.6, 8.0, partial(start, 3.2)),
    ]
