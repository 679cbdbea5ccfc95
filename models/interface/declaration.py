"""What the model of a wall between two rubber layers takes and gives: docs, checks and cube labels."""

from __future__ import annotations

from models.base import Parameter, Quantity
from models.rubber import LAWS
from models.walls import ALTERNATIVES as OF_WALLS
from models.walls import PARAMETERS as OF_WALL
from models.walls import by_body, by_joint, peaks_by_body


def _layer(name: str, symbol: str, unit: str, meaning: str) -> tuple[Parameter, ...]:
    """A quantity of both layers, and of each alone."""
    return tuple(
        Parameter(prefix + name, symbol + index, unit, f"{meaning} of {which}", 0.0, low_open=True)
        for prefix, index, which in (
            ("", "", "both layers"),
            ("base_", "_b", "the base layer"),
            ("top_", "_t", "the top layer"),
        )
    )


PARAMETERS = (
    *OF_WALL,
    *_layer("layer_thickness", "e", "m", "unstressed thickness"),
    *_layer("layer_modulus", "E", "Pa", "modulus in compression, unstressed: k = E t/e"),
    Parameter(
        "base_stiffness",
        "k_b",
        "N m-2",
        "force per metre of contact and compression, base",
        0.0,
        low_open=True,
    ),
    Parameter("top_stiffness", "k_t", "N m-2", "force per metre of contact and compression, top", 0.0, low_open=True),
    *(
        Parameter(p.name, p.symbol, p.unit, p.meaning, 0.0, 1.0)
        for p in _layer("damping_ratio", "xi", "1", "damping ratio at the lowest frequency, c = 2 xi k/omega_1,")
    ),
    Parameter("base_damping", "c_b", "N s m-2", "dashpot per metre of contact, base layer", 0.0),
    Parameter("top_damping", "c_t", "N s m-2", "dashpot per metre of contact, top layer", 0.0),
)


def _choices(both: str, *each: tuple[str, str]) -> tuple[tuple[str, ...], ...]:
    """One name for both layers, a pair for each, or (rubber at one joint only) one of a pair."""
    return (*(((both,),) if both else ()), *each, *((name,) for pair in each for name in pair))


ALTERNATIVES = (
    *OF_WALLS,
    _choices("layer_thickness", ("base_layer_thickness", "top_layer_thickness")),
    _choices("layer_modulus", ("base_layer_modulus", "top_layer_modulus"), ("base_stiffness", "top_stiffness")),
    _choices("damping_ratio", ("base_damping_ratio", "top_damping_ratio"), ("base_damping", "top_damping")),
)

OPTIONS: dict[str, tuple[str, ...]] = {
    "kinematics": ("toe_held", "midpoint_held"),
    "dashpot": ("B", "A"),
    "joints": ("both", "base", "top"),
    "rubber_law": ("as_given", "linear", *LAWS),
    "base_rubber_law": ("same", "linear", *LAWS),
    "top_rubber_law": ("same", "linear", *LAWS),
}
"""``dashpot`` A: may pull while in contact; B: total stress clipped at zero tension. ``joints``: where the
rubber is; the other joint is bonded. ``rubber_law`` as_given: the laws whose parameters are given act."""

OVERTURNED = (
    "overturned when |theta| of a body reaches pi/2, or when at the end of the run its mass centre is past the toe "
    "of the joint it stands on and moves outwards; with the wall overturns what stands on it"
)
UP = (
    "a joint is up while part of it carries no compression: total stress under dashpot law B, w < 0 under law A "
    "(see the option dashpot); counted to overturning"
)
LOST = "what the rubber's law could give back at the end counts as stored; counted to overturning"
STATUS_RULE = (
    "not_converged: the wall cannot stand under its own weight (a law cannot carry it or creeps without end, it tips, "
    "a layer is compressed beyond its thickness), or the run diverged: a state that is not a number, a layer opened or "
    "compressed by more than ten times the wall's size, energy that nothing has given, a layer pressed beyond its lock "
    "strain by more or less, or a wall that falls or not, as the step goes"
)
CALM = 1e-6
"""At rest: kinetic energy below this share of its peak for one first period, after the shaking."""


