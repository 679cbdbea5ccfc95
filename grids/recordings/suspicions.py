"""What looks wrong with a recording but may be right: sentences, never errors.

While a body rocks on an edge,

    theta'' = -p^2 [alpha sign(theta) - theta + a/g],        p^2 = 3 g / (4 R) for a solid block,

so a regression of the measured theta'' on sign(theta), theta and a tells p^2 and alpha without
knowing the wall. A swapped unit, a turned sign or a clock out of step moves them by factors that no
wall explains. Joints of rubber change the coefficients of sign(theta) and theta, hardly that of a.
Levels of a building are held against x_level'' + a = absolute acceleration.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from grids.recordings import flat_tops
from grids.recordings.base import REQUIRED, FloatArray, Recording
from grids.recordings.noise import louder, noise_of
from grids.recordings.zero import zeros
from grids.units import STANDARD_GRAVITY as GRAVITY

SMOOTHING = 0.06
"""s; width of the local cubic that differentiates a rotation twice: several samples, well under a swing."""
UPLIFTED = 0.2
"""Share of the peak rotation above which a body counts as rocking."""
FEWEST_SAMPLES = 100
SIGNIFICANT = 5.0
"""Standard errors by which the coefficient of the base acceleration must differ from zero."""
SMALLEST_P2, LARGEST_P2 = 0.2, 120.0
"""s-2; p^2 of blocks with R = 37 m and 6 cm. Degrees taken for radians multiply it by 57, a clock ten times too fast
by 100."""
SAMPLES_SMOOTHED = 13
"""Width of a smoothing that does not trust the clock: 65 ms at 200 Hz."""
LEAST_EXPLAINED = 0.5
"""Share of the variance that the regression must explain where the clock is not trusted."""
OFF_ZERO_ROTATION = 0.02
"""rad at which no body rests before and after the shaking."""
RESTING_RANGE = 0.1
"""Share of such a rotation by which it may move at rest."""
G_TAKEN_P2, G_TAKEN_ALPHA = 15.0, 0.04
"""g taken for m s-2 multiplies p^2 by 9.8 and divides alpha (rad) by as much."""
AHEAD = 0.04
"""s; the tool's own delay mechanism reaches this far, so less is left to it."""
LARGEST_LEAD = 0.3
LEAD_GAIN = 6.0
"""Gain in log likelihood over a rotation in step, counting one sample a smoothing width."""
LARGEST_PGA = 3.0 * GRAVITY
RESTS, CALM, MOVED = 0.4, 10.0, 0.003
"""s of rest, twice, at either end; range over the noise that is rest; share of the peak by which a zero has moved."""
OFF_ZERO = 5.0
"""Deviations of a base's mean acceleration from zero beyond which it did not come back to rest."""


@dataclass(frozen=True)
class Rocking:
    """The regression above: ``p2`` (s-2) with its significance, ``alpha`` (rad), share explained.

    ``alpha`` is infinite where the base has no share at all. ``independent`` counts the samples that smoothing leaves
    independent.
    """

    p2: float
    significance: float
    alpha: float
    explained: float
    independent: float


def suspicions_of(recording: Recording) -> tuple[str, ...]:
    """The sentences about a recording, possibly none."""
    found = [*_of_samples(recording), *_of_base(recording), *_of_levels(recording), *flat_tops.suspected(recording)]
    found += _of_noise(recording)
    for name in ("rotation_1", "rotation_2"):
        if name in recording.channels:
            found += _of_rotation(name, recording)
    return tuple(found)


def _of_samples(recording: Recording) -> Iterator[str]:
    """Channels that stay at one value, and two that hold the same samples."""
    seen: dict[bytes, str] = {}
    for name, values in recording.channels.items():
        for level, row in zip(recording.levels or ("",), np.atleast_2d(values), strict=False):
            called = f"{name} of level {level}" if values.ndim == 2 else name
            if not np.ptp(row):
                if row[0] and recording.channel(name).unit != "1":  # shares are measured by no sensor
                    yield f"{called} stays at {row[0]:.4g} throughout: was the sensor connected?"
                continue
            first = seen.setdefault(row.tobytes(), called)
            if first != called:
                yield f"{called} holds the samples of {first}: is one column named twice?"


def _of_noise(recording: Recording) -> Iterator[str]:
    """Responses whose noise becomes another within the recording."""
    for name, values in recording.channels.items():
        if name.startswith("base_") or values.ndim > 1 or (change := louder(values)) is None:
            continue
        ratio, at = change.after / change.before, recording.time_step * change.sample
        yield f"{name} has {ratio:.2g} times the noise from {at:.1f} s on: is a cable loose, or a range switched?"


