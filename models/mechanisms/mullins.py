"""The rubber is softer once it has been compressed far."""

from __future__ import annotations

from models.base import Mechanism, MechanismParameter, Values
from models.interface.layered import LayeredWall
from models.isolated.chain import Chain


def on_interface(wall: LayeredWall, values: Values) -> LayeredWall:
    return wall.with_law("mullins", values)


def on_isolated(chain: Chain, values: Values) -> Chain:
    return chain.with_law("mullins", values)


MECHANISM = Mechanism(
    name="mullins",
    effect_class="mullins",
    parameters=(
        MechanismParameter("softening", "s_M", "1", "largest share of stiffness lost", 0.0, 0.7),
        MechanismParameter("strain", "eps_M", "1", "strain over which it is lost", 0.02, 2.0, null=0.5, shape=True),
    ),
    equation="s = k [1 - softening (1 - exp(-u_max/(strain e)))] u + c u'",
    signature="grows with the largest rotation so far",
    sentence="the rubber has lost up to {softening:.1%} of its stiffness over a strain of {strain:.2f}",
    acts={"interface": on_interface, "isolated": on_isolated},
    at_joints=("interface",),
    source="Mullins (Rubber Chem. Technol. 42, 1969): models/rubber/mullins.py",
)
