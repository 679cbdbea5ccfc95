"""The response is recorded later than the base."""

from __future__ import annotations

from models.base import Mechanism, MechanismParameter, Values


def clock(values: Values) -> tuple[float, float]:
    return 0.0, float(values["delay"])


MECHANISM = Mechanism(
    name="delay",
    effect_class="delay",
    parameters=(MechanismParameter("delay", "t_d", "s", "lag of the response channels behind the base", -0.04, 0.04),),
    equation="recorded(t) = true(t - delay), response channels",
    signature="with the angular velocity, everywhere",
    sentence="the response channels lag the base by {delay:.4f} s",
    acts={"clock": clock},
    static_test="put one signal on a response and a base channel and compare the times",
    source="channels of different loggers or filters",
)
