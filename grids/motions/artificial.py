"""Artificial motions compatible with the elastic spectrum of Eurocode 8, by seed.

artificial = { spectrum = "EC8", type = 1, ground = "B", pga = "0.2 g", seed = 1 }

The horizontal pseudo-acceleration of each motion is within 10 % of the spectrum at every period from 0.05 to
4 s (`MATCHED`; checked when it is made), at the damping asked for. Its PGA is the anchor a_g S itself; it
starts and ends at rest, last velocity and displacement zero, and has no vertical component. Equal tables give
equal samples, bit for bit; the shape does not depend on the PGA.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import lru_cache
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from grids.files import Schema, check
from grids.motions.base import Motion
from grids.motions.eurocode8 import GROUNDS, ElasticSpectrum
from grids.motions.matching import MATCHED, match
from grids.motions.spectrum import response_spectrum
from grids.units import STANDARD_GRAVITY, to_si
from models.errors import InputError, nearest

FloatArray = NDArray[np.float64]

TOLERANCE = 0.10
CHECKED = 150
"""Periods of `MATCHED` at which a motion is checked, evenly spaced on a logarithmic axis."""
DURATIONS = (12.0, 60.0)
"""s: shorter ones hold too few cycles of the longest period."""
STEPS = (0.002, 0.01)
"""s: five samples in the shortest period at least."""
DAMPINGS = (0.03, 0.30)


class Artificial(Schema):
    """The table ``artificial = {...}`` of a plan; several seeds are several motions."""

    spectrum: Literal["EC8"]
    type: int
    ground: str
    pga: str | float
    damping: str | float = 0.05
    duration: str | float = 20.0
    step: str | float = 0.005
    seed: int | list[int]
    name: str | None = None


def one_by_one(table: Mapping[str, Any]) -> list[dict[str, Any]]:
    """The same table once for each of its seeds."""
    seeds = table.get("seed")
    if not isinstance(seeds, list):
        return [dict(table)]
    if not seeds:
        raise InputError("artificial: seed is an empty list; give at least one seed.")
    if twice := [seed for k, seed in enumerate(seeds) if seed in seeds[:k]]:
        raise InputError(f"artificial: seed {twice[0]!r} is given twice; leave one out.")
    return [{**table, "seed": seed} for seed in seeds]


def make_artificial(table: Mapping[str, Any]) -> Motion:
    """The motion of one seed. Raises InputError.

    ``type`` 1 or 2, ``ground`` A to E, ``pga`` (a_g S, the spectrum at zero period), ``damping`` (3 to 30 %),
    ``duration`` (12 to 60 s; half of it is stationary: 20 s hold the 10 s of EN 1998-1, 3.2.3.1.2),
    ``step`` (2 to 10 ms), ``seed``, ``name``.
    """
    try:
        asked = check(Artificial, dict(table))
    except InputError as error:
        raise InputError(f"artificial: {error}") from None
    if asked.type not in GROUNDS:
        raise InputError(f"artificial: type is {asked.type}: give 1 (magnitude above 5.5) or 2")
    if asked.ground not in GROUNDS[1]:
        special = " (S1 and S2 need a study of their own)" if asked.ground in ("S1", "S2") else ""
        raise InputError(f"artificial: ground is {asked.ground!r}{special}; {nearest(asked.ground, GROUNDS[1])}")
    if isinstance(asked.seed, list) or asked.seed < 0:
        raise InputError(f"artificial: seed is {asked.seed!r}: give one whole number from 0 on for one motion")
    pga = to_si(asked.pga, "m s-2", "artificial: pga")
    if not 0.0 < pga < math.inf:
        raise InputError(f"artificial: pga is {asked.pga!r}: give a positive finite value in m s-2 or g")
    damping = _within(asked.damping, "1", "damping", DAMPINGS)
    step = _within(asked.step, "s", "step", STEPS)
    duration = _within(asked.duration, "s", "duration", DURATIONS)
    count = round(duration / step)
    if abs(count * step - duration) > 1e-6 * step:
        raise InputError(f"artificial: step {step:g} s does not divide the duration of {duration:g} s")
    shape, departure = _shape(asked.type, asked.ground, damping, step, count + 1, asked.seed)
    name = asked.name or f"EC8 type {asked.type} {asked.ground}, {pga / STANDARD_GRAVITY:.4g} g"
    return Motion(
        f"{name}, seed {asked.seed}",
        step,
        pga * shape,
        components={"horizontal": "artificial"},
        source={
            "format": "artificial",
            "spectrum": "EN 1998-1:2004, 3.2.2.2, horizontal elastic",
            "type": asked.type,
            "ground": asked.ground,
            "soil_factor": GROUNDS[asked.type][asked.ground].soil_factor,
            "damping": damping,
            "seed": asked.seed,
            "matched_periods": f"{MATCHED[0]:g} to {MATCHED[1]:g} s",
            "largest_departure": departure,
        },
        notes=(f"within {departure:.1%} of the spectrum from {MATCHED[0]:g} to {MATCHED[1]:g} s",),
    )


def target_of(motion: Motion) -> ElasticSpectrum | None:
    """The spectrum an artificial motion was made for, at its present PGA; None for others and once it was changed."""
    source = motion.source
    if source.get("format") != "artificial" or not all(note.startswith(("within", "scaled")) for note in motion.notes):
        return None
    return ElasticSpectrum(source["type"], source["ground"], motion.pga, source["damping"])


def _within(value: str | float, unit: str, key: str, limits: tuple[float, float]) -> float:
    number = to_si(value, unit, f"artificial: {key}")
    low, high = limits
    if not low <= number <= high:
        shown = "" if unit == "1" else f" {unit}"
        raise InputError(f"artificial: {key} is {value!r}: give a value from {low:g} to {high:g}{shown}")
    return number


@lru_cache(maxsize=64)
def _shape(type: int, ground: str, damping: float, step: float, size: int, seed: int) -> tuple[FloatArray, float]:
    """The motion over its peak, and its largest departure from the spectrum."""
    spectrum = ElasticSpectrum(type, ground, 1.0, damping)
    shape = match(spectrum, damping, step, size, seed)
    periods = np.geomspace(*MATCHED, CHECKED)
    reached = response_spectrum(shape, step, periods, damping).pseudo_acceleration / spectrum(periods)
    worst = int(np.argmax(np.abs(reached - 1.0)))
    departure = float(abs(reached[worst] - 1.0))
    if departure > TOLERANCE:
        raise InputError(
            f"artificial: seed {seed} misses the spectrum by {departure:.0%} at {periods[worst]:.2g} s: "
            "take another seed or a longer duration"
        )
    shape.flags.writeable = False
    return shape, departure
