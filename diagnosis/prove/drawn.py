"""One concealed case, drawn by seed: the true specimen, how it is shaken, what is hidden in it, what is recorded.

The specimen is drawn within its tolerances and ranges, the motions are scaled so that it moves and stands, and effects
of the library get a size that changes a recording by a number of times its noise. Other parameters may stand for part
of such a change.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr

import models
from diagnosis.data.measured import identification_of
from diagnosis.fit.setup import measure
from diagnosis.fit.unknowns import of_specimen, values_of
from diagnosis.search.candidates import Candidate, candidates, firsts
from grids.motions import Motion
from grids.recordings.base import CHANNELS, Recording
from grids.specimen import Specimen, with_mechanism, with_values
from models.base import FloatArray
from models.errors import InputError
from models.shaking import Shaking
from study.history import ending, simulate_specimen

BASE = ("base_acceleration_x", "base_acceleration_z")
SCALES = np.geomspace(0.2, 8.0, 14)
"""Factors on a motion at which the specimen is tried."""
FEWEST = 4
"""Windows that a recording must give."""
REST = 2.0
"""s at rest before the motion: they tell what the sensors do by themselves."""
BASE_NOISE = 0.003
"""Of the accelerometer of the base, over the peak; the noise of all other channels is chosen."""
CHANGES = (8.0, 80.0)
"""Root mean square change of a channel by an effect, over its noise."""
TRIES, DRAWS = 8, 40
"""Sizes of an effect that are tried, and effects, or true specimens, that are drawn before a case is given up."""
SHARES = (0.03, 0.95)
"""Of the way from the null of an effect to the end of its range, between which its size is drawn by its logarithm."""
INNER = (0.25, 0.75)
"""Part of a range in which the true value of a parameter to be calibrated lies."""

EFFECTS = {"null": 0, "single": 1, "pair": 2}

Hidden = tuple[Candidate, dict[str, float]]
"""An effect and its values."""


@dataclass(frozen=True)
class Scene:
    """A specimen to draw from: ``usable`` holds which of the ``motions`` move it, and by which factors."""

    specimen: Specimen
    motions: tuple[Motion, ...]
    noise: float
    usable: tuple[tuple[int, float], ...]

    @classmethod
    def of(cls, specimen: Specimen, motions: Sequence[Motion], noise: float) -> Scene:
        """Raises InputError where no factor on a motion moves the specimen and leaves it standing."""
        unknowns = of_specimen(specimen, models.get(specimen.model))
        middle = _true(specimen, {x.name: x.start for x in unknowns})
        rested = tuple(_rested(motion) for motion in motions)
        tried = [(k, float(scale)) for k in range(len(rested)) for scale in SCALES]
        usable = tuple((k, scale) for k, scale in tried if _tells(specimen, _run(middle, rested[k], scale)))
        if not usable:
            names = ", ".join(motion.name for motion in motions)
            raise InputError(
                f"'{specimen.title}' either does not move or falls under {names}, scaled by {SCALES[0]:g} to "
                f"{SCALES[-1]:g}: give other motions with --motion."
            )
        return cls(specimen, rested, noise, usable)


@dataclass(frozen=True)
class Drawn:
    """A case: its ``recordings`` by name, the ``specimen`` as the laboratory knows it, and the key's entry."""

    specimen: Specimen
    recordings: dict[str, xr.Dataset]
    entry: dict[str, Any]


def draw(scene: Scene, kind: str, runs: Sequence[str], rng: np.random.Generator) -> Drawn:
    """A case of a ``kind``: null, single or pair. Raises InputError when no draw was suitable."""
    for _ in range(DRAWS):
        if (drawn := _drawn(scene, kind, runs, rng)) is not None:
            return drawn
    raise InputError(
        f"no case ({kind}) could be drawn in {DRAWS} tries: the specimen falls, or effects change its recordings by "
        f"less than {CHANGES[0]:g} or more than {CHANGES[1]:g} times their noise; give other motions or another noise."
    )


