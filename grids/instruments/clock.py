"""The clocks of the response and of the base run at different rates."""

from __future__ import annotations

from models.base import Mechanism, MechanismParameter, Values


def clock(values: Values) -> tuple[float, float]:
    return float(values["rate"]), 0.0


MECHANISM = Mechanism(
    name="clock",
    effect_class="clock",
    parameters=(
        MechanismParameter("rate", "r_c", "1", "how much faster the true time runs than the recorded", -0.02, 0.02),
    ),
    equation="recorded(t) = true((1 + rate) t), response channels",
    signature="a lag that grows with time",
    sentence="the clock of the response channels differs from that of the base by {rate:+.2%}",
    acts={"clock": clock},
    static_test="put one signal on a response and a base channel and compare the times at start and end",
    source="loggers without a common trigger clock",
)
