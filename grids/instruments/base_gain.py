"""The accelerometer of the base reads too little or too much."""

from __future__ import annotations

from dataclasses import replace

from models.base import Mechanism, MechanismParameter, Values
from models.shaking import Shaking


def move(shaking: Shaking, values: Values) -> Shaking:
    return replace(shaking, horizontal=shaking.horizontal * (1.0 + values["gain"]))


MECHANISM = Mechanism(
    name="base_gain",
    effect_class="base_gain",
    parameters=(
        MechanismParameter("gain", "g_b", "1", "the base moves this share more than is measured", -0.15, 0.15),
    ),
    equation="a = (1 + gain) a_measured (horizontal)",
    signature="between impacts, with the base acceleration; the first uplift",
    sentence="the base moves {gain:+.1%} more than its accelerometer says (below zero: less)",
    acts={"base": move},
    static_test="calibrate the accelerometer of the base",
    source="calibration of the accelerometer settles it",
)
