"""A random motion whose response spectrum is a given one.

1. White noise under the envelope of Jennings, Housner and Tsai (1968); its Fourier amplitudes are multiplied
   by target over response, a few times (Gasparini and Vanmarcke, SIMQKE, 1976).
2. Then, in time: the response of oscillator i at its peak, R_i = sum_n h_i(t_i - n) a_n, is linear in the
   samples. Every peak is brought to its target, the largest samples to 1 or below, the last velocity and
   displacement to 0, by the smallest change in the norm of the covariance B of the motion (as Lilhanand and
   Tseng 1988, with the responses' own kernels): da = B H^T (H B H^T + Lambda)^-1 (goal - H a); repeated,
   since peaks wander.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from grids.motions.spectrum import recursive_filter

FloatArray = NDArray[np.float64]
Target = Callable[[FloatArray], FloatArray]

RISE, FALL, REMAINDER = 0.15, 0.65, 0.05
"""Envelope over t/duration: quadratic to RISE, constant to FALL, then exponential down to REMAINDER."""
CLOSE = 0.05
"""Share of the duration over which the end is brought to zero."""
LOW_CUT, FLOOR = (0.08, 0.2), 1e-3
"""Hz over which a change of the motion fades out towards low frequencies, and what is left of it below."""
SHORTEST, LONGEST, SPACING = 0.02, 5.0, 0.43
"""Control periods, s (four samples at least), and the logarithm of the ratio of neighbours over the damping
(5 % at most): a fifth of an oscillator's half-power width 2 zeta."""
FOURIER_ROUNDS, TIME_ROUNDS, STALLED, DRAWS = 6, 25, 5, 12
"""Some draws of phases end with two peaks that take turns, no better for `STALLED` rounds; another one is drawn."""
CLOSE_ENOUGH = 0.05
"""Departure within `MATCHED` at which the rounds end; between control periods 2 to 3 % are added."""
MATCHED = (0.05, 4.0)
"""s: the periods over which the spectrum is reached."""
NEARLY_PEAK = 0.9
"""Samples above this share of the largest one are held at or below 1."""
REGULARISATION, STEP_LENGTH = 1e-2, 0.8
"""Lambda, for rows of length one (neighbouring oscillators ask for nearly the same change), and the share
of each change that is made."""
DIGITS = 7
"""The samples are rounded to this share of their peak: the same digits whatever computes them."""


def envelope(size: int) -> FloatArray:
    """Shape (size,) of the strong motion over time, 1 while it is stationary, 0 at both ends."""
    x = np.arange(size) / (size - 1)
    decay = np.exp(np.log(REMAINDER) * (x - FALL) / (1.0 - FALL))
    shape = np.where(x < RISE, (x / RISE) ** 2, np.where(x < FALL, 1.0, decay))
    return np.asarray(shape * np.minimum((1.0 - x) / CLOSE, 1.0))


@dataclass(frozen=True)
class _Process:
    """Covariance B = E F E of a motion: a stationary process of spectral density F under the envelope E."""

    shape: FloatArray
    density: FloatArray
    length: int

    @classmethod
    def of(cls, step: float, size: int) -> _Process:
        from scipy.fft import next_fast_len, rfftfreq

        length = next_fast_len(2 * size, real=True)
        low, high = LOW_CUT
        x = np.clip((rfftfreq(length, step) - low) / (high - low), 0.0, 1.0)
        return cls(envelope(size), np.maximum(np.sin(np.pi / 2 * x) ** 2, FLOOR), length)

    def root(self, rows: FloatArray) -> NDArray[np.complex128]:
        """Spectra (m, k) of the rows (m, n) under E and the root of F: those of `sum` and `products`."""
        from scipy.fft import rfft

        return np.asarray(np.sqrt(self.density) * rfft(self.shape * rows, self.length))

    def products(self, roots: NDArray[np.complex128]) -> FloatArray:
        """r B r^T (m, m) of rows whose spectra are ``roots``, by Parseval's theorem."""
        twice = np.full(roots.shape[1], 2.0)
        twice[0] = 1.0
        if self.length % 2 == 0:
            twice[-1] = 1.0
        parts = (roots * np.sqrt(twice / self.length)).view(np.float64)
        return np.asarray(parts @ parts.T)

    def sum(self, shares: FloatArray, roots: NDArray[np.complex128]) -> FloatArray:
        """B r^T s (n,): what ``shares`` (m,) of the rows add up to."""
        from scipy.fft import irfft

        passed = irfft(np.sqrt(self.density) * (shares @ roots), self.length)
        return np.asarray(self.shape * passed[: self.shape.size])


@dataclass(frozen=True)
class _Oscillators:
    """Pseudo-accelerations of oscillators: their filters and unit responses (m, n)."""

    periods: FloatArray
    filters: tuple[tuple[FloatArray, FloatArray], ...]
    unit: FloatArray

    @classmethod
    def of(cls, periods: FloatArray, damping: float, step: float, size: int) -> _Oscillators:
        found = [(omega, recursive_filter(float(omega), damping, step)) for omega in 2 * np.pi / periods]
        filters = tuple((omega**2 * forward, backward) for omega, (forward, backward) in found)
        impulse = np.zeros(size)
        impulse[0] = 1.0
        return cls(periods, filters, _filtered(filters, impulse))

    def peaks(self, motion: FloatArray) -> tuple[FloatArray, NDArray[np.intp], FloatArray]:
        """Largest absolute response (by a parabola between samples), its sample and its sign, each (m,)."""
        response = _filtered(self.filters, motion)
        rows = np.arange(len(response))
        at = np.argmax(np.abs(response[:, 1:-1]), axis=1) + 1
        before, peak, after = (np.abs(response[rows, at + k]) for k in (-1, 0, 1))
        bend = np.minimum(before - 2 * peak + after, -1e-12 * peak)
        return peak - (before - after) ** 2 / (8 * bend), at, np.sign(response[rows, at])


