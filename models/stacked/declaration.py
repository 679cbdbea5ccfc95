"""What the model of two stacked blocks takes and gives: the source for docs, checks and cube labels."""

from __future__ import annotations

import numpy as np

from models import walls
from models.base import Parameter, Quantity
from models.stacked.configuration import NAMES
from models.walls import by_body, by_joint, peaks_by_body

PARAMETERS = (
    *walls.PARAMETERS,
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
)  # fmt: skip

ALTERNATIVES = walls.ALTERNATIVES

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
WORST = "the larger of both"
OUTPUTS = (
    *by_body(
        "peak_rotation", "max |theta|", "rad", "largest absolute rotation", "pi/2 when overturned", WORST, "largest"
    ),
    *by_body(
        "peak_rotation_ratio", "max |theta| / alpha", "1", "largest absolute rotation over the slenderness angle",
        "alpha of both as one body for the wall, of the upper block alone for the upper block", WORST, "largest",
    ),
    *peaks_by_body("peak_velocity", "max |theta'|", "rad s-1", "largest absolute angular velocity", "rotation_rate"),
    *by_joint(
        "uplift_duration", "t_up", "s", "time for which the joint is up", f"{AT_REST}; counted to overturning", WORST,
        "total",
    ),
    *by_joint(
        "onset_time", "t_on", "s", "time of the first uplift", "nan when it never rocks", "the earlier of both", "first"
    ),
    *by_body("overturned", "", "1", "whether it overturned", OVERTURNED, "one of them", "largest", "bool"),
    *by_body(
        "overturning_time", "t_ov", "s", "time of overturning", f"nan when it stands; {OVERTURNED}",
        "the earlier of both", "first",
    ),
    *by_joint("impacts", "n", "1", "number of impacts", "every closing of the joint counts", WORST, "total", "int32"),
    *by_body(
        "residual_rotation", "theta_end", "rad", "rotation at the end of the run", "signed pi/2 when overturned", WORST,
        "last",
    ),
    *by_joint(
        "dissipated_energy", "E_d", "J", "energy lost",
        "at impacts, and at the base in couples; counted to overturning", "in all", "total",
    ),
    *by_joint(
        "friction_demand", "max |H|/N", "1", "largest friction demand while the stack rocks",
        "0 when it never rocks; inf when N <= 0; impulses not included", WORST, "largest",
    ),
    Quantity(
        "configurations", "", "1", "configurations visited, as a bit mask",
        "bits " + ", ".join(f"{1 << k}: {name}" for k, name in enumerate(NAMES)), "int16",
        over_parts="bits",
    ),
    *(
        Quantity(
            f"time_in_{name}", "t", "s", f"time in {name.replace('_', ' ')}",
            "patterns: 1 both rock to one side, 2 to opposite sides, 3 as one body, 4 only the upper block; right or "
            "left: the corner of the lowest joint that is up; counted to overturning", over_parts="total",
        )
        for name in NAMES
    ),
    Quantity(
        "status", "", "1", "what became of the run",
        f"not_converged: more than {MOST_EVENTS_PER_STEP} events within one step", "int8",
        over_parts="last",
    ),
)  # fmt: skip


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
