"""The zero of the rotation sensors drifts."""

from __future__ import annotations

from grids.instruments.base import Channels, Surroundings
from models.base import Mechanism, MechanismParameter, Values


def respond(channels: Channels, values: Values, around: Surroundings) -> Channels:
    shift = values["rate"] * around.time_of("drift")
    return {name: x + shift if around.is_rotation(name) else x for name, x in channels.items()}


MECHANISM = Mechanism(
    name="drift",
    effect_class="drift",
    parameters=(
        MechanismParameter(
            "rate", "d_s", "rad s-1", "change of the rotation sensors' zero with time", -0.005, 0.005
        ),
    ),
    equation=(
        "recorded = true + rate t, t from the start of each recording, or from where the drift begins in it; all "
        "rotation channels alike"
    ),
    signature="grows with time, at rest too; differs left and right",
    sentence="the zero of the rotation sensors drifts by {rate:+.2g} rad/s",
    acts={"response": respond},
    static_test="read the rotation sensors at rest before and after a run",
    source="thermal drift of transducers and of integrated gyroscopes",
)  # fmt: skip