def _filtered(filters: Sequence[tuple[FloatArray, FloatArray]], motion: FloatArray) -> FloatArray:
    """The motion (n,) through each of m filters, (m, n)."""
    from scipy.signal import lfilter

    found = np.empty((len(filters), motion.size))
    for row, (forward, backward) in zip(found, filters, strict=True):
        row[:] = lfilter(forward, backward, motion)
    return found


def match(target: Target, damping: float, step: float, size: int, seed: int) -> FloatArray:
    """Samples (size,) with peak 1, zero last velocity and displacement, and the spectrum ``target``.

    ``target`` gives the pseudo-acceleration over the peak ground acceleration at periods (s).
    """
    shortest = max(SHORTEST, 4.0 * step)
    periods = np.geomspace(shortest, LONGEST, round(np.log(LONGEST / shortest) / (SPACING * min(damping, 0.05))))
    wanted = target(periods)
    oscillators = _Oscillators.of(periods, damping, step, size)
    process = _Process.of(step, size)
    # last velocity and displacement of a motion that is linear between samples and zero at its ends
    ends = np.vstack([np.full(size, step), step**2 * np.arange(size - 1, -1, -1)])
    random = np.random.default_rng(seed)
    least = np.inf
    for _ in range(DRAWS):
        start = _by_fourier(oscillators, wanted, process, ends, step, random)
        found, departure = _in_time(oscillators, wanted, process, ends, start)
        if departure < least:
            motion, least = found, departure
        if least < CLOSE_ENOUGH:
            break
    return np.asarray(np.round(motion / np.max(np.abs(motion)), DIGITS))


def _end_at_rest(motion: FloatArray, process: _Process, ends: FloatArray) -> FloatArray:
    """The motion with zero last velocity and displacement, changed as little as possible."""
    roots = process.root(ends)
    shares = np.asarray(np.linalg.solve(process.products(roots), ends @ motion), np.float64)
    return np.asarray(motion - process.sum(shares, roots))


def _by_fourier(
    oscillators: _Oscillators,
    wanted: FloatArray,
    process: _Process,
    ends: FloatArray,
    step: float,
    random: np.random.Generator,
) -> FloatArray:
    from scipy.fft import irfft, rfftfreq

    size = process.shape.size
    frequency = rfftfreq(size, step)
    phase = random.uniform(0.0, 2 * np.pi, frequency.size)
    shortest, longest = oscillators.periods[[0, -1]]
    inside = (frequency >= LOW_CUT[0]) & (frequency <= 1.0 / shortest)
    log_period = -np.log(np.clip(frequency, 1.0 / longest, 1.0 / shortest))

    def over_frequency(values: FloatArray) -> FloatArray:
        return np.asarray(np.interp(log_period, np.log(oscillators.periods), values))

    def enveloped(spectrum: NDArray[np.complex128]) -> FloatArray:
        return _end_at_rest(process.shape * irfft(spectrum, size), process, ends)

    spectrum = np.where(inside, over_frequency(wanted) * np.exp(log_period / 2), 0.0) * np.exp(1j * phase)
    spectrum *= float(np.mean(wanted / oscillators.peaks(enveloped(spectrum))[0]))
    for _ in range(FOURIER_ROUNDS):
        peak, _, _ = oscillators.peaks(enveloped(spectrum))
        spectrum *= over_frequency(wanted / peak)
    return enveloped(spectrum)


def _in_time(
    oscillators: _Oscillators, wanted: FloatArray, process: _Process, ends: FloatArray, motion: FloatArray
) -> tuple[FloatArray, float]:
    """The motion of all rounds that departs least from the spectrum, and by how much."""
    counts = (oscillators.periods >= 0.98 * MATCHED[0]) & (oscillators.periods <= 1.02 * MATCHED[1])
    best, least, found_in = motion, np.inf, 0
    for number in range(TIME_ROUNDS):
        size = np.abs(motion)
        top = int(np.argmax(size))
        peak, at, sign = oscillators.peaks(motion)
        departure = float(np.max(np.abs(peak / (size[top] * wanted) - 1.0)[counts]))
        if departure < least:
            best, least, found_in = motion, departure, number
        if least < CLOSE_ENOUGH or number - found_in > STALLED:
            break
        high = np.flatnonzero(size > NEARLY_PEAK * min(size[top], 1.0))
        samples = np.zeros((high.size, motion.size))
        samples[np.arange(high.size), high] = np.sign(motion[high])
        responses = np.zeros((wanted.size, motion.size))
        for row, unit, sample, side in zip(responses, oscillators.unit, at, sign, strict=True):
            row[: sample + 1] = side * unit[sample::-1]
        rows = np.vstack([ends, samples, responses])
        lower = np.where(high == top, 1.0, np.minimum(size[high], 1.0)) - size[high]
        miss = np.concatenate([-ends @ motion, STEP_LENGTH * lower, STEP_LENGTH * (wanted - peak)])
        roots = process.root(rows)
        normal = process.products(roots)
        length = np.sqrt(np.diagonal(normal))
        normal /= np.outer(length, length)
        normal[np.diag_indices_from(normal)] += np.where(np.arange(miss.size) < 2, 0.0, REGULARISATION)
        motion = motion + process.sum(np.linalg.solve(normal, miss / length) / length, roots)
    return best, least
