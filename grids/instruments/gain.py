"""The rotation sensors read too much or too little."""

from __future__ import annotations

from grids.instruments.base import Channels, Surroundings
from models.base import Mechanism, MechanismParameter, Values


def respond(channels: Channels, values: Values, around: Surroundings) -> Channels:
    factor = 1.0 + values["gain"]
    return {name: x * factor if around.is_rotation(name) else x for name, x in channels.items()}


MECHANISM = Mechanism(
    name="gain",
    effect_class="gain",
    parameters=(MechanismParameter("gain", "g_s", "1", "error of the rotation sensors' gain", -0.12, 0.12),),
    equation="recorded = (1 + gain) true, all rotation channels alike",
    signature="in proportion to the rotation, everywhere",
    sentence="the rotation sensors read {gain:+.1%} of the true rotation too much (below zero: too little)",
    acts={"response": respond},
    static_test="calibrate the rotation sensors statically",
    source="calibration of displacement transducers; static calibration settles it",
)
