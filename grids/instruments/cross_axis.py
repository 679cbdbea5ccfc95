"""The rotation sensors respond to the acceleration of the base."""

from __future__ import annotations

from grids.instruments.base import Channels, Surroundings
from models.base import Mechanism, MechanismParameter, Values


def respond(channels: Channels, values: Values, around: Surroundings) -> Channels:
    leak = values["rotation_per_acceleration"] * around.base_acceleration
    return {name: x + leak if around.is_rotation(name) else x for name, x in channels.items()}


MECHANISM = Mechanism(
    name="cross_axis",
    effect_class="cross_axis",
    parameters=(
        MechanismParameter(
            "rotation_per_acceleration", "c_x", "rad s2 m-1", "rotation read per horizontal base acceleration",
            -0.01, 0.01,
        ),
    ),
    equation="recorded = true + rotation_per_acceleration a, all rotation channels alike; a: of the base as it moves",
    signature="follows the base acceleration, at rest too",
    sentence="the rotation sensors read {rotation_per_acceleration:.2g} rad for each m/s2 of the base's acceleration",
    acts={"response": respond},
    static_test="shake the table with the block tied down and read the rotation sensors",
    source="inclinometers and tilted accelerometers do this",
)  # fmt: skip
