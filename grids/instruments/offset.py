"""The zero of the rotation sensors is wrong."""

from __future__ import annotations

from grids.instruments.base import Channels, Level, Surroundings
from models.base import Mechanism, Values


def respond(channels: Channels, values: Values, around: Surroundings) -> Channels:
    shift = values["offset_over_peak"] * around.peak(channels)
    return {name: x + shift if around.is_rotation(name) else x for name, x in channels.items()}


MECHANISM = Mechanism(
    name="offset",
    effect_class="offset",
    parameters=(
        Level(
            "offset_over_peak", "o_s", "1", "zero error of the rotation sensors over the largest rotation", -0.15, 0.15
        ),
    ),
    equation="recorded = true + offset_over_peak theta_ref, the same in rad in all rotation channels",
    signature="constant in time, at rest too; differs left and right",
    sentence="the zero of the rotation sensors is off by {offset_over_peak:+.1%} of the largest rotation",
    acts={"response": respond},
    static_test="read the rotation sensors at rest before and after a run",
    source="readings at rest before and after a test settle it",
)
