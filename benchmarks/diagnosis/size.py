"""How large an effect is: the catalogue's rule of nominal size.

Windows of .7 s start at peaks of the true rotation. From each window's true state, the base model
without the effect runs under the measured base motion; the difference to the noise-free recording, less
what a refit of the base can take up (a linear least squares in width and height, with the laboratory's
tolerances as priors), has over all windows of a recording the rms d. The size is d over the noise; that
of a case is the larger one of its two training recordings. At nominal size it is 10.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from models.housner.lanes import run as lanes
from models.housner.model import MODEL
from models.runs import Request
from models.shaking import Shaking

FloatArray = NDArray[np.float64]

NOMINAL = 10.0
WINDOW = 0.7
"""Seconds."""
ABOVE_NOISE = 8.0
STEP_OF_SENSITIVITY = 1e-3
"""Relative change of a base parameter."""
REFITTED = ("width", "height")


@dataclass(frozen=True)
class Windows:
    """Starts of the windows: sample, true rotation (rad) and rate (rad s-1), and what came before."""

    first: NDArray[np.int64]
    rotation: FloatArray
    rate: FloatArray
    largest: FloatArray
    impacts: FloatArray
    samples: int


def windows(rotation: FloatArray, rate: FloatArray, time_step: float, noise: float) -> Windows:
    """One window after the other, each from the next peak over 8 times the noise (rad)."""
    size = np.abs(rotation)
    samples = round(WINDOW / time_step)
    peaks = 1 + np.flatnonzero((size[1:-1] >= size[:-2]) & (size[1:-1] > size[2:]) & (size[1:-1] > ABOVE_NOISE * noise))
    chosen: list[int] = []
    for peak in peaks.tolist():
        if peak + samples < size.size and (not chosen or peak >= chosen[-1] + samples):
            chosen.append(peak)
    first = np.array(chosen, np.int64)
    changes = np.concatenate([[0], np.cumsum(rotation[1:] * rotation[:-1] < 0.0)])
    largest = np.maximum.accumulate(size)
    return Windows(first, rotation[first], rate[first], largest[first], changes[first].astype(float), samples)


def over_noise(
    base: Mapping[str, float],
    tolerance: Mapping[str, float],
    measured: Shaking,
    recorded: FloatArray,
    found: Windows,
    noise: float,
) -> float:
    """d over the noise for one recording, 0 without any window.

    ``base``: true values of the base parameters; ``measured``: the noise-free measured base motion;
    ``recorded`` (n_times,): the noise-free recorded rotation (rad).
    """
    count = found.first.size
    if count == 0:
        return 0.0
    # the base parameters as they are, then each of two a little larger and smaller, side by side
    changes = np.ones((1 + 2 * len(REFITTED), len(REFITTED)))
    for k in range(len(REFITTED)):
        changes[1 + 2 * k : 3 + 2 * k, k] += [STEP_OF_SENSITIVITY, -STEP_OF_SENSITIVITY]
    sets = changes.shape[0]

    def beside(values: NDArray[Any]) -> NDArray[Any]:
        return np.tile(values, sets)

    varied = {name: base[name] * np.repeat(changes[:, k], count) for k, name in enumerate(REFITTED)}
    start = {
        "rotation_1": beside(found.rotation),
        "rotation_rate_1": beside(found.rate),
        "peak_rotation_1": beside(found.largest),
        "impacts": beside(found.impacts),
    }
    first = beside(found.first)
    block = MODEL.build({**base, **varied}, vertical=measured.vertical is not None, size=sets * count)
    request = Request(
        measured,
        np.ones(sets * count),
        initial=start,
        first=first,
        last=first + found.samples - 1,
        samples=found.samples,
    )
    predicted = lanes.run(block, request).samples[..., 0].reshape(sets, -1)

    index = found.first[:, None] + np.arange(found.samples)
    difference = (recorded[index].ravel() - predicted[0]) / noise
    columns = [
        (up - down) / (2.0 * STEP_OF_SENSITIVITY * noise)
        for up, down in zip(predicted[1::2], predicted[2::2], strict=True)
    ]
    priors = [1.0 / tolerance[name] for name in REFITTED]
    design = np.vstack([np.column_stack(columns), np.diag(priors)])
    wanted = np.concatenate([difference, np.zeros(len(priors))])
    change = np.linalg.lstsq(design, wanted, rcond=None)[0]
    left = difference - np.column_stack(columns) @ change
    return float(np.sqrt(np.mean(left**2)))