def _of_base(recording: Recording) -> Iterator[str]:
    peak = float(np.max(np.abs(recording.channels[REQUIRED])))
    if peak > LARGEST_PGA:
        yield (
            f"{REQUIRED} peaks at {peak / GRAVITY:.3g} g, more than a shake table gives: "
            "is it in cm s-2, or in m s-2 declared as g?"
        )
    zero = zeros([recording])
    if abs(float(zero.mean[0])) > OFF_ZERO * float(zero.deviation[0]):
        yield (
            f"{REQUIRED} has a mean of {float(zero.mean[0]):+.2g} m s-2, a base that comes back to rest none: "
            "is the accelerometer's zero wrong, or the record cut?"
        )
    ends = _zeros_at_rest(recording)
    if ends is not None:
        before, after = ends
        yield (
            f"{REQUIRED} reads {before:+.2g} m s-2 at rest before the shaking and {after:+.2g} after it: does its zero "
            "wander, or is it AC-coupled? A zero that wanders acts on the model like a tilt that comes and goes"
        )
    vertical = recording.channels.get("base_acceleration_z")
    if vertical is not None and abs(abs(float(np.median(vertical))) - GRAVITY) < 0.1 * GRAVITY:
        yield (f"base_acceleration_z rests at {float(np.median(vertical)):.3g} m s-2: gravity is in it, subtract it")


def _zeros_at_rest(recording: Recording) -> tuple[float, float] | None:
    """Means of the base's acceleration at rest before and after the shaking, if they clearly differ."""
    base, size = recording.channels[REQUIRED], max(8, round(RESTS / recording.time_step))
    noise, peak = noise_of(base[: 4 * size]).sigma, float(np.max(np.abs(base)))
    means = []
    for part in (base[: 2 * size], base[-2 * size :]):
        halves = part[:size], part[size:]
        if part.size < 2 * size or max(float(np.ptp(half)) for half in halves) > CALM * max(noise, 1e-6 * peak):
            return None
        means.append(float(part.mean()))
    apart = abs(means[1] - means[0])
    return (means[0], means[1]) if apart > max(MOVED * peak, OFF_ZERO * noise / np.sqrt(2 * size)) else None


def _of_rotation(name: str, recording: Recording) -> Iterator[str]:
    rotation, base = recording.channels[name], recording.channels[REQUIRED]
    peak = float(np.max(np.abs(rotation)))
    if peak == 0.0:
        yield f"{name} is zero throughout: was the sensor connected?"
        return
    if peak > np.pi / 2 * 1.1:
        yield f"{name} peaks at {peak:.3g} rad, beyond lying flat: is it in degrees, declared as rad?"
        return
    yield from _of_zero(name, rotation, recording.time_step)
    upper = name == "rotation_2" and "rotation_1" in recording.channels  # may well rock against what carries it
    if upper or not np.any(base):
        return
    fit = fit_rocking(rotation, base, recording.time_step)
    lead = 0.0 if fit is None else _lead(rotation, base, recording.time_step, fit)
    if lead > AHEAD:
        yield f"{name} is ahead of {REQUIRED} by about {lead:.2g} s: were the clocks joined wrongly?"
    elif fit is None or fit.significance < SIGNIFICANT:
        other = fit_rocking(rotation, base, recording.time_step, SAMPLES_SMOOTHED * recording.time_step)
        if other is not None and other.significance > SIGNIFICANT and other.explained > LEAST_EXPLAINED:
            yield from _of_size(name, other)
    elif fit.p2 < 0.0:
        yield (
            f"{name} follows {REQUIRED} with the wrong sign (a base pushed to +x must tip the body to "
            "negative rotation): is one of them turned?"
        )
    elif not SMALLEST_P2 < fit.p2 < LARGEST_P2:
        yield from _of_size(name, fit)
    elif fit.p2 > G_TAKEN_P2 and abs(fit.alpha) < G_TAKEN_ALPHA:
        yield (
            f"{name} answers {REQUIRED} as a block of alpha = {abs(fit.alpha):.1g} rad would: "
            "is the acceleration in g, declared as m s-2?"
        )


def _of_zero(name: str, rotation: FloatArray, time_step: float) -> Iterator[str]:
    """A rotation that rests at one value far from zero before the shaking and after it."""
    size = max(8, round(RESTS / time_step))
    ends = rotation[:size], rotation[-size:]
    before, after = (float(np.median(end)) for end in ends)
    moves = max(*(float(np.ptp(end)) for end in ends), abs(after - before))
    if (
        rotation.size > 4 * size
        and min(abs(before), abs(after)) > OFF_ZERO_ROTATION
        and moves < RESTING_RANGE * abs(before)
    ):
        yield f"{name} rests at {before:+.2g} rad before the shaking and after it: is the sensor's zero wrong?"


