"""The contact of a joint freezes at half its length once it opens, as the published equations have it."""

from __future__ import annotations

from models.base import Mechanism, MechanismParameter, Values
from models.interface.layered import LayeredWall


def on_interface(wall: LayeredWall, values: Values) -> LayeredWall:
    base, top = (values.get(f"frozen_{joint}", values["frozen"]) for joint in ("base", "top"))
    return wall.with_effect("contact_length", frozen_base=base, frozen_top=top)


MECHANISM = Mechanism(
    name="contact_length",
    effect_class="contact_length",
    parameters=(
        MechanismParameter("frozen", "phi", "1", "share of the forces of a contact frozen at half the joint", 0.0, 1.0),
    ),
    equation="forces (1 - phi) exact + phi frozen; frozen: spring and dashpot (law A) of the whole joint, of the half "
    "that presses once z + b |r| > 0, the change spread over an opening of .05 of the static compression",
    signature="at large rotations; forces change when a joint opens or closes",
    sentence="{frozen:.1%} of the contact forces act as if half of the joint stayed in contact whatever the rotation",
    acts={"interface": on_interface},
    at_joints=("interface",),
    source="Mordant, Denoel, Degee (COMPDYN 2015), Eq. 6; docs/errata.md",
)
