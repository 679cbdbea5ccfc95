"""The base model that recordings of two stacked blocks may ask for instead: both joints on rubber."""

from __future__ import annotations

from models.identification import Numbers
from models.layers import (
    BASE_DAMPING_RATIO,
    BASE_STIFFNESS,
    DAMPING_RATIOS,
    LAYER_THICKNESS,
    TOP_DAMPING_RATIO,
    TOP_STIFFNESS,
    compliant,
    stiffness_range,
)
from models.walls import bodies


def ranges(wall: Numbers) -> dict[str, tuple[float, float]]:
    """What both layers may be."""
    two = bodies(wall)
    upper, gravity = float(two.mass_2[0]), float(two.gravity[0])
    whole = upper + float(two.mass_1[0])
    return {
        BASE_STIFFNESS.name: stiffness_range(whole, 2.0 * float(two.half_length_1[0]), gravity),
        BASE_DAMPING_RATIO.name: DAMPING_RATIOS,
        TOP_STIFFNESS.name: stiffness_range(upper, 2.0 * float(two.half_joint[0]), gravity),
        TOP_DAMPING_RATIO.name: DAMPING_RATIOS,
    }


def on_layers(wall: Numbers, own: Numbers) -> dict[str, float]:
    """The same bodies with rubber in the joints."""
    kept = {name: value for name, value in wall.items() if name not in GIVEN_RATIOS}
    return {**kept, "layer_thickness": LAYER_THICKNESS, **own}


GIVEN_RATIOS = ("base_restitution", "top_restitution")
LADDER = (
    compliant(
        parameters=(BASE_STIFFNESS, BASE_DAMPING_RATIO, TOP_STIFFNESS, TOP_DAMPING_RATIO),
        ranges=ranges,
        carried_over=on_layers,
        without=GIVEN_RATIOS,
    ),
)
