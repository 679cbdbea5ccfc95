"""What the linear model of a wall between two layers takes and gives, where it differs from `interface`."""

from __future__ import annotations

from dataclasses import replace

from models.base import Quantity
from models.interface import declaration as full

OPTIONS: dict[str, tuple[str, ...]] = {"joints": full.OPTIONS["joints"]}
"""Where the rubber is; the other joint is bonded."""
FIXED = {
    "kinematics": "midpoint_held",
    "dashpot": "A",
    "rubber_law": "linear",
    "base_rubber_law": "same",
    "top_rubber_law": "same",
}
"""The words of the options of `interface` that the paper's equation stands for."""

BRIEF = 0.2
"""A joint whose excursions from the switch become shorter than this over the fastest rate is held there."""

UP = "a joint is up while it is not in full contact (z + b |r| > 0, or held at the switch); counted to overturning"
RULES = {
    "status": "outside_model: a joint opened completely (z >= b |r|), which these equations do not describe; "
    f"{full.STATUS_RULE}, or too many switches within one sample",
    "minimum_contact": "1 in full contact, .5 once it was left, 0 where z >= b |r|",
    "peak_strain": "(compression + b |r|)/e, of an overturned wall that of the fall; above 1 the layer would be "
    "compressed beyond its own thickness; nan for a bonded joint",
    "dissipated_energy": "work of the dashpots, and the springs' energy that is lost (leaving full contact: 12.5 % "
    "of it) or gained at the switches; counted to overturning",
}


def _rule(quantity: Quantity) -> Quantity:
    for name, rule in RULES.items():
        if quantity.name.startswith(name):
            return replace(quantity, rule=rule)
    return replace(quantity, rule=quantity.rule.replace(full.UP, UP))


OUTPUTS = tuple(_rule(quantity) for quantity in full.OUTPUTS)