def _drawn(scene: Scene, kind: str, runs: Sequence[str], rng: np.random.Generator) -> Drawn | None:
    true, values = _true_of(scene.specimen, rng)
    picked = [scene.usable[k] for k in rng.choice(len(scene.usable), len(runs), replace=len(scene.usable) < len(runs))]
    shaken = {name: (scene.motions[k], scale) for name, (k, scale) in zip(runs, picked, strict=True)}
    plain = {name: _run(true, *how) for name, how in shaken.items()}
    if not all(_tells(scene.specimen, history) for history in plain.values()):
        return None
    first = runs[0]
    peak = _peak(plain[first])
    true, known = replace(true, reference_peak=peak), replace(scene.specimen, reference_peak=peak)
    sigma = {run: _noise(history, scene.noise) for run, history in plain.items()}
    hidden: list[Hidden] = []
    for _ in range(EFFECTS[kind]):
        found = _effect(known, true, shaken[first], [one for one, _ in hidden], sigma[first], rng)
        if found is None:
            return None
        hidden.append(found)
        true = with_mechanism(true, found[0].name, found[1])
    moved = {name: _run(true, *how) for name, how in shaken.items()}
    if not all(_tells(known, history) for history in moved.values()):
        return None
    read = {name: _read(history, scene.noise, rng) for name, history in moved.items()}
    notes = {
        name: {"motion": motion.name, "scale": scale, "strength": _change(plain[name], moved[name], sigma[name])}
        for name, (motion, scale) in shaken.items()
    }
    return Drawn(known, read, _entry(kind, hidden, values, notes))


def _rested(motion: Motion) -> Motion:
    """The motion after a rest."""
    rest = np.zeros(round(REST / motion.time_step))
    vertical = None if motion.vertical is None else np.concatenate([rest, motion.vertical])
    return replace(motion, horizontal=np.concatenate([rest, motion.horizontal]), vertical=vertical)


def _true(specimen: Specimen, values: Mapping[str, float]) -> Specimen:
    return replace(with_values(specimen, values), tolerance={}, measured={}, calibrate={})


def _true_of(specimen: Specimen, rng: np.random.Generator) -> tuple[Specimen, dict[str, float]]:
    """A specimen within its tolerances and ranges, and the values that were drawn."""
    unknowns = of_specimen(specimen, models.get(specimen.model))
    drawn = []
    for x in unknowns:
        low, high = x.bounds
        inner = low + rng.uniform(*INNER) * (high - low)
        drawn.append(inner if x.prior is None else np.clip(x.coordinate(rng.normal(*x.prior)), low, high))
    values = values_of(unknowns, np.array(drawn))
    return _true(specimen, values), values


def _run(specimen: Specimen, motion: Motion, scale: float) -> xr.Dataset:
    use = models.get(specimen.model).vertical_by_default if specimen.vertical is None else specimen.vertical
    shaking: Shaking = (motion if use else motion.without_vertical()).shaking()
    history = simulate_specimen(specimen, shaking, scale=scale)
    leads = [lead.channel for lead in identification_of(models.get(specimen.model)).leads]
    kept = [name for name in history.data_vars if name in (*leads, *specimen.places, *BASE)]
    return history.drop_dims("event")[kept]


def _channels(history: xr.Dataset) -> dict[str, FloatArray]:
    """What is compared."""
    return {str(n): np.asarray(x) for n, x in history.data_vars.items() if n not in BASE}


def _peak(history: xr.Dataset) -> float:
    return float(np.abs(next(iter(_channels(history).values()))).max())


def _recording(history: xr.Dataset, name: str) -> Recording:
    time = np.asarray(history["time"])
    channels = {str(n): np.asarray(x) for n, x in history.data_vars.items() if n in CHANNELS}
    levels = tuple(str(level) for level in range(history.sizes.get("level", 0)))
    return Recording(name, float(time[1] - time[0]), time, channels, levels)