def _of_size(name: str, fit: Rocking) -> Iterator[str]:
    """A body of a size that none has."""
    size = 0.75 * GRAVITY / fit.p2
    if fit.p2 >= LARGEST_P2:
        cure = "is the rotation in degrees, declared as rad, or the clock too fast?"
        yield f"{name} answers {REQUIRED} as a block of R = {size * 100:.1g} cm would: {cure}"
    elif 0.0 < fit.p2 <= SMALLEST_P2:
        cure = "is the rotation in a larger unit than the one declared, or the clock too slow?"
        yield f"{name} answers {REQUIRED} as a block of R = {size:.2g} m would: {cure}"


def _lead(rotation: FloatArray, base: FloatArray, time_step: float, fit: Rocking) -> float:
    """Time (s) by which the rotation runs ahead of the base, 0 unless that explains far more."""
    best, best_fit = 0, fit
    for shift in range(1, int(LARGEST_LEAD / time_step) + 1, max(1, int(0.01 / time_step))):
        shifted = fit_rocking(rotation[:-shift], base[shift:], time_step)
        if shifted and shifted.significance > SIGNIFICANT and shifted.explained > best_fit.explained:
            best, best_fit = shift, shifted
    rest = max(1.0 - fit.explained, 1e-12) / max(1.0 - best_fit.explained, 1e-12)
    return best * time_step if best_fit.p2 > 0.0 and fit.independent * np.log(rest) > LEAD_GAIN else 0.0


def fit_rocking(
    rotation: FloatArray, base: FloatArray, time_step: float, smoothing: float = SMOOTHING
) -> Rocking | None:
    """The regression of the module's equation, smoothed over so many s; None where the body hardly rocks."""
    from scipy.ndimage import binary_erosion
    from scipy.signal import savgol_filter

    width = max(7, round(smoothing / time_step) | 1)
    if rotation.size < 4 * width:
        return None
    acceleration = savgol_filter(rotation, width, 3, deriv=2, delta=time_step)
    smooth, shaking = savgol_filter(rotation, width, 3), savgol_filter(base, width, 3)
    up = binary_erosion(np.abs(smooth) > UPLIFTED * np.max(np.abs(smooth)), iterations=width // 2)
    if up.sum() < FEWEST_SAMPLES:
        return None
    regressors = np.column_stack([np.sign(smooth[up]), smooth[up], shaking[up]])
    solved = _least_squares(regressors, acceleration[up])
    if solved is None:
        return None
    (of_sign, _, of_base), errors, explained = solved
    p2 = -float(of_base) * GRAVITY
    alpha = float(of_sign / of_base) / GRAVITY if of_base else np.inf
    return Rocking(p2, abs(float(of_base / errors[2])), alpha, explained, float(up.sum()) / width)


def _least_squares(regressors: NDArray[np.float64], wanted: FloatArray) -> tuple[FloatArray, FloatArray, float] | None:
    """Coefficients, their standard errors, share of the variance explained; None if not unique."""
    coefficients, _, rank, _ = np.linalg.lstsq(regressors, wanted, rcond=None)
    if rank < regressors.shape[1]:
        return None
    rest = wanted - regressors @ coefficients
    errors = np.sqrt(np.diag(np.linalg.inv(regressors.T @ regressors)) * np.var(rest))
    explained = 1.0 - float(np.var(rest) / np.var(wanted))
    return np.asarray(coefficients, np.float64), np.maximum(errors, 1e-300), explained


def _of_levels(recording: Recording) -> Iterator[str]:
    """c_x x'' + c_a a against the absolute acceleration, both 1 in a sound recording."""
    from scipy.signal import savgol_filter

    pair = [recording.channels.get(f"level_{kind}_x") for kind in ("acceleration", "displacement")]
    if pair[0] is None or pair[1] is None or pair[0].shape[1] < 200:
        return
    width = max(7, round(SMOOTHING / recording.time_step) | 1)
    relative = savgol_filter(pair[1], width, 3, deriv=2, delta=recording.time_step).ravel()
    absolute = savgol_filter(pair[0], width, 3).ravel()
    base = np.tile(savgol_filter(recording.channels[REQUIRED], width, 3), pair[0].shape[0])
    solved = _least_squares(np.column_stack([relative, base]), absolute)
    if solved is None or solved[2] < 0.5:
        return
    of_relative, of_base = (float(c) for c in solved[0])
    if of_relative < 0.0:
        yield "level_displacement_x and level_acceleration_x have opposite signs: is one of them turned?"
    if of_base / abs(of_relative) < -0.5:
        yield f"level_acceleration_x answers {REQUIRED} with the wrong sign: is one of them turned?"
    if of_base / abs(of_relative) > 4.0:
        times = of_base / abs(of_relative)
        yield f"{REQUIRED} is {times:.3g} times too small: is it in g, declared as m s-2?"
    elif abs(of_relative) < 0.25:
        yield (f"level_acceleration_x is {abs(1 / of_relative):.3g} times too small: is it in g, declared as m s-2?")
