"""The rubber stays compressed where it was pressed hardest."""

from __future__ import annotations

from models.base import Mechanism, MechanismParameter, Values
from models.interface.layered import LayeredWall


def on_interface(wall: LayeredWall, values: Values) -> LayeredWall:
    return wall.with_law("permanent_set", values)


MECHANISM = Mechanism(
    name="permanent_set",
    effect_class="permanent_set",
    parameters=(
        MechanismParameter("rate", "r_p", "s-1", "rate of permanent compression beyond the strain limit", 0.0, 20.0),
        MechanismParameter(
            "strain_limit", "eps_p", "1", "strain without permanent compression", 0.0, 2.0, null=0.5, shape=True
        ),
    ),
    equation="s = k (u - u_p) + c u', u_p' = rate e max(0, (u - u_p)/e - strain_limit)",
    signature="late; rotations that do not come back",
    sentence="the rubber takes a set at {rate:.2f} per second beyond a strain of {strain_limit:.2f}",
    acts={"interface": on_interface},
    at_joints=("interface",),
    source="models/rubber/permanent_set.py",
)