def _tells(specimen: Specimen, history: xr.Dataset) -> bool:
    """Whether the specimen stands to the end and moves enough to be compared."""
    if ending(history) not in ("rest", "rocking"):
        return False
    try:
        measured = measure(specimen, [_recording(history, "run")])
    except InputError:
        return False
    return measured.stretches is not None or len(measured.windows) >= FEWEST


def _effect(
    known: Specimen,
    true: Specimen,
    shaken: tuple[Motion, float],
    beside: Sequence[Candidate],
    sigma: Mapping[str, float],
    rng: np.random.Generator,
) -> Hidden | None:
    """An effect of another class than those ``beside`` it, and its values; None where those tried are of no use."""
    taken = {one.effect_class for one in beside}
    before = _run(true, *shaken)
    some = firsts(candidates(measure(known, [_recording(before, "run")]), known))
    names = sorted({one.name for one in some if one.effect_class not in taken})
    if not names:
        return None
    name = names[int(rng.integers(len(names)))]
    variants = [one for one in some if one.name == name]
    candidate = variants[int(rng.integers(len(variants)))]
    for _ in range(TRIES):
        given = {**values_of(candidate.unknowns, _size(candidate, rng)), **candidate.held}
        values = {key.removeprefix(f"{name}."): value for key, value in given.items()}
        try:
            moved = _run(with_mechanism(true, name, values), *shaken)
        except InputError:  # it does not act together with what is there
            return None
        if _tells(known, moved) and CHANGES[0] <= _change(before, moved, sigma) <= CHANGES[1]:
            return candidate, values
    return None


def _size(candidate: Candidate, rng: np.random.Generator) -> FloatArray:
    """Coordinates (d,) of an effect on either side of its null over its range, and of what shapes it over theirs."""
    bounds = np.array([x.bounds for x in candidate.unknowns])
    null = float(np.clip(candidate.null[0], *bounds[0]))
    reaches = [end - null for end in bounds[0] if end != null]
    drawn = rng.uniform(bounds[:, 0], bounds[:, 1])
    drawn[0] = null + np.exp(rng.uniform(*np.log(SHARES))) * reaches[int(rng.integers(len(reaches)))]
    return np.asarray(drawn)


def _noise(history: xr.Dataset, share: float) -> dict[str, float]:
    """Standard deviation of the noise of each channel."""
    return {name: share * float(np.abs(x).max()) for name, x in _channels(history).items()}


def _change(before: xr.Dataset, after: xr.Dataset, sigma: Mapping[str, float]) -> float:
    """Largest root mean square change of a channel, over its noise."""
    count = min(before.sizes["time"], after.sizes["time"])
    pairs = ((name, x[..., :count], _channels(after)[name][..., :count]) for name, x in _channels(before).items())
    return max(float(np.sqrt(np.mean((y - x) ** 2))) / sigma[name] for name, x, y in pairs if sigma[name] > 0.0)


def _read(history: xr.Dataset, noise: float, rng: np.random.Generator) -> xr.Dataset:
    """What instruments with white noise read; nothing that tells what is hidden."""
    read = history.copy(deep=True)
    for name, channel in read.data_vars.items():
        share = BASE_NOISE if name in BASE else noise
        channel.values += share * float(np.abs(channel).max()) * rng.normal(size=channel.shape)
    read.attrs = {"Conventions": "CF-1.11"}
    return read


def _entry(
    kind: str, hidden: Sequence[Hidden], values: Mapping[str, float], notes: Mapping[str, dict[str, Any]]
) -> dict[str, Any]:
    effects = [{"name": one.name, "class": one.effect_class, "parameters": given} for one, given in hidden]
    return {"kind": kind, "effects": effects, "true_parameters": dict(values), "recordings": dict(notes)}
