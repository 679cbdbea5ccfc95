"""From the parameters a user gives to the coefficients of buildings on bearings."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from models.base import FloatArray, Values
from models.errors import InputError
from models.isolated.chain import Chain
from models.isolated.declaration import IN_SHEAR, MOST_LEVELS
from models.rubber import ELEMENTS

OF_THE_STRAIN = (*(name for name in IN_SHEAR if ELEMENTS[name].of_strain), "payne")


def complaints(values: Values) -> list[str]:
    """Sentences about values that describe no building."""
    found = []
    levels = np.asarray(values.get("levels", 1.0), dtype=np.float64)
    odd = (levels != np.round(levels)) | ~(levels >= 1.0) | (levels > MOST_LEVELS)
    if np.any(odd):
        return [f"levels is {float(levels[odd].flat[0]):g}: give a whole number from 1 to {MOST_LEVELS}"]
    most = int(levels.max())
    given = [j for j in range(1, MOST_LEVELS + 1) if f"level_mass_{j}" in values]
    if "total_mass" in values and given:
        found.append(f"level_mass_{given[0]} and total_mass are both given: give total_mass or the mass of every level")
    elif "total_mass" not in values:
        missing = [j for j in range(1, most + 1) if j not in given]
        if missing:
            found.append(f"levels is {most} and level_mass_{missing[0]} is missing: give it, or total_mass instead")
        elif given[-1] > most:
            found.append(f"level_mass_{given[-1]} is given but levels is {most}: leave it out, or raise levels")
    for name in ("storey_stiffness", "storey_damping"):
        if most > 1 and name not in values:
            found.append(f"levels is {most} and {name} is missing: give it, or 1 level for a rigid body")
        if "levels" not in values and name in values:
            found.append(f"{name} is given but levels is not: give levels, the slab included, or leave it out")
    return found


def assemble(values: Values, size: int) -> Chain:
    """The buildings of the parameters alone, without mechanisms; raises InputError."""
    if found := complaints(values):
        raise InputError("; ".join(found))
    shape = np.broadcast_shapes(*(np.shape(v) for v in values.values()), (size,))

    def value(name: str, default: float = np.nan) -> FloatArray:
        return np.broadcast_to(np.asarray(values.get(name, default), dtype=np.float64), shape).copy()

    levels = value("levels", 1.0).astype(np.int64)
    there = np.arange(1, MOST_LEVELS + 1) <= levels[:, None]
    if "total_mass" in values:
        masses = np.broadcast_to((value("total_mass") / levels)[:, None], there.shape)
    else:
        masses = np.stack([value(f"level_mass_{j}") for j in range(1, MOST_LEVELS + 1)], axis=1)
    return Chain(
        levels=levels,
        masses=np.where(there, masses, 0.0),
        storey_stiffness=value("storey_stiffness", 0.0),
        storey_damping=value("storey_damping", 0.0),
        stiffness=value("bearing_stiffness"),
        damping=value("bearing_damping"),
        thickness=value("rubber_thickness"),
    )


def complete(chain: Chain, options: Mapping[str, str]) -> Chain:
    """The buildings with the rubber law that ``options`` name; raises InputError."""
    strained = [name for name in OF_THE_STRAIN if chain.numbers(name)]
    if strained and np.any(np.isnan(chain.thickness)):
        raise InputError(f"{strained[0]} is a law of the strain and needs rubber_thickness (m): give it")
    for rubber_law, p in chain.rubber_laws:
        if refused := rubber_law.refusal(p):
            raise InputError(f"{rubber_law.name}.{refused}")
    law = options["rubber_law"]
    if law == "as_given":
        return chain
    if law != "linear" and chain.numbers(law) is None:
        raise InputError(f"the rubber law of the bearings is {law}; give its parameters, or rubber_law = 'linear'")
    return chain.without_laws(but=law)
