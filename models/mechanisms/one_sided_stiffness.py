"""The base layer is stiffer under one half of the wall than under the other."""

from __future__ import annotations

import numpy as np

from models.base import Mechanism, MechanismParameter, Values
from models.interface.layered import LayeredWall


def on_interface(wall: LayeredWall, values: Values) -> LayeredWall:
    ratio = np.asarray(values["right_over_left"], float)
    return wall.with_effect("one_sided_stiffness", left=2.0 / (1.0 + ratio), right=2.0 * ratio / (1.0 + ratio))


MECHANISM = Mechanism(
    name="one_sided_stiffness",
    effect_class="one_sided_stiffness",
    parameters=(
        MechanismParameter(
            "right_over_left", "r_s", "1", "stiffness of the base layer at x > 0 over that at x < 0", 0.5, 2.0, null=1.0
        ),
    ),
    equation="k 2/(1 + r_s) at x < 0, k 2 r_s/(1 + r_s) at x > 0; the dashpot stays",
    signature="differs left and right; the wall leans at rest",
    sentence="the base layer is {right_over_left:.2f} times as stiff on the right as on the left",
    acts={"interface": on_interface},
    static_test="push the wall slowly to either side and compare",
    source="exact strips of both halves: models/interface/strip.py",
)
