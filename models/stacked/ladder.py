"""The base model that recordings of two stacked blocks may ask for instead: both joints on rubber."""

from __future__ import annotations

from models.identification import Numbers
from models.layers import BASE, LAYER_THICKNESS, TOP, compliant, layer_ranges
from models.walls import bodies


def ranges(wall: Numbers) -> dict[str, tuple[float, float]]:
    """What both layers may be."""
    two = bodies(wall)
    upper = float(two.mass_2[0])
    base = upper + float(two.mass_1[0]), 2.0 * float(two.half_length_1[0])
    return layer_ranges(float(two.gravity[0]), base=base, top=(upper, 2.0 * float(two.half_joint[0])))


def on_layers(wall: Numbers, own: Numbers) -> dict[str, float]:
    """The same bodies with rubber in the joints."""
    kept = {name: value for name, value in wall.items() if name not in GIVEN_RATIOS}
    return {**kept, "layer_thickness": LAYER_THICKNESS, **own}


GIVEN_RATIOS = ("base_restitution", "top_restitution")
LADDER = (
    compliant(
        parameters=(*BASE, *TOP),
        ranges=ranges,
        carried_over=on_layers,
        without=GIVEN_RATIOS,
    ),
)
