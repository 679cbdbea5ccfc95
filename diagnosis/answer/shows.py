"""Where a missing effect shows: intervals of the recordings in which the residual exceeds the noise.

Not where it acts: a jump at an event shows in every instant after it (see `diagnosis.answer.acts`).

The excess of a window is what the extended model takes off its squared misfit; where no model of the
library is adequate, what the base model leaves over that of the noise. Runs of neighbouring
windows are scanned for more than their part; the largest run is compared with that of shuffled windows,
at a level shared out among recordings and channels, so that all scans together are wrong with 5 %
probability at most. Without a run that stands out the interval is all that was compared. Windows start at a
peak, so what happens before the first peak is not located.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from diagnosis.answer.heldout import Shown
from diagnosis.answer.phases import ABOVE_10_HZ, phases
from diagnosis.answer.result import Located
from diagnosis.data.measured import Measured
from models.base import FloatArray
from models.identification import Motion

SHUFFLES = 1000
LEVEL = 0.05
"""Probability that any scan of an answer finds an interval by chance."""
FEWEST = 4
"""Windows from which on a run of them can stand out."""
HIGH_HZ = 10.0


def shows(shown: Shown, explained: bool = True, seed: int = 0) -> tuple[Located, ...]:
    """Intervals by recording and channel, the largest share first; ``explained``: by a model that is adequate."""
    m = shown.measured
    excess = _taken_off(shown) if explained else _over_noise(shown)
    total = float(np.maximum(excess, 0.0).sum())
    if total <= 0.0:
        return ()
    words = _words(shown, explained)
    if _above_10_hz(shown):
        words = (*words, ABOVE_10_HZ)
    rng = np.random.default_rng(seed)
    found = []
    level = LEVEL / (len(m.recordings) * len(m.channels))
    for r, recording in enumerate(m.recordings):
        own = np.flatnonzero(m.recording_of == r)
        for c, channel in enumerate(m.channels):
            if not own.size:
                continue
            for low, high in intervals(excess[own, c], level, rng):
                part = float(np.maximum(excess[own[low : high + 1], c], 0.0).sum()) / total
                first, last = m.windows[own[low]], m.windows[own[high]]
                start = first.first * recording.time_step
                end = (last.first + last.samples) * recording.time_step
                found.append(Located(recording.name, channel, float(start), float(end), words, part))
    return tuple(sorted(found, key=lambda f: -f.share))


def _words(shown: Shown, explained: bool) -> tuple[str, ...]:
    """The phases of the measured motion in which the squared residual lies."""
    m = shown.measured
    rest = np.where(m.mask, shown.before - (shown.after if explained else m.values), 0.0) / m.sigma[..., None]
    motion = _measured_motion(m)
    separation = m.identification.separation
    event = np.zeros(motion.coordinate.shape, bool)
    if separation is not None:
        signal = separation.signal(motion)
        event[:, :-1] = signal[:, 1:] * signal[:, :-1] <= 0.0
    return phases(m, (rest**2).sum(axis=1), motion, event)


def _measured_motion(m: Measured) -> Motion:
    """The leading channel along the windows as measured."""
    step = m.time_steps[:, None]
    coordinate = m.leading
    return Motion(coordinate, np.gradient(coordinate, axis=1) / step, m.base, float(np.max(np.abs(coordinate))))


def _taken_off(shown: Shown) -> FloatArray:
    """Squared misfit over noise that the extended model takes off the base model's (W, C)."""
    return _squared(shown, shown.before) - _squared(shown, shown.after)


def _over_noise(shown: Shown) -> FloatArray:
    """The base model's squared misfit over noise, less what noise alone leaves (W, C)."""
    return np.asarray(_squared(shown, shown.before) - shown.measured.mask.sum(axis=2))


def _squared(shown: Shown, prediction: FloatArray) -> FloatArray:
    m = shown.measured
    rest = np.where(m.mask, prediction - m.values, 0.0) / m.sigma[..., None]
    return np.asarray((rest**2).sum(axis=2))


def intervals(excess: FloatArray, level: float, rng: np.random.Generator) -> Iterator[tuple[int, int]]:
    """The run of windows that holds more than its share (by chance with probability ``level``), else all of them."""
    size = np.sqrt(np.maximum(excess, 0.0))
    if size.size < FEWEST:
        yield 0, excess.size - 1
        return
    best, low, high = _largest_run(size)
    shuffled = _runs(rng.permuted(np.tile(size, (SHUFFLES, 1)), axis=1)).max(axis=(1, 2))
    if best > np.quantile(shuffled, 1.0 - level):
        yield low, high
    else:
        yield 0, excess.size - 1


def _largest_run(size: FloatArray) -> tuple[float, int, int]:
    """Largest excess of a run, with its first and last window."""
    scan = _runs(size[None])[0]
    low, high = np.unravel_index(int(np.argmax(scan)), scan.shape)
    return float(scan[low, high]), int(low), int(high) - 1


def _runs(sizes: FloatArray) -> FloatArray:
    """Excess over the mean of runs [i, j) of rows (S, n), in standard deviations of such a sum (S, n + 1, n + 1)."""
    n = sizes.shape[1]
    about = np.cumsum(sizes - sizes.mean(axis=1, keepdims=True), axis=1)
    about = np.concatenate([np.zeros((len(sizes), 1)), about], axis=1)
    sums = about[:, None, :] - about[:, :, None]
    length = np.arange(n + 1)[None, :] - np.arange(n + 1)[:, None]
    spread = np.sqrt(np.maximum(length * (1.0 - length / n), 1e-9))
    return np.where((length > 0) & (length < n), sums / spread, -np.inf)


def _above_10_hz(shown: Shown) -> bool:
    """Whether most of what is missing, over the noise of each channel, lies above 10 Hz."""
    m = shown.measured
    above, whole = 0.0, 0.0
    change = np.where(m.mask, shown.before - shown.after, 0.0) / m.sigma[..., None]
    for w, window in enumerate(m.windows):
        step = m.recordings[window.recording].time_step
        missing = change[w, :, : window.samples]
        power = np.abs(np.fft.rfft(missing * np.hanning(window.samples), axis=1)) ** 2
        whole += float(power.sum())
        above += float(power[:, np.fft.rfftfreq(window.samples, step) > HIGH_HZ].sum())
    return whole > 0.0 and above > 0.5 * whole
