"""The paper's four walls, the models that try them, the motions, and what every model says.

What the paper does not print is illustrative: the sizes in the specimen files, and `INSET` and `MODIFIED` below.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import xarray as xr

import models
import rocking
from grids.motions import Motion
from grids.specimen import Specimen
from grids.units import STANDARD_GRAVITY as GRAVITY

HERE = Path(__file__).resolve().parent
TAIL = 4.0
"""s of free motion after the shaking."""
INSET = {"pivot_inset": {"inset_over_half_width": 0.1}}
MODIFIED = {"restitution_aspect_coefficient": 0.25, "restitution_amplitude_exponent": 0.1}
"""The paper gives neither the position of its moved pivots nor its restitution law's coefficients: both are ours."""
OF_RUBBER = ("layer_thickness", "layer_modulus", "damping_ratio")
OVERTURNED = 5
"""Flag of an event in a history."""


@dataclass(frozen=True)
class Wall:
    """A specimen of the paper: its file, the rubber its size was also tested with, and the PGA in g."""

    title: str
    file: str
    rubber: str
    pga: float


WALLS = {
    "short": Wall("Short wall, without rubber", "short.toml", "short_rubber.toml", 0.234),
    "long": Wall("Long wall, without rubber", "long.toml", "long_rubber.toml", 0.688),
    "short_rubber": Wall("Short wall, with rubber", "short_rubber.toml", "short_rubber.toml", 0.171),
    "long_rubber": Wall("Long wall, with rubber", "long_rubber.toml", "long_rubber.toml", 0.457),
}


@dataclass(frozen=True)
class Outcome:
    """What one model says of one wall under one motion."""

    peak: float
    """Largest rotation of the wall, mrad."""
    lifts: float
    """s at which the wall's base first opens; nan where it never does."""
    overturns: bool


def specimens(wall: Wall) -> dict[str, Specimen]:
    """The wall as each model sees it.

    One body: the paper's limit, all mass in a point at the top of the wall. The rigid models leave a rubber out;
    the models on rubber give a wall without one the rubber its size was tested with.
    """
    tested = rocking.read_specimen(HERE / wall.file)
    rubber = rocking.read_specimen(HERE / wall.rubber)
    stack = {name: value for name, value in tested.parameters.items() if name not in OF_RUBBER}
    block = {
        "height": stack["wall_height"],
        "aspect_ratio": stack["aspect_ratio"],
        "mass": 0.0,
        "top_mass": stack["top_mass"],
    }
    one = replace(tested, title=wall.title, model="housner", parameters=block)
    two = replace(one, model="stacked", parameters=stack)
    return {
        "Housner": one,
        "modified Housner": replace(one, parameters={**block, **MODIFIED}, mechanisms=INSET),
        "stacked": two,
        "modified stacked": replace(two, mechanisms=INSET),
        "on rubber": replace(rubber, title=wall.title),
        "on rubber, linear": replace(rubber, title=wall.title, model="interface_linear"),
    }


def shaking(wall: Wall, seed: int) -> Motion:
    """The artificial motion of a seed at the wall's PGA: Eurocode 8, type 2, ground B, our choice."""
    table = {"spectrum": "EC8", "type": 2, "ground": "B", "pga": f"{wall.pga} g", "seed": seed}
    return rocking.read_motion({"artificial": table})


def histories(wall: Wall, motion: Motion) -> dict[str, xr.Dataset]:
    """What every model says."""
    length = motion.duration + TAIL
    return {label: rocking.simulate(s, motion, duration=length) for label, s in specimens(wall).items()}


def outcome(history: xr.Dataset) -> Outcome:
    """The numbers of the tables."""
    up = history["time"].values[history["contact_1"].values < 1.0]
    return Outcome(
        peak=float(np.abs(history["rotation_1"]).max()) * 1e3,
        lifts=float(up[0]) if up.size else np.nan,
        overturns=bool((history["event_kind"] == OVERTURNED).any()),
    )


def outcomes(seeds: Iterable[int]) -> dict[str, dict[str, list[Outcome]]]:
    """Of each wall by each model, one for each seed."""
    found: dict[str, dict[str, list[Outcome]]] = {}
    for name, wall in WALLS.items():
        for seed in seeds:
            for label, history in histories(wall, shaking(wall, seed)).items():
                found.setdefault(name, {}).setdefault(label, []).append(outcome(history))
    return found


def cell(specimen: Specimen) -> dict[str, float]:
    """Parameters as the models take them, those of its mechanisms included."""
    own = {f"{name}.{key}": value for name, table in specimen.mechanisms.items() for key, value in table.items()}
    return {**specimen.parameters, **own}


def derived(specimen: Specimen) -> dict[str, float]:
    """What its model says before any shaking; ``onset_acceleration`` (g) and ``frequency_1`` (Hz) among it."""
    found = {key: float(value[0]) for key, value in models.get(specimen.model).derive(cell(specimen)).items()}
    if "onset_acceleration" in found:
        found["onset_acceleration"] /= GRAVITY
    return found
