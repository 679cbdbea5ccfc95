"""The rotation sensors reach the end of their range."""

from __future__ import annotations

import numpy as np

from grids.instruments.base import REFERENCE_MEANING, Channels, Surroundings, is_rotation, reference_peak
from models.base import Mechanism, MechanismParameter, Values


def respond(channels: Channels, values: Values, _: Surroundings) -> Channels:
    level = values["level_over_peak"] * reference_peak(channels, values)
    return {name: np.clip(x, -level, level) if is_rotation(name) else x for name, x in channels.items()}


MECHANISM = Mechanism(
    name="saturation",
    effect_class="saturation",
    parameters=(
        MechanismParameter(
            "level_over_peak", "l_s", "1", "end of the rotation sensors' range over the largest rotation",
            0.3, 1.0, null=1.0,
        ),
        MechanismParameter("reference_peak", "theta_ref", "rad", REFERENCE_MEANING, 0.0, shape=True),
    ),
    equation="recorded = clip(true, -level, level), level = level_over_peak theta_ref",
    signature="only at the largest rotations: flat tops",
    sentence="the rotation sensors stop at {level_over_peak:.0%} of the largest rotation",
    acts={"response": respond},
    source="range of the data acquisition",
)  # fmt: skip
