"""The noise of the channels that a fit weighs its residuals with.

Responses: the local-polynomial level of `grids.recordings.noise` where that noise is white. A filter in
the instrument leaves less at the high frequencies which that level is taken from, and all of it where
the effects of mechanisms lie: then it is the white level of equal spectral density below `BAND`, from
stretches in which nothing moves. Base: earthquakes are not smooth over nine samples everywhere, so the
level is that of the record's quietest tenth; it acts on the model as a disturbance (see
`diagnosis.fit.whitening`), not as a residual.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from grids.recordings.base import REQUIRED, FloatArray, Recording
from grids.recordings.noise import louder, noise_of

BLOCK = 40
QUIET_SHARE = 0.1
RELATIVE_FLOOR = 1e-4
"""Least noise assumed over the channel's peak, for computed channels."""
BAND = 15.0
"""Hz, below which the effects of mechanisms lie."""
BANDS = (BAND, 10.0, 6.0, 4.0)
"""Hz, below one of which noise is flat that went through a slow filter: looked at where nothing moves the base."""
LINES = 10
"""Fewest lines of a spectrum that tell whether it is flat."""
STILL, FEWEST = 0.35, 3
"""s that nothing moves, and how many such stretches must follow one another."""
CALM = 10.0
"""Range of the base's acceleration over its noise while nothing shakes it."""
WEAK = 0.05
"""Range of the base's acceleration over its peak under which nothing begins to rock."""
NOISIEST = 0.05
"""Level over the channel's peak, from which on it is no noise."""
LIKE = 1.5
"""Range of a still stretch over that of the stillest ones."""
MOST = 1e4
"""Density over what a filter leaves of it at the highest frequencies: beyond, it counts only where nothing moves the
base. Of noise through a low-pass of 12 Hz and fourth order, run both ways, 1/700 is left at 200 samples a second."""
FLAT = 0.25
"""Geometric over arithmetic mean of a spectrum that is noise: .56 if white, next to nothing if motion."""


def response_noise(recording: Recording, channel: str) -> float:
    """Standard deviation of a response channel's noise, in its unit, of equal density where effects lie."""
    values = recording.channels[channel]
    noise = noise_of(values)
    level = max(noise.sigma, RELATIVE_FLOOR * float(np.max(np.abs(values))))
    if noise.white or noise.lag_one < noise.lag_one_if_white:
        return level
    stretches = still(values, recording.time_step)
    if channel in recording.places and recording.places[channel].absolute:  # it holds the motion of the base
        stretches = calm(stretches, recording)
    density = density_level(values, recording.time_step, stretches)
    if not 0.0 < density < MOST * noise.sigma:  # a motion, but where nothing moves the base
        density = density_level(values, recording.time_step, calm(stretches, recording, WEAK), BANDS)
    return max(level, density) if density < NOISIEST * float(np.max(np.abs(values))) else level


def response_levels(recording: Recording, channel: str) -> FloatArray:
    """The same at every sample (n_times,): the level may change within a recording (`louder`)."""
    values = recording.channels[channel]
    change = louder(values)
    if change is None:
        return np.full(values.size, response_noise(recording, channel))
    levels = np.where(np.arange(values.size) < change.sample, change.before, change.after)
    return np.maximum(levels, RELATIVE_FLOOR * float(np.max(np.abs(values))))


def density_level(
    values: FloatArray, time_step: float, stretches: Sequence[slice], bands: Sequence[float] = (BAND,)
) -> float:
    """Standard deviation of the white noise as dense as a channel's at low frequencies while it is still; 0 if never.

    With the periodogram P(f) = |sum_j (x_j - mean) exp(-2 pi i f t_j)|^2/n of n samples white noise has
    E P = sigma^2 at every frequency. The mean is that below `BAND`, or in the lower half of the widest other of the
    ``bands`` (Hz) below which the spectrum is flat; one that is flat below none is that of a motion.
    """
    frequencies: list[FloatArray] = [np.zeros(0)]
    powers: list[FloatArray] = [np.zeros(0)]
    for stretch in stretches:
        x = values[stretch]
        frequencies.append(np.asarray(np.fft.rfftfreq(x.size, time_step)[1:], np.float64))
        powers.append(np.abs(np.fft.rfft(x - x.mean())[1:]) ** 2 / x.size)
    frequency, power = np.concatenate(frequencies), np.concatenate(powers)
    for band in bands:
        inside = power[frequency < band]
        if inside.size < LINES or not np.any(inside):
            break
        mean = float(np.mean(inside))
        if float(np.exp(np.mean(np.log(np.maximum(inside, 1e-30 * mean))))) >= FLAT * mean:
            return float(np.sqrt(mean if band == BAND else np.mean(power[frequency < 0.5 * band])))
    return 0.0


def _block(time_step: float) -> int:
    """Samples of which a range is taken."""
    return max(8, round(STILL / time_step))


def calm(stretches: Sequence[slice], recording: Recording, share: float = 0.0) -> list[slice]:
    """The parts of ``stretches`` in which the base, for as long as counts as still, moves by no more than its noise.

    Or by no more than a ``share`` of its peak.
    """
    base, size = recording.channels[REQUIRED], _block(recording.time_step)
    most = max(CALM * base_noise(recording), share * float(np.max(np.abs(base))))
    reach = FEWEST * size
    found: list[slice] = []
    for stretch in stretches:
        for k in range(stretch.start, stretch.stop - reach + 1, size):
            if np.ptp(base[k : k + reach]) > most:
                continue
            begin = k if not found else max(k, found[-1].stop)
            found.append(slice(begin, k + reach))
    return found


def still(values: FloatArray, time_step: float) -> list[slice]:
    """Stretches at one level in which the channel's range stays like that of its stillest second."""
    size = _block(time_step)
    blocks = values[: values.size // size * size].reshape(-1, size)
    if len(blocks) < FEWEST:
        return []
    ranges, levels = np.ptp(blocks, axis=1), np.median(blocks, axis=1)
    runs = np.lib.stride_tricks.sliding_window_view(ranges, FEWEST).max(axis=1)
    stillest = int(np.argmin(runs))
    level = float(np.median(levels[stillest : stillest + FEWEST]))
    like = (ranges < LIKE * runs[stillest]) & (np.abs(levels - level) < runs[stillest])
    edges = np.flatnonzero(np.diff(np.concatenate([[False], like, [False]]).astype(int)))
    return [slice(a * size, b * size) for a, b in edges.reshape(-1, 2).tolist() if b - a >= FEWEST]


def base_noise(recording: Recording) -> float:
    """Standard deviation (m s-2) of the noise of the horizontal base acceleration."""
    values = recording.channels[REQUIRED]
    blocks = max(values.size // BLOCK, 1)
    levels = [noise_of(part).sigma for part in np.array_split(values, blocks)]
    return float(np.quantile(levels, QUIET_SHARE)) if np.any(values) else 0.0
