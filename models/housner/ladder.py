"""Base models that recordings of one block may ask for instead: a second body on it, or rubber under it.

The block is cut at the height of a joint. What stands over it, with a mass on top, becomes a rectangle of the same
mass, mass centre and moment of inertia: height 2c, length^2 = 12 I/m - (2c)^2, the joint no longer than the block is
wide.
"""

from __future__ import annotations

import math

from models.base import MechanismParameter
from models.identification import Numbers, Rung
from models.layers import BASE, LAYER_THICKNESS, TOP, compliant, layer_ranges

JOINT = MechanismParameter(
    "joint_over_height",
    "h_1/h",
    "1",
    "height of the joint over the base, over the block's height",
    0.0,
    1.0,
    low_open=True,
)
LOWEST, HIGHEST = 0.1, 0.95
"""Between which a joint is looked for; up to a mass on top that has a height of its own."""
ANYWHERE = 0.5
"""Of the block's height, where it is cut when both parts move as one."""
DEFAULTS = {"top_mass": 0.0, "top_mass_height": 0.0, "top_mass_inertia": 0.0}


def cut(block: Numbers, share: float) -> dict[str, float]:
    """Two rectangles in the place of a block, by the parameters of walls; ``share`` of its height: the joint."""
    height = block["height"]
    joint = share * height
    width = block["width"] if "width" in block else block["aspect_ratio"] * height
    on_top, above, inertia = (block.get(name, default) for name, default in DEFAULTS.items())
    lower = block["mass"] * share
    part = block["mass"] - lower
    mass = part + on_top
    over = height - joint
    centre = (part * over / 2.0 + on_top * (over + above)) / mass
    turning = part * (width**2 + over**2) / 12.0 + part * (over / 2.0 - centre) ** 2
    turning += inertia + on_top * (over + above - centre) ** 2
    squared = 12.0 * turning / mass - (2.0 * centre) ** 2
    found = {
        "wall_length": width, "wall_height": joint, "wall_mass": lower, "top_mass": mass, "top_height": 2.0 * centre,
        "top_length": math.sqrt(squared) if squared > 0.0 else width,
    }  # fmt: skip
    return found | ({"gravity": block["gravity"]} if "gravity" in block else {})


def stacked(block: Numbers, own: Numbers) -> dict[str, float]:
    """The parameters of two stacked blocks."""
    given = {"base_restitution": block["restitution"]} if "restitution" in block else {}
    return cut(block, own[JOINT.name]) | given


def on_layers(block: Numbers, own: Numbers) -> dict[str, float]:
    """The parameters of a block on rubber, with a joint on rubber where one is asked for."""
    layers = {name: value for name, value in own.items() if name != JOINT.name}
    return {**cut(block, own.get(JOINT.name, ANYWHERE)), "layer_thickness": LAYER_THICKNESS, **layers}


def joints(block: Numbers) -> dict[str, tuple[float, float]]:
    """Where a joint may be."""
    return {JOINT.name: (LOWEST, 1.0 if _something_on_top(block) else HIGHEST)}


def under_the_top(block: Numbers) -> dict[str, float]:
    """Where a joint is the likeliest: under what stands on the block."""
    return {JOINT.name: 1.0} if _something_on_top(block) else {}


def _something_on_top(block: Numbers) -> bool:
    return min(block.get("top_mass_height", 0.0), block.get("top_mass", 0.0)) > 0.0


def whole_load(block: Numbers) -> tuple[float, float]:
    """Mass (kg) of the block with what stands on it, and its length (m)."""
    whole = cut(block, ANYWHERE)
    return whole["wall_mass"] + whole["top_mass"], whole["wall_length"]


def base_layer(block: Numbers) -> dict[str, tuple[float, float]]:
    """What the layer under the block may be."""
    return layer_ranges(block.get("gravity"), base=whole_load(block))


def both_layers(block: Numbers) -> dict[str, tuple[float, float]]:
    """What the layers under the block and at a joint in it may be."""
    load = whole_load(block)
    return {**layer_ranges(block.get("gravity"), base=load, top=load), **joints(block)}


def refusal(block: Numbers) -> str:
    """Why the block cannot be cut; empty where it can."""
    if "inertia" in block:
        return "the inertia of the block is given, and how two parts share it is not known"
    return "" if block.get("mass", 0.0) > 0.0 else "the block has no mass of its own"


LAWS_OF_RESTITUTION = ("restitution_aspect_coefficient", "restitution_amplitude_exponent")
LADDER = (
    Rung(
        name="second_body",
        model="stacked",
        equation="two rigid blocks, one on the other: each joint opens on either side (Psycharis, 1990)",
        sentence="a second body moves on the first, from a joint at {joint_over_height:.0%} of the height on",
        parameters=(JOINT,),
        ranges=joints,
        likely=under_the_top,
        carried_over=stacked,
        without=LAWS_OF_RESTITUTION,
        alike={"rotation_2": "rotation_1", "rotation_rate_2": "rotation_rate_1"},
        refusal=refusal,
    ),
    compliant(
        options={"joints": "base"},
        parameters=BASE,
        ranges=base_layer,
        carried_over=on_layers,
        without=("restitution", *LAWS_OF_RESTITUTION),
        not_recorded=("rotation_2",),
        alike={"rotation_2": "rotation_1", "rotation_rate_2": "rotation_rate_1"},
        bonded=True,
        refusal=refusal,
    ),
    compliant(
        parameters=(*BASE, *TOP, JOINT),
        ranges=both_layers,
        likely=under_the_top,
        carried_over=on_layers,
        without=("restitution", *LAWS_OF_RESTITUTION),
        recorded=("rotation_2",),
        refusal=refusal,
    ),
)
