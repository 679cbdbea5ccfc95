"""What was measured, for a model that runs from rest through each recording once.

Such a motion does not depend on its start, so no state has to be measured, and effects that build up over a whole test
stay in sight. Means over a share of the slowest period are compared (`models.identification.Stretches`), level by
level, in stretches of some periods: the likelihood weighs these one by one, and no single one may decide.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

import numpy as np

from diagnosis.data.gathered import gather, refuse_dead
from diagnosis.data.measured import Measured, identification_of
from diagnosis.data.noise import base_noise, response_noise
from diagnosis.data.windows import Window
from grids.recordings.base import SHARE, FloatArray, Recording
from grids.recordings.levels import level_by_level, level_of, stem
from models.errors import InputError
from models.identification import Stretches
from models.model import Model

LEAST = 0.02
"""Errors over a channel's rms that are assumed before any are estimated: no model of a building is nearer."""
RUNS = 4
"""Samples of the base's motion in one mean: the model runs on means too, over a fraction of those compared."""


def arrange_stretches(
    model: Model,
    recordings: Sequence[Recording],
    stretches: Stretches,
    points: Mapping[str, int],
    placed: Sequence[str] = (),
    left: Collection[str] = (),
    reference_peak: float | None = None,
) -> Measured:
    """The recordings in stretches; channels are compared that all of them hold and the model predicts.

    ``stretches`` in s; ``points``: how many levels the model has of channels by level; ``placed``: channels that say
    what they measure; ``left``: those that are the same measurement as another. Raises InputError when nothing can be
    compared.
    """
    declared = identification_of(model)
    split = [level_by_level(r) for r in recordings]
    for recording in split:
        _refuse_beyond(model, recording, points)
    observed = [
        name
        for quantity in model.observables
        if quantity.unit != SHARE and quantity.name not in left
        for name in names_by_level(quantity.name, points)
    ]
    channels = tuple(c for c in (*observed, *placed) if all(c in r.channels for r in split))
    lead = declared.leads[0].channel
    if not any(stem(name) == lead for name in channels):
        lacking = [r.name for r in recordings if lead not in r.channels]
        why = (
            f"is missing in {', '.join(lacking)}"
            if lacking
            else f"is of no level that all of {', '.join(r.name for r in recordings)} hold"
        )
        raise InputError(f"{lead} {why}: model {model.name} is compared by it; record or map it.")
    refuse_dead(split, channels)
    runs = [as_means(r, max(1, round(stretches.mean / (RUNS * r.time_step)))) for r in split]
    means = [as_means(r, max(1, round(stretches.mean / r.time_step))) for r in runs]
    windows = tuple(w for k, r in enumerate(means) for w in _cut(k, r, stretches.length))
    sigma = {
        (k, c): response_noise(r, c) / np.sqrt(means[k].time_step / r.time_step)
        for k, r in enumerate(split)
        for c in channels
    }
    gathered = gather(means, windows, channels)
    of_channel = np.array([_rms([r.channels[c] for r in means]) for c in channels])
    gathered["sigma"] = np.array([[sigma[w.recording, c] for c in channels] for w in windows])
    leading = next(c for c in channels if stem(c) == lead)
    return Measured(
        model=model,
        recordings=tuple(means),
        shakings=tuple(r.shaking(False, vertical_acts=False) for r in runs),
        base_noise=tuple(base_noise(r) for r in recordings),
        windows=windows,
        channels=channels,
        **gathered,
        states=np.zeros((len(windows), 0)),
        state_size=np.zeros(0),
        memory={},
        reference_peak=reference_peak or float(np.max(np.abs(means[0].channels[leading]))),
        lengths=None,
        stretches=stretches,
        assumed=np.broadcast_to(LEAST * of_channel, (len(windows), len(channels))),
    )


def _refuse_beyond(model: Model, recording: Recording, points: Mapping[str, int]) -> None:
    """Raise InputError where a level that the model has not stands in the place of one that it has.

    Levels above all those of the model are not compared: a rigid body is compared with the slab of a building.
    """
    for name in recording.channels:
        level, count = level_of(name), points.get(stem(name), 0)
        lacking = [k for k in range(count) if f"{stem(name)}_{k}" not in recording.channels]
        if level is not None and level >= count and lacking:
            raise InputError(
                f"{name} of {recording.name} is of level {level}, and model {model.name} has {count} here, numbered "
                f"from 0, of which {lacking[0]} is not recorded: correct the number of the level, or that of levels "
                "in the specimen."
            )


def names_by_level(quantity: str, points: Mapping[str, int]) -> Sequence[str]:
    """The channels of a quantity: one for each of the levels ``points``, or itself."""
    return [f"{quantity}_{k}" for k in range(points[quantity])] if quantity in points else [quantity]


def as_means(recording: Recording, size: int) -> Recording:
    """The recording as means over ``size`` samples, the last ones left out if they are fewer."""
    n = recording.time.size // size
    channels = {name: averages(x, size) for name, x in recording.channels.items()}
    step = size * recording.time_step
    lost = {name: np.unique(at[at < n * size] // size) for name, at in recording.lost.items()}
    time = step * np.arange(n, dtype=np.float64)
    return replace(recording, time_step=step, time=time, channels=channels, lost=lost)


def averages(values: FloatArray, size: int) -> FloatArray:
    """Means (..., n // size) of ``size`` successive samples (..., n)."""
    n = values.shape[-1] // size
    return np.asarray(values[..., : n * size].reshape(*values.shape[:-1], n, size).mean(axis=-1))


def _cut(recording: int, means: Recording, length: float) -> Sequence[Window]:
    """Stretches of about ``length`` s, all as long but the last one, which may be a little shorter."""
    count = max(1, round(means.time.size * means.time_step / length))
    size = -(-means.time.size // count)
    return [Window(recording, k, min(size, means.time.size - k)) for k in range(0, means.time.size, size)]


def _rms(signals: Sequence[FloatArray]) -> float:
    return max(float(np.sqrt(np.mean(np.concatenate(signals) ** 2))), 1e-12)