WORST, FIRST = "the larger of both", "the earlier of both"
OUTPUTS = (
    *by_body(
        "peak_rotation", "max |theta|", "rad", "largest absolute rotation", "pi/2 when overturned", WORST, "largest"
    ),
    *by_body(
        "peak_rotation_ratio", "max |theta| / alpha", "1", "largest absolute rotation over the slenderness angle",
        "alpha of both as one body for the wall, of the upper block alone for the upper block", WORST, "largest",
    ),
    *peaks_by_body("peak_velocity", "max |theta'|", "rad s-1", "largest absolute angular velocity", "rotation_rate"),
    *by_joint("uplift_duration", "t_up", "s", "time for which the joint is up", UP, WORST, "total"),
    *by_joint("onset_time", "t_on", "s", "time of the first uplift", f"nan when it never lifts; {UP}", FIRST, "first"),
    *by_joint(
        "minimum_contact", "min l/2b", "1", "smallest share of the joint in contact", UP, "the smaller of both", "least"
    ),
    *by_body("overturned", "", "1", "whether it overturned", OVERTURNED, "one of them", "largest", "bool"),
    *by_body(
        "overturning_time", "t_ov", "s", "time of overturning", f"nan when it stands; {OVERTURNED}", FIRST, "first"
    ),
    *by_joint(
        "impacts", "n", "1", "number of closings", "every return to full contact counts", WORST, "total", "int32"
    ),
    *by_body(
        "residual_rotation", "theta_end", "rad", "rotation at the end", "signed pi/2 when overturned", WORST, "last"
    ),
    *by_joint("dissipated_energy", "E_d", "J", "energy lost in the layer", LOST, "in all", "total"),
    *by_joint(
        "peak_strain", "max u/e", "1", "largest compression of the joint's edge over the layer's thickness",
        "(compression + b |sin r|)/e at the steps, of an overturned wall that of the fall; above 1 the layer would be "
        "compressed beyond its own thickness; nan for a bonded joint", WORST, "largest",
    ),
    *by_joint(
        "friction_demand", "max |H|/N", "1", "largest ratio of the forces along and across the joint",
        "nan for a bonded joint; inf when the joint opens completely: the model holds it laterally all the same", WORST,
        "largest",
    ),
    Quantity("status", "", "1", "what became of the run", STATUS_RULE, "int8", over_parts="last"),
)  # fmt: skip


TANGENT = "with the slope of the rubber's law on unloading from rest, a Maxwell arm as stiff as at once"
MODES = range(1, 5)
DERIVED = (
    Quantity("alpha", "alpha", "rad", "slenderness angle of both as one body"),
    Quantity("alpha_2", "alpha_2", "rad", "slenderness angle of the upper block"),
    Quantity("static_compression_base", "-z_1", "m", "compression of the base layer at rest"),
    Quantity("static_compression_top", "-z_2", "m", "compression of the top layer at rest"),
    Quantity(
        "uplift_rotation", "theta_u", "rad", "rotation at which the base begins to lift, turned slowly", "nan if bonded"
    ),
    *(
        Quantity(f"frequency_{k}", f"f_{k}", "Hz", f"natural frequency {k} at rest, gravity included", TANGENT)
        for k in MODES
    ),
    *(
        Quantity(f"modal_damping_{k}", f"xi_{k}", "1", f"damping ratio of mode {k} at rest, of the dashpots", TANGENT)
        for k in MODES
    ),
    *(
        Quantity(f"mode_{k}_{name}", f"phi_{k}", "1", f"{name} in mode {k}; largest component 1, rotations times b_1")
        for k in MODES
        for name in ("rotation_1", "rotation_2", "compression_base", "compression_top")
    ),
    Quantity("base_damping_used", "c_b", "N s m-2", "dashpot of the base layer"),
    Quantity("top_damping_used", "c_t", "N s m-2", "dashpot of the top layer"),
)

OBSERVABLES = (
    Quantity("rotation_1", "theta_1", "rad", "rotation of the wall against the base, clockwise positive"),
    Quantity("rotation_2", "theta_2", "rad", "rotation of the upper block against the base"),
    Quantity("rotation_rate_1", "theta_1'", "rad s-1", "angular velocity of the wall"),
    Quantity("rotation_rate_2", "theta_2'", "rad s-1", "angular velocity of the upper block"),
    Quantity("displacement_1_x", "x_1", "m", "horizontal displacement of the wall's mass centre against the base"),
    Quantity("displacement_2_x", "x_2", "m", "horizontal displacement of the upper block's mass centre"),
    Quantity("compression_base", "-z_1", "m", "compression of the base layer at its middle"),
    Quantity("compression_top", "-z_2", "m", "compression of the top layer at its middle"),
    Quantity("contact_1", "", "1", "share of the base in contact"),
    Quantity("contact_2", "", "1", "share of the top joint in contact"),
)
STATES = (
    "rotation_1", "rotation_2", "displacement_z_1", "displacement_z_2",
    "rotation_rate_1", "rotation_rate_2", "velocity_z_1", "velocity_z_2",
)  # fmt: skip
"""A state at t = 0: what is not given has its value at rest."""
