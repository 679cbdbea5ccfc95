"""Part of the rubber's stiffness relaxes."""

from __future__ import annotations

from models.base import Mechanism, MechanismParameter, Values
from models.interface.layered import LayeredWall
from models.isolated.chain import Chain


def on_interface(wall: LayeredWall, values: Values) -> LayeredWall:
    return wall.with_law("maxwell", values)


def on_isolated(chain: Chain, values: Values) -> Chain:
    return chain.with_law("maxwell", values)


MECHANISM = Mechanism(
    name="maxwell",
    effect_class="maxwell",
    parameters=(
        MechanismParameter(
            "arm_stiffness_ratio", "k_1/k", "1", "stiffness of the relaxing arm over the layer's", 0.0, 1.5
        ),
        MechanismParameter(
            "relaxation_time", "tau", "s", "relaxation time of the arm", 0.005, 0.5, null=0.05, shape=True
        ),
    ),
    equation="s = k u + k1 (u - v) + c u', v' = (u - v)/tau",
    signature="everywhere, more at higher frequencies",
    sentence="an arm of {arm_stiffness_ratio:.2f} times the layer's stiffness relaxes within {relaxation_time:.3f} s",
    acts={"interface": on_interface, "isolated": on_isolated},
    at_joints=("interface",),
    source="models/rubber/maxwell.py",
)
