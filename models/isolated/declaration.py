"""What the model of a building on rubber bearings takes and gives: docs, checks and cube labels."""

from __future__ import annotations

import numpy as np

from models.base import Parameter, Quantity
from models.peaks import AT_SAMPLES
from models.rubber import ELEMENTS, LAWS

MOST_LEVELS = 12
"""Longest chain."""
IN_SHEAR = tuple(name for name, law in ELEMENTS.items() if "isolated" in law.mechanism.acts)
"""Rubber laws that act in shear; a set has a direction, which both ways of shear have not."""
MODES = 4
"""Modes that a cube tells of."""

PARAMETERS = (
    Parameter(
        "levels", "n", "1", "number of levels, the slab above the bearings included; 1: a rigid body", 1.0,
        MOST_LEVELS, default=1.0,
    ),
    Parameter("total_mass", "m", "kg", "mass of all levels, shared equally", 0.0, low_open=True),
    Parameter("level_mass_1", "m_1", "kg", "mass of the slab above the bearings, level 1", 0.0, low_open=True),
    *(
        Parameter(
            f"level_mass_{j}", f"m_{j}", "kg", f"mass of level {j}, needed with level_mass_1 if there is such a level",
            0.0, default=np.nan, low_open=True,
        )
        for j in range(2, MOST_LEVELS + 1)
    ),
    Parameter(
        "storey_stiffness", "k_s", "N m-1", "shear stiffness of each storey, needed for more than one level", 0.0,
        default=np.nan, low_open=True,
    ),
    Parameter(
        "storey_damping", "c_s", "N s m-1", "dashpot of each storey, needed for more than one level", 0.0,
        default=np.nan,
    ),
    Parameter(
        "bearing_stiffness", "k_b", "N m-1", "shear stiffness of all bearings together, at small strain", 0.0,
        low_open=True,
    ),
    Parameter("bearing_damping", "c_b", "N s m-1", "dashpot of all bearings together", 0.0),
    Parameter(
        "rubber_thickness", "e", "m", "thickness of the rubber of a bearing, all layers; needed by laws of the strain",
        0.0, default=np.nan, low_open=True,
    ),
    Parameter(
        "gravity", "g", "m s-2", "acceleration of gravity; the bearings carry the weight, it has no effect in shear",
        0.0, default=9.80665, low_open=True,
    ),
)  # fmt: skip

ALTERNATIVES = ((("total_mass",), ("level_mass_1",)),)

OPTIONS: dict[str, tuple[str, ...]] = {
    "rubber_law": ("as_given", "linear", *(name for name in IN_SHEAR if name in LAWS))
}

CALM = 1e-6
"""At rest: kinetic energy below this share of its peak for one first period, after the shaking."""

OUTPUTS = (
    Quantity(
        "peak_bearing_displacement", "max |x_1|", "m", "largest absolute displacement of the bearings",
        over_parts="largest",
    ),
    Quantity(
        "peak_level_acceleration", "max |x_j'' + a|", "m s-2", "largest absolute acceleration of any level",
        over_parts="largest",
    ),
    Quantity(
        "peak_drift", "max |x_j - x_j-1|", "m", "largest absolute displacement of a level against the one below",
        "storeys only, without the bearings; 0 for one level", over_parts="largest",
    ),
    Quantity(
        "peak_velocity", "max |x_1'|", "m s-1", "largest absolute velocity of the bearings", AT_SAMPLES,
        peak_of=("bearing_velocity",), over_parts="largest",
    ),
    Quantity(
        "residual_displacement", "x_1,end", "m", "displacement of the bearings at the end of the run", over_parts="last"
    ),
    Quantity(
        "dissipated_energy", "E_d", "J", "energy lost in bearings and storeys",
        "work of the shaking on the masses less what is kinetic or stored at the end", over_parts="total",
    ),
    Quantity(
        "status", "", "1", "what became of the run",
        "nothing rocks or overturns here: rocking means that it moved; not_converged: the run diverged: a state that "
        "is not a number, a velocity beyond what the shaking's impulse can give, energy that nothing has given",
        dtype="int8", over_parts="last",
    ),
)  # fmt: skip

DERIVED = (
    Quantity("mass", "m", "kg", "mass of all levels"),
    *(
        Quantity(f"frequency_{k}", f"f_{k}", "Hz", f"natural frequency {k} at small strain", "nan: no such mode")
        for k in range(1, MODES + 1)
    ),
    *(
        Quantity(
            f"modal_damping_{k}", f"xi_{k}", "1", f"damping ratio of mode {k} at small strain",
            "from the diagonal of the modal damping matrix; nan: no such mode",
        )
        for k in range(1, MODES + 1)
    ),
)  # fmt: skip

OBSERVABLES = (
    Quantity("level_acceleration_x", "x_j'' + a", "m s-2", "absolute horizontal acceleration of a level"),
    Quantity("level_displacement_x", "x_j", "m", "horizontal displacement of a level against the base"),
    Quantity("bearing_displacement", "x_1", "m", "displacement of the bearings, to the right"),
    Quantity("bearing_velocity", "x_1'", "m s-1", "rate of the bearings' displacement"),
    Quantity("bearing_force", "F_1", "N", "force of all bearings, against a displacement to the right"),
)
BY_LEVEL = ("level_acceleration_x", "level_displacement_x")
STATES = ("bearing_displacement", "bearing_velocity")
"""A state at t = 0, all levels alike; the rubber has been held there for a long time."""
