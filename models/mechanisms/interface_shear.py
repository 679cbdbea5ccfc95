"""The layers give way along the joints, too, and meet the other side unsheared where they land."""

from __future__ import annotations

import numpy as np

from models.base import Mechanism, MechanismParameter, Values
from models.interface.layered import LayeredWall


def on_interface(wall: LayeredWall, values: Values) -> LayeredWall:
    base, top = (values.get(f"shear_over_normal_{joint}", values["shear_over_normal"]) for joint in ("base", "top"))
    return wall.with_effect("interface_shear", shear_base=base, shear_top=top)


MECHANISM = Mechanism(
    name="interface_shear",
    effect_class="interface_shear",
    parameters=(
        MechanismParameter(
            "shear_over_normal", "rho_s", "1", "stiffness along the joint over that across it", 0.05, 20.0, null=np.inf,
            fit_inverse=True,
        ),
    ),
    equation="H = rho_s (k (x L - integral of m over L) + c x' L), x the slip of the joint, L the length that presses, "
    "m the slip at which each part of it landed",
    signature="above the rocking frequency, in horizontal accelerations most; a wall that has rocked stays displaced",
    sentence="the layers give way along the joints with {shear_over_normal:.2f} of their stiffness across",
    acts={"interface": on_interface},
    at_joints=("interface",),
    static_test="push the wall along its base and read the slip",
    source="linear layer in shear: models/interface/chain.py; contact that lets go: models/interface/landing.py",
)  # fmt: skip
