"""The exact strip against OpenSeesPy's fibres: at the same step, and at the same accuracy.

The illustrative short wall between two layers under ten seconds of the record. The error of each program is
the rms of what it differs from its own result with a far finer step (OpenSees: and far more fibres), over the
rms of that: errors of the discretisation, not differences between the models.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks import opensees
from benchmarks.independent.strips import TWO_LAYERS, G, apart, opensees_rotations, record, rotations, wall
from models.interface import modes
from models.interface.lanes.run import substeps

FIBRES = 20
LEVELS = (0.1, 0.2, 0.3)
"""PGA in g."""
LADDER = ((FIBRES, 1), (40, 1), (40, 4), (80, 4), (80, 8), (160, 8))
"""Fibres a layer, and how many times finer the step, from cheap to expensive."""
FINEST = (320, 16)


def ratios(rate: float, seconds: float = 10.0) -> dict[str, Any]:
    """``rate`` lane-steps a second against OpenSeesPy; empty where it is not installed.

    ``ratio_opensees_strip``: the cheapest setting of `LADDER` that is as accurate as the lanes, or its most expensive
    (a lower bound, ``opensees_as_accurate`` false). ``..._same_step``: fibre sections, 20 fibres.
    ``..._springs_same_step``: 20 springs with exact levers at any angle.
    """
    if not opensees.available():
        return {}
    body, shaking = wall(TWO_LAYERS, "both", True), record(seconds)
    per = int(substeps(body, modes.at_rest(body).squares, shaking.time_step)[0])
    scales = [level * G / shaking.pga for level in LEVELS]

    def by_lanes(refinement: int) -> NDArray[np.float64]:
        return np.concatenate([rotations(body, shaking, scale, refinement) for scale in scales])

    def by_opensees(fibres: int, finer: int) -> NDArray[np.float64]:
        found = [opensees_rotations(body, shaking, scale, per * finer, fibres, "section") for scale in scales]
        return np.concatenate(found)

    def speed_of(way: str, fibres: int, finer: int, steps: int) -> float:
        step = shaking.time_step / per / finer
        return opensees.steps_per_second(body, shaking, scales[1], step, fibres, steps, way)

    own, finest = apart(by_lanes(1), by_lanes(16)), by_opensees(*FINEST)
    errors = {}
    for setting in LADDER:
        errors[setting] = apart(by_opensees(*setting), finest)
        if errors[setting] <= own:
            break
    fibres, finer = setting
    section, springs = speed_of("section", FIBRES, 1, 5_000), speed_of("springs", FIBRES, 1, 2_000)
    return {
        "ratio_opensees_strip": rate * finer / speed_of("section", fibres, finer, 5_000),
        "ratio_opensees_section_same_step": rate / section,
        "ratio_opensees_springs_same_step": rate / springs,
        "opensees_steps_per_second": section,
        "opensees_springs_steps_per_second": springs,
        "opensees_step_seconds": shaking.time_step / per,
        "opensees_errors": [{"fibres": f, "finer_step": k, "error": e} for (f, k), e in errors.items()],
        "opensees_as_accurate": errors[setting] <= own,
        "lanes_error": own,
    }
