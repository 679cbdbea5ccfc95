"""The zero of the accelerometer of the base is wrong."""

from __future__ import annotations

from dataclasses import replace

from models.base import Mechanism, MechanismParameter, Values
from models.shaking import Shaking


def move(shaking: Shaking, values: Values) -> Shaking:
    return replace(shaking, horizontal=shaking.horizontal - values["offset"])


MECHANISM = Mechanism(
    name="accelerometer_offset",
    effect_class="tilt",
    parameters=(MechanismParameter("offset", "a_0", "m s-2", "measured minus true base acceleration", -0.5, 0.5),),
    equation="a = a_measured - offset",
    signature="differs left and right, between impacts; the first uplift",
    sentence="the accelerometer of the base reads {offset:+.3f} m/s2 too much (below zero: too little)",
    acts={"base": move},
    static_test="read the accelerometer of the base at rest",
    source="readings at rest settle it, and the mean over a motion that comes back to rest",
)
