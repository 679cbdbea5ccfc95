"""Where the base model misses: intervals of the recordings, and in which phase of the motion.

The excess of a window is what the extended model takes off its squared misfit. Runs of neighbouring
windows are scanned for more than their part; the largest run is compared with that of shuffled windows,
so the whole scan is wrong with 5 % probability at most. Without a run that stands out the interval
is all that was compared.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from diagnosis.constancy import Tested
from diagnosis.heldout import Shown
from diagnosis.result import Located
from models.base import FloatArray

SHUFFLES = 400
LEVEL = 0.05
FEWEST = 4
"""Windows from which on a run of them can stand out."""
SHARE_OF_PLAIN = 0.3
"""A dependence is told when its statistic is this share of that of the plain force."""
HIGH_HZ = 10.0
WORDS = {"side": ("left", "right"), "size of the rotation": ("small_rotation", "large_rotation"), "time": ("", "late")}


def locate(shown: Shown, tested: list[Tested], sensors_only: bool, seed: int = 0) -> tuple[Located, ...]:
    """Intervals by recording and channel, the largest share first."""
    m = shown.measured
    excess = _excess(shown)
    total = float(np.maximum(excess, 0.0).sum())
    if total <= 0.0:
        return ()
    words = ("everywhere",) if sensors_only else phases(tested)
    if _above_10_hz(shown):
        words = (*words, "above_10_hz")
    rng = np.random.default_rng(seed)
    found = []
    for r, recording in enumerate(m.recordings):
        own = np.flatnonzero(m.recording_of == r)
        for c, channel in enumerate(m.channels):
            if not own.size:
                continue
            for low, high in _intervals(excess[own, c], rng):
                part = float(np.maximum(excess[own[low : high + 1], c], 0.0).sum()) / total
                first, last = m.windows[own[low]], m.windows[own[high]]
                start = first.first * recording.time_step
                end = (last.first + last.samples) * recording.time_step
                found.append(Located(recording.name, channel, float(start), float(end), words, part))
    return tuple(sorted(found, key=lambda f: -f.share))


def _excess(shown: Shown) -> FloatArray:
    """Squared misfit over noise taken off (W, C)."""
    m = shown.measured
    rests = [np.where(m.mask, p - m.values, 0.0) / m.sigma[..., None] for p in (shown.before, shown.after)]
    return np.asarray((rests[0] ** 2).sum(axis=2) - (rests[1] ** 2).sum(axis=2))


def _intervals(excess: FloatArray, rng: np.random.Generator) -> Iterator[tuple[int, int]]:
    """The run of windows that holds more than its part, else all of them."""
    size = np.sqrt(np.maximum(excess, 0.0))
    if size.size < FEWEST:
        yield 0, excess.size - 1
        return
    best, low, high = _largest_run(size)
    shuffled = [_largest_run(rng.permutation(size))[0] for _ in range(SHUFFLES)]
    if best > np.quantile(shuffled, 1.0 - LEVEL):
        yield low, high
    else:
        yield 0, excess.size - 1


def _largest_run(size: FloatArray) -> tuple[float, int, int]:
    """Largest excess of a run over the mean, in standard deviations of such a sum, with its ends."""
    about = np.concatenate([[0.0], np.cumsum(size - size.mean())])
    n = size.size
    sums = about[None, :] - about[:, None]
    length = np.arange(n + 1)[None, :] - np.arange(n + 1)[:, None]
    spread = np.sqrt(np.maximum(length * (1.0 - length / n), 1e-9))
    scan = np.where((length > 0) & (length < n), sums / spread, -np.inf)
    low, high = np.unravel_index(int(np.argmax(scan)), scan.shape)
    return float(scan[low, high]), int(low), int(high) - 1


def phases(tested: list[Tested]) -> tuple[str, ...]:
    """In which phase of the motion the missing force acts, from the tests on the base fit."""
    plain = [t for t in tested if not t.depends_on]
    if not plain:
        return ("everywhere",)
    leader = max(plain, key=lambda t: t.statistic)
    words = ["impact" if leader.kind == "restitution" else "between_impacts"]
    for test in tested:
        if test.kind == leader.kind and test.depends_on in WORDS and test.statistic > SHARE_OF_PLAIN * leader.statistic:
            word = WORDS[test.depends_on][1 if test.sign > 0.0 else 0]
            if word and word not in words:
                words.append(word)
    return tuple(words)


def _above_10_hz(shown: Shown) -> bool:
    """Whether most of what is missing lies above 10 Hz."""
    m = shown.measured
    above, whole = 0.0, 0.0
    for w, window in enumerate(m.windows):
        step = m.recordings[window.recording].time_step
        missing = (shown.before - shown.after)[w, :, : window.samples]
        power = np.abs(np.fft.rfft(missing * np.hanning(window.samples), axis=1)) ** 2
        whole += float(power.sum())
        above += float(power[:, np.fft.rfftfreq(window.samples, step) > HIGH_HZ].sum())
    return whole > 0.0 and above > 0.5 * whole
