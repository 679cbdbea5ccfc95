"""What the one-block model takes and gives: the source for docs, checks and cube labels."""

from __future__ import annotations

import numpy as np

from models.base import Parameter, Quantity
from models.peaks import AT_SAMPLES

PARAMETERS = (
    Parameter("width", "2b", "m", "width of the base", 0.0, low_open=True),
    Parameter("height", "2h", "m", "height of the block", 0.0, low_open=True),
    Parameter("aspect_ratio", "b/h", "1", "width over height", 0.0, low_open=True),
    Parameter("mass", "m_1", "kg", "mass of the block, without the mass on top", 0.0),
    Parameter(
        "inertia",
        "I_1",
        "kg m2",
        "moment of inertia of the block about its own centre (default: solid rectangle)",
        0.0,
        default=np.nan,
    ),
    Parameter("top_mass", "m_2", "kg", "mass on top, moving with the block as one body", 0.0, default=0.0),
    Parameter("top_mass_height", "h_2", "m", "centre of the top mass above the top of the block", 0.0, default=0.0),
    Parameter(
        "top_mass_inertia", "I_2", "kg m2", "moment of inertia of the top mass about its own centre", 0.0, default=0.0
    ),
    Parameter(
        "restitution",
        "e",
        "1",
        "given ratio of angular velocities at impact (default: angular momentum)",
        0.0,
        1.0,
        default=np.nan,
        low_open=True,
    ),
    Parameter(
        "restitution_aspect_coefficient",
        "c_a",
        "1",
        "e = e_H [1 - c_a (b/h)^2] (theta_prev/theta_max)^c_t; form and coefficients are this project's, "
        "after the description in words of Mordant, Dietz, Degee (COMPDYN 2013)",
        -10.0,
        10.0,
        default=0.0,
    ),
    Parameter(
        "restitution_amplitude_exponent",
        "c_t",
        "1",
        "exponent of (peak before this impact / largest peak so far) in the same law",
        0.0,
        10.0,
        default=0.0,
    ),
    Parameter("gravity", "g", "m s-2", "acceleration of gravity", 0.0, default=9.80665, low_open=True),
)

ALTERNATIVES = ((("width", "height"), ("height", "aspect_ratio")),)

OPTIONS = {"formulation": ("nonlinear", "linear")}

OVERTURNED = (
    "overturned when |theta| reaches pi/2, or, once the shaking has ended, when |theta| exceeds alpha "
    "while the velocity and the acceleration both point outwards"
)
MOST_IMPACTS_PER_STEP = 200
REST_VELOCITY = 4.5e-3
"""|theta'| over p alpha below which an impact ends in rest: the swing ahead is 1e-5 alpha."""
AT_REST = (
    f"at rest after an impact with |theta'| under {REST_VELOCITY:g} p alpha (a swing of 1e-5 alpha) "
    "until |a| exceeds G tan(alpha) again"
)

OUTPUTS = (
    Quantity(
        "peak_rotation", "max |theta|", "rad", "largest absolute rotation", "pi/2 when overturned", over_parts="largest"
    ),
    Quantity(
        "peak_rotation_ratio",
        "max |theta| / alpha",
        "1",
        "largest absolute rotation over the slenderness angle",
        "(pi/2)/alpha when overturned",
        over_parts="largest",
    ),
    Quantity(
        "peak_velocity",
        "max |theta'|",
        "rad s-1",
        "largest absolute angular velocity",
        AT_SAMPLES,
        peak_of=("rotation_rate_1",),
        over_parts="largest",
    ),
    Quantity(
        "uplift_duration",
        "t_up",
        "s",
        "time spent rocking",
        f"up while it rocks; {AT_REST}; counted to overturning",
        over_parts="total",
    ),
    Quantity("onset_time", "t_on", "s", "time of the first uplift", "nan when it never rocks", over_parts="first"),
    Quantity("overturned", "", "1", "whether the block overturned", OVERTURNED, "bool", over_parts="largest"),
    Quantity(
        "overturning_time", "t_ov", "s", "time of overturning", f"nan when it stands; {OVERTURNED}", over_parts="first"
    ),
    Quantity("impacts", "n", "1", "number of impacts", "every change of pivot counts", "int32", over_parts="total"),
    Quantity(
        "residual_rotation",
        "theta_end",
        "rad",
        "rotation at the end of the run",
        "0 at rest; signed pi/2 when overturned",
        over_parts="last",
    ),
    Quantity(
        "dissipated_energy",
        "E_d",
        "J",
        "energy lost at impacts and in couples",
        "counted to overturning",
        over_parts="total",
    ),
    Quantity(
        "friction_demand",
        "max |H|/N",
        "1",
        "largest friction demand while rocking",
        "0 when it never rocks; inf when N <= 0, that is when the block would leave the ground; impulses not included",
        over_parts="largest",
    ),
    Quantity(
        "status",
        "",
        "1",
        "what became of the run",
        f"not_converged: more than {MOST_IMPACTS_PER_STEP} impacts within one step",
        dtype="int8",
        over_parts="last",
    ),
)


DERIVED = (
    Quantity("alpha", "alpha", "rad", "slenderness angle of the side that tips first"),
    Quantity("radius", "R", "m", "distance from pivot to mass centre"),
    Quantity("frequency_parameter", "p", "s-1", "p = sqrt(M g R / I_O)"),
    Quantity("restitution_coefficient", "e", "1", "ratio of angular velocities at an impact at rest amplitude"),
    Quantity("onset_acceleration", "g tan(alpha)", "m s-2", "horizontal acceleration that starts rocking"),
)

OBSERVABLES = (
    Quantity("rotation_1", "theta", "rad", "rotation of the block against the base, clockwise positive"),
    Quantity("rotation_rate_1", "theta'", "rad s-1", "angular velocity of the block"),
    Quantity("displacement_1_x", "x_1", "m", "horizontal displacement of the mass centre against the base"),
    Quantity("contact_1", "", "1", "share of the base in contact: 1 at rest, 0 while rocking"),
)
STATES = ("rotation_1", "rotation_rate_1")

RESUMES_WITH = (
    "vertical_acceleration", "pivot_inset", "rounded_corner", "crushing", "tilt", "eccentricity", "flexible_joint",
    "added_stiffness", "restitution", "velocity_restitution", "viscous_damping", "coulomb_damping",
    "quadratic_damping", "table_pitch", "degradation", "table_force",
)  # fmt: skip
"""Not: sliding, bounce and wall_flexibility (motions of their own)."""
