"""The rubber stiffens as it is compressed."""

from __future__ import annotations

from models.base import Mechanism, MechanismParameter, Values
from models.interface.layered import LayeredWall
from models.isolated.chain import Chain


def on_interface(wall: LayeredWall, values: Values) -> LayeredWall:
    return wall.with_law("hardening", values)


def on_isolated(chain: Chain, values: Values) -> Chain:
    return chain.with_law("hardening", values)


MECHANISM = Mechanism(
    name="hardening",
    effect_class="hardening",
    parameters=(MechanismParameter("beta2", "beta_2", "1", "stiffening over the squared strain", 0.0, 80.0),),
    equation="s = k u (1 + beta2 (u/e)^2) + c u'",
    signature="at large rotations, while a joint presses on a short length",
    sentence="the rubber stiffens with the squared strain, coefficient {beta2:.1f}",
    acts={"interface": on_interface, "isolated": on_isolated},
    at_joints=("interface",),
    source="models/rubber/hardening.py",
)
