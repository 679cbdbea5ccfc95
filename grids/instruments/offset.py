"""The zero of the rotation sensors is wrong."""

from __future__ import annotations

from grids.instruments.base import REFERENCE_MEANING, Channels, Surroundings, is_rotation, reference_peak
from models.base import Mechanism, MechanismParameter, Values


def respond(channels: Channels, values: Values, _: Surroundings) -> Channels:
    shift = values["offset_over_peak"] * reference_peak(channels, values)
    return {name: x + shift if is_rotation(name) else x for name, x in channels.items()}


MECHANISM = Mechanism(
    name="offset",
    effect_class="offset",
    parameters=(
        MechanismParameter(
            "offset_over_peak", "o_s", "1", "zero error of the rotation sensors over the largest rotation", -0.15, 0.15
        ),
        MechanismParameter("reference_peak", "theta_ref", "rad", REFERENCE_MEANING, 0.0, shape=True),
    ),
    equation="recorded = true + offset_over_peak theta_ref, the same in rad in all rotation channels",
    signature="constant in time, at rest too; differs left and right",
    sentence="the zero of the rotation sensors is off by {offset_over_peak:+.1%} of the largest rotation",
    acts={"response": respond},
    source="readings at rest before and after a test settle it",
)
