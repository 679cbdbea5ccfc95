"""What a plan or specimen says that may be right but is more likely a slip: a wrong unit, a point too far left.

Each suspicion is a sentence with the value and what is usual. Nothing is refused here; commands print
suspicions as warnings, or refuse them with ``--strict``.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Iterator, Mapping

import numpy as np

import models
from grids.plan import Plan
from grids.recordings.base import REQUIRED, Recording
from grids.recordings.outcomes import Outcomes
from grids.specimen import Specimen, state_unit
from grids.targets import SCALES
from grids.units import with_unit
from models.kinematics import Place

GRAVITY = 9.80665
USUAL: Mapping[str, tuple[float, float]] = {
    "width": (0.05, 60.0),
    "length": (0.05, 60.0),
    "height": (0.1, 60.0),
    "wall_thickness": (0.02, 5.0),
    "layer_thickness": (5e-4, 0.3),
    "rubber_thickness": (5e-3, 1.0),
    "layer_modulus": (1e5, 1e9),
    "density": (200.0, 1e4),
    "mass": (0.05, 1e8),
    "gravity": (1.0, 30.0),
    "pga": (0.0, 5.0 * GRAVITY),
    "time_scale": (0.1, 10.0),
}
"""Usual values (SI) of what a name ends in; zero is always allowed."""
USUAL_TOLERANCE = 0.3
FAR = 2.0
"""Largest sides of a specimen, from the middle of a body's underside, beyond which no arm carries an instrument."""
SMALL_PGA = 2.0
"""m s-2: a PGA axis of plain numbers up to here reads like one in g."""


def suspicions_of_plan(plan: Plan) -> tuple[str, ...]:
    """Sentences about values of a plan that are unusual, axes included."""
    varied = {name: values for axis in plan.axes for name, values in axis.sets.items() if values.dtype.kind in "iuf"}
    values = {**{name: np.array([value]) for name, value in plan.fixed.items()}, **varied}
    found = [*_unusual(plan.model, values)]
    stated = tomllib.loads(plan.text)
    pga = varied.get("pga", np.array([plan.fixed.get("pga", np.nan)]))
    entry = stated.get("axes", {}).get("pga", stated.get("parameters", {}).get("pga"))
    plain = isinstance(entry, int | float) or (isinstance(entry, dict) and "unit" not in entry and _numbers(entry))
    if plain and 0.0 < pga.max() <= SMALL_PGA:
        found.append(
            f"pga goes to {pga.max():.3g} m s-2 ({pga.max() / GRAVITY:.2g} g) and has no unit: was g meant? "
            "Say unit = 'g' or unit = 'm/s^2'."
        )
    factor = float(np.max(varied.get("motion_scale", np.array([plan.fixed.get("motion_scale", 1.0)]))))
    for motion in plan.motions:
        found += suspicions_of_peak(f"motion {motion.name}", motion.pga)
        if factor != 1.0 and motion.pga <= USUAL["pga"][1]:
            found += suspicions_of_peak(f"motion {motion.name} times motion_scale {factor:g}", factor * motion.pga)
    return tuple(found)


def suspicions_of_peak(what: str, pga: float) -> tuple[str, ...]:
    """A sentence about a motion whose largest acceleration (m s-2) is unusual."""
    most = USUAL["pga"][1]
    if pga <= most:
        return ()
    return (
        f"{what} peaks at {pga / GRAVITY:.3g} g (usual: up to {most / GRAVITY:g} g); are its unit and its scale right?",
    )


def suspicions_of_recordings(recordings: Iterable[Recording]) -> tuple[str, ...]:
    """Sentences about recordings whose base moves unusually."""
    peaks = [(one.name, float(np.max(np.abs(one.channels[REQUIRED])))) for one in recordings]
    return tuple(said for name, peak in peaks for said in suspicions_of_peak(f"recording {name}", peak))


def suspicions_of_outcomes(outcomes: Outcomes) -> tuple[str, ...]:
    """A sentence about the run whose motion is the strongest, if that is unusual: a unit is wrong in all alike."""
    run, most = max(zip(outcomes.runs, outcomes.motions, strict=True), key=lambda both: both[1].pga)
    return suspicions_of_peak(f"{outcomes.name}: the motion of run '{run}'", most.pga)


