"""What the model of two stacked blocks takes and gives: the source for docs, checks and cube labels."""

from __future__ import annotations

import numpy as np

from models.base import Parameter, Quantity
from models.stacked.configuration import CONFIGURATIONS, NAMES

PARAMETERS = (
    Parameter("wall_length", "2b_1", "m", "length of the wall", 0.0, low_open=True),
    Parameter("wall_height", "2h_1", "m", "height of the wall", 0.0, low_open=True),
    Parameter("aspect_ratio", "b_1/h_1", "1", "length over height of the wall", 0.0, low_open=True),
    Parameter(
        "wall_thickness", "t", "m", "thickness of the wall, needed with wall_density", 0.0,
        default=np.nan, low_open=True,
    ),
    Parameter("wall_density", "rho", "kg m-3", "density of the wall", 0.0, low_open=True),
    Parameter("wall_mass", "m_1", "kg", "mass of the wall", 0.0, low_open=True),
    Parameter("top_mass", "m_2", "kg", "mass of the block on top", 0.0, low_open=True),
    Parameter(
        "top_length", "2b_2", "m",
        "length of the block on top; the joint is as long as the shorter of block and wall", 0.0, low_open=True,
    ),
    Parameter("top_height", "2h_2", "m", "height of the block on top", 0.0, low_open=True),
    Parameter(
        "base_restitution", "e_b", "1",
        "given ratio of theta_1' over an impact at the base (default: projection in the kinetic metric)",
        0.0, 1.0, default=np.nan,
    ),
    Parameter(
        "top_restitution", "e_t", "1",
        "given ratio of theta_2' - theta_1' over an impact at the top joint (default: projection)",
        0.0, 1.0, default=np.nan,
    ),
    Parameter("gravity", "g", "m s-2", "acceleration of gravity", 0.0, default=9.80665, low_open=True),
)  # fmt: skip

ALTERNATIVES = (
    (("wall_length", "wall_height"), ("wall_height", "aspect_ratio")),
    (("wall_density",), ("wall_mass",)),
)

OPTIONS = {"formulation": ("nonlinear", "linear")}

OVERTURNED = (
    "overturned when |theta| of a body reaches pi/2, or, once the shaking has ended, when its mass centre has "
    "passed over the pivot it stands on, it turns outwards and the energy is below that of its balance there; "
    "with the wall overturns what stands on it"
)
REST_VELOCITY = 4.5e-3
"""Relative angular velocity over p alpha below which a joint stays closed after an impact."""
AT_REST = (
    f"a joint stays closed after an impact with a relative angular velocity under {REST_VELOCITY:g} p alpha "
    "(a swing of 1e-5 alpha; p and alpha of both as one body at the base, of the upper block at the top) "
    "unless the forces open it at once"
)
MOST_EVENTS_PER_STEP = 200


def _body(name: str, symbol: str, unit: str, meaning: str, rule: str, plain: str, kind: str = "float64") -> list[Quantity]:
    """The plain quantity and one for each body."""
    return [
        Quantity(name, symbol, unit, f"{meaning}, {plain}", rule, dtype=kind),
        Quantity(f"{name}_1", f"{symbol}_1", unit, f"{meaning}, of the wall", rule, dtype=kind),
        Quantity(f"{name}_2", f"{symbol}_2", unit, f"{meaning}, of the upper block", rule, dtype=kind),
    ]


def _joint(name: str, symbol: str, unit: str, meaning: str, rule: str, plain: str, kind: str = "float64") -> list[Quantity]:
    """The plain quantity and one for each joint."""
    return [
        Quantity(name, symbol, unit, f"{meaning}, {plain}", rule, dtype=kind),
        Quantity(f"{name}_base", f"{symbol}_b", unit, f"{meaning}, at the base", rule, dtype=kind),
        Quantity(f"{name}_top", f"{symbol}_t", unit, f"{meaning}, at the top joint", rule, dtype=kind),
    ]


