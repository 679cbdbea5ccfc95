"""The rotation sensors reach the end of their range."""

from __future__ import annotations

import numpy as np

from grids.instruments.base import Channels, Level, Surroundings
from models.base import Mechanism, Values


def respond(channels: Channels, values: Values, around: Surroundings) -> Channels:
    level = values["level_over_peak"] * around.peak(channels)
    return {name: np.clip(x, -level, level) if around.is_rotation(name) else x for name, x in channels.items()}


MECHANISM = Mechanism(
    name="saturation",
    effect_class="saturation",
    parameters=(
        Level(
            "level_over_peak", "l_s", "1", "end of the rotation sensors' range over the largest rotation",
            0.3, 1.0, null=1.0,
        ),
    ),
    equation="recorded = clip(true, -level, level), level = level_over_peak theta_ref",
    signature="only at the largest rotations: flat tops",
    sentence="the rotation sensors stop at {level_over_peak:.0%} of the largest rotation",
    acts={"response": respond},
    static_test="look up the range of the rotation sensors",
    source="range of the data acquisition",
)  # fmt: skip