def suspicions_of_specimen(specimen: Specimen) -> tuple[str, ...]:
    """Sentences about values of a specimen that are unusual, tolerances and initial state included."""
    found = [*_unusual(specimen.model, {name: np.array([value]) for name, value in specimen.parameters.items()})]
    found += [
        f"[tolerance] {name} = {100 * value:.3g} %: unusually wide; a tolerance is relative, 0.005 for 0.5 %."
        for name, value in specimen.tolerance.items()
        if value > USUAL_TOLERANCE
    ]
    model = models.get(specimen.model)
    found += [
        f"[initial] {name} = {np.degrees(value):.4g} deg: such a body lies on its side; is the unit right?"
        for name, value in specimen.initial.items()
        if state_unit(model, name, name) == "rad" and abs(value) >= np.pi / 2
    ]
    return (*found, *suspicions_of_places(specimen, specimen.places))


def suspicions_of_places(specimen: Specimen, places: Mapping[str, Place]) -> tuple[str, ...]:
    """Sentences about channels that lie far outside the bodies of a specimen."""
    largest_of = {**specimen.parameters, **{name: high for name, (_, high) in specimen.calibrate.items()}}
    sides = [
        value for name, value in largest_of.items() if "." not in name and name.endswith(("width", "length", "height"))
    ]
    if not sides:
        return ()
    largest = max(sides) * max(1.0, largest_of.get("aspect_ratio", 0.0))  # width or length over height
    return tuple(
        f"channel {name} lies {np.hypot(place.x, place.z):.3g} m from the middle of its body's underside, and the "
        f"longest side is {largest:.3g} m: is the unit of its position right ('-200 mm')?"
        for name, place in places.items()
        if np.hypot(place.x, place.z) > FAR * largest
    )


def suspicions_of_stages(specimen: Specimen, lengths: Mapping[str, float], alone: bool = False) -> tuple[str, ...]:
    """Sentences about stages that fit none of the recordings, of ``lengths`` (s) by name.

    ``alone``: one recording of a series is looked at, whose others may be named too.
    """
    staged = [(name, n, stage) for name, stages in specimen.stages.items() for n, stage in enumerate(stages, 1)]
    if alone and any(stage.recording in lengths for *_, stage in staged):
        staged = [one for one in staged if one[2].recording in lengths]
    found = []
    for name, number, stage in staged:
        where = f"[[mechanisms.{name}.stages]] {number}"
        if stage.recording not in lengths:  # any other recording is as after the last stage
            if slips := [name for name in lengths if _letters(name) == _letters(stage.recording)]:
                found.append(
                    f"{where}: recording = '{stage.recording}' is none of the recordings given; did you mean "
                    f"'{slips[0]}'?"
                )
            continue
        length = lengths[stage.recording]
        late = {
            key: time for key, time in (("begins", stage.begins), ("ends", stage.ends)) if 1.01 * length < time < np.inf
        }
        found += [
            f"{where}: {key} = {time:g} s lies after the end of recording {stage.recording} ({length:.4g} s); is the "
            "unit right ('4210 ms')?"
            for key, time in [*late.items()][:1]
        ]
    return tuple(found)


def _letters(name: str) -> str:
    """A name without what a slip leaves out or turns: its letters and digits in lower case."""
    return "".join(c for c in name.lower() if c.isalnum())


def _unusual(model: str, values: Mapping[str, np.ndarray]) -> Iterator[str]:
    units = {p.name: p.unit for p in (*models.get(model).parameters, *SCALES)}
    for name, given in values.items():
        usual = next((both for end, both in USUAL.items() if name.endswith(end)), None)
        if usual is None or name not in units:
            continue
        low, high = usual
        for value in _ends(given[given != 0.0]):
            if not low <= value <= high:
                word = "small" if value < low else "large"
                said, least, most = (with_unit(v, units[name]) for v in (value, low, high))
                yield f"{name} = {said} is unusually {word} (usual: {least} to {most}); is the unit right?"


def _ends(values: np.ndarray) -> Iterable[float]:
    return dict.fromkeys((float(values.min()), float(values.max()))) if values.size else ()


def _numbers(entry: Mapping[str, object]) -> bool:
    """Whether an axis is written in plain numbers."""
    return any(isinstance(value, list) and all(isinstance(v, int | float) for v in value) for value in entry.values())