WORST = "the larger of both"
OUTPUTS = (
    *_body("peak_rotation", "max |theta|", "rad", "largest absolute rotation", "pi/2 when overturned", WORST),
    *_body(
        "peak_rotation_ratio", "max |theta| / alpha", "1", "largest absolute rotation over the slenderness angle",
        "alpha of both as one body for the wall, of the upper block alone for the upper block", WORST,
    ),
    *_joint("uplift_duration", "t_up", "s", "time for which the joint is up", f"{AT_REST}; counted to overturning", WORST),
    *_joint("onset_time", "t_on", "s", "time of the first uplift", "nan when it never rocks", "the earlier of both"),
    *_body("overturned", "", "1", "whether it overturned", OVERTURNED, "one of them", "bool"),
    *_body("overturning_time", "t_ov", "s", "time of overturning", f"nan when it stands; {OVERTURNED}", "the earlier of both"),
    *_joint("impacts", "n", "1", "number of impacts", "every closing of the joint counts", WORST, "int32"),
    *_body("residual_rotation", "theta_end", "rad", "rotation at the end of the run", "signed pi/2 when overturned", WORST),
    *_joint(
        "dissipated_energy", "E_d", "J", "energy lost", "at impacts, and at the base in couples; counted to overturning",
        "in all",
    ),
    *_joint(
        "needed_friction", "max |H|/N", "1", "largest friction demand while the stack rocks",
        "0 when it never rocks; inf when N <= 0; impulses not included", WORST,
    ),
    Quantity(
        "configurations", "", "1", "configurations visited, as a bit mask",
        "bits " + ", ".join(f"{1 << k}: {name}" for k, name in enumerate(NAMES)), dtype="int16",
    ),
    *(
        Quantity(
            f"time_in_{name}", "t", "s", f"time in {name.replace('_', ' ')}",
            "patterns: 1 both rock to one side, 2 to opposite sides, 3 as one body, 4 only the upper block; right or "
            "left: the corner of the lowest joint that is up; counted to overturning",
        )
        for name in NAMES[: len(CONFIGURATIONS)]
    ),
    Quantity(
        "status", "", "1", "what became of the run",
        f"not_converged: more than {MOST_EVENTS_PER_STEP} events within one step", dtype="int8",
    ),
)  # fmt: skip

STATUS = ("not_run", "rest", "rocking", "overturned", "not_converged", "failed")
"""Values 0..5 of ``status``; the same words in every model."""

DERIVED = (
    Quantity("alpha", "alpha", "rad", "slenderness angle of both as one body"),
    Quantity("alpha_2", "alpha_2", "rad", "slenderness angle of the upper block"),
    Quantity("radius", "R", "m", "distance from the base pivot to the mass centre of both"),
    Quantity("frequency_parameter", "p", "s-1", "p = sqrt(M g R / I_O) of both as one body"),
    Quantity("frequency_parameter_2", "p_2", "s-1", "p of the upper block on a base of its own"),
    Quantity("restitution_coefficient", "e", "1", "ratio of angular velocities at an impact as one body"),
    Quantity("onset_acceleration", "a_on", "m s-2", "horizontal acceleration that starts rocking: the smaller of both"),
    Quantity("onset_acceleration_base", "a_on,b", "m s-2", "horizontal acceleration that lifts both as one body"),
    Quantity("onset_acceleration_top", "a_on,t", "m s-2", "horizontal acceleration that lifts the upper block"),
)

OBSERVABLES = (
    Quantity("rotation_1", "theta_1", "rad", "rotation of the wall against the base, clockwise positive"),
    Quantity("rotation_2", "theta_2", "rad", "rotation of the upper block against the base"),
    Quantity("rotation_rate_1", "theta_1'", "rad s-1", "angular velocity of the wall"),
    Quantity("rotation_rate_2", "theta_2'", "rad s-1", "angular velocity of the upper block"),
    Quantity("displacement_1_x", "x_1", "m", "horizontal displacement of the wall's mass centre against the base"),
    Quantity("displacement_2_x", "x_2", "m", "horizontal displacement of the upper block's mass centre"),
    Quantity("contact_1", "", "1", "share of the base in contact: 1 closed, 0 while up"),
    Quantity("contact_2", "", "1", "share of the top joint in contact: 1 closed, 0 while up"),
)
STATES = ("rotation_1", "rotation_rate_1", "rotation_2", "rotation_rate_2")
