"""The rubber yields and dissipates in loops that do not depend on the rate."""

from __future__ import annotations

from models.base import Mechanism, MechanismParameter, Values
from models.interface.layered import LayeredWall
from models.isolated.chain import Chain


def on_interface(wall: LayeredWall, values: Values) -> LayeredWall:
    return wall.with_law("bouc_wen", values)


def on_isolated(chain: Chain, values: Values) -> Chain:
    return chain.with_law("bouc_wen", values)


MECHANISM = Mechanism(
    name="bouc_wen",
    effect_class="bouc_wen",
    parameters=(
        MechanismParameter("post_yield_ratio", "a", "1", "stiffness after yielding over the first", 0.0, 1.0, null=1.0),
        MechanismParameter(
            "yield_compression",
            "u_y",
            "m",
            "compression at which it yields",
            1e-5,
            0.05,
            null=1e-3,
            shape=True,
            required=True,
        ),
        MechanismParameter(
            "exponent", "n", "1", "sharpness of yielding, a whole number", 1.0, 4.0, null=1.0, shape=True
        ),
    ),
    equation="s = a k u + (1-a) k zeta + c u', zeta' = u' - beta |u'| |zeta|^(n-1) zeta - gamma u' |zeta|^n, "
    "beta = gamma = 1/(2 u_y^n)",
    signature="with the amplitude; loops at any frequency",
    sentence="the rubber yields at {yield_compression:.2e} m to {post_yield_ratio:.2f} of its stiffness "
    "(its parameters are not unique: look at the loop)",
    acts={"interface": on_interface, "isolated": on_isolated},
    at_joints=("interface",),
    source="Wen (J. Eng. Mech. Div. 102, 1976): models/rubber/bouc_wen.py",
)
