"""The estimated errors as a report states them: by channel, by event, and of the model itself."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from diagnosis.data.averaging import RATE
from diagnosis.data.measured import Measured
from diagnosis.errors.adequacy import (
    Inadequacy,
    Repeatability,
    density,
    drifting_base,
    inadequacy,
    repeatability,
)
from diagnosis.errors.components import WALK
from diagnosis.errors.corner import LOW, MIDDLE, corner
from diagnosis.errors.hum import in_the_samples
from diagnosis.errors.likelihood import whitened
from diagnosis.errors.model import Errors

FAST = ("white", "low_pass", "filtered")
SLOW = 0.4
"""s, correlation time from which on noise is called drift."""
CLEARLY = 0.25
"""Deviation over that of the noise from which on drift, hum and growing noise are stated."""
COLOURED = 0.5
"""Density at 20-40 Hz over that at 2-10 Hz, and its inverse, beyond which noise is called coloured."""
LAGS = 24


@dataclass(frozen=True)
class Line:
    """A hum: frequency (Hz) and amplitude in the channel's unit."""

    frequency: float
    amplitude: float


@dataclass(frozen=True)
class Spectrum:
    """Residuals of the final model: one-sided densities (unit squared per Hz) and autocorrelation after whitening.

    ``estimated``: what the errors amount to in the windows; ``found``: of the windows' residuals, nan where there are
    none; ``correlation`` at ``lag`` (s), beyond ``bound`` by chance with 5 % probability.
    """

    frequency: tuple[float, ...]
    estimated: tuple[float, ...]
    found: tuple[float, ...]
    lag: tuple[float, ...]
    correlation: tuple[float, ...]
    bound: float


@dataclass(frozen=True)
class ChannelErrors:
    """Errors of one channel in its ``unit``, standard deviations.

    ``noise``: of what is faster than `SLOW`; ``drift``: of the rest, at the end of the longest recording; ``growing``:
    of noise in proportion to the signal, at its peak; ``colour``: "white", "low" (denser below 10 Hz) or "filtered"
    (little above 20 Hz and no more below). ``corner_hz``: from where on a filter weakens the noise, of the residuals
    (`diagnosis.errors.corner`); None where it is not filtered, a line of hum lies there, or that does not show.
    """

    channel: str
    unit: str
    noise: float
    colour: str
    corner_hz: float | None
    drift: float
    growing: float
    hum: tuple[Line, ...]
    spectrum: Spectrum


@dataclass(frozen=True)
class ErrorModel:
    """Everything that was estimated. ``scatter`` None: no events.

    ``base_noise`` (m s-2) by recording (`diagnosis.data.noise`), taken to be white; ``base_drift``: of the base
    accelerometer's zero, over the peak, at the end of the longest recording, 0 if it is not clear, None of a model
    whose errors know of none.
    """

    channels: tuple[ChannelErrors, ...]
    scatter: Repeatability | None
    base_noise: tuple[float, ...]
    base_drift: float | None
    inadequacy: Inadequacy
    still_seconds: float


def summary(errors: Errors, measured: Measured) -> ErrorModel:
    """The errors in the units of the recordings."""
    declared = measured.identification.scatter
    still = errors.pieces[len(errors.whitening.measured.windows) :]
    seconds = sum(p.time.size * float(np.min(np.diff(p.time))) for p in still) / max(len(measured.channels), 1)
    longest = max(float(r.time[-1]) for r in measured.recordings)
    return ErrorModel(
        channels=tuple(_channel(errors, measured, c, name, longest) for c, name in enumerate(measured.channels)),
        scatter=repeatability(errors, declared.events) if declared else None,
        base_noise=measured.base_noise,
        base_drift=drifting_base(errors, longest),
        inadequacy=inadequacy(errors),
        still_seconds=float(seconds),
    )


def _channel(errors: Errors, measured: Measured, channel: int, name: str, seconds: float) -> ChannelErrors:
    own = [(c, float(t)) for c, t in zip(errors.components, errors.theta, strict=True) if c.channel == channel]
    scale = float(errors.unit[channel])
    fast = sum(t for c, t in own if c.kind in FAST or (c.kind == "exponential" and c.scale < SLOW))
    slow = sum(t for c, t in own if c.kind == "exponential" and c.scale >= SLOW)
    slow += sum(t * (seconds / WALK if np.isinf(c.scale) else 1.0) for c, t in own if c.shared)
    growing = sum(t for c, t in own if c.kind == "growing")
    heard = [(c.scale, t) for c, t in own if c.kind == "hum" and t > 0.0]
    lines = [(*in_the_samples(measured, name, frequency), t) for frequency, t in heard]
    hum = tuple(Line(frequency, float(np.sqrt(2.0 * t)) * scale / left) for frequency, left, t in lines)
    colour, spectrum = _colour(errors, channel), _spectrum(errors, channel, scale)
    return ChannelErrors(
        channel=name,
        unit=measured.unit_of(name),
        noise=float(np.sqrt(fast)) * scale,
        colour=colour,
        corner_hz=_corner(spectrum, [at for at, _ in heard]) if colour == "filtered" else None,
        drift=float(np.sqrt(slow)) * scale,
        growing=float(np.sqrt(growing)) * scale,
        hum=hum,
        spectrum=spectrum,
    )


def _colour(errors: Errors, channel: int) -> str:
    low, middle, high = (
        float(np.mean(density(errors, channel, np.linspace(a, b, 20)))) for a, b in (LOW, MIDDLE, (30.0, 45.0))
    )
    if not (min(low, middle) > 0.0 and high / max(low, middle) < COLOURED):
        return "white"
    of_filter, others = (
        sum(t for c, t in zip(errors.components, errors.theta, strict=True) if c.channel == channel and c.kind in kinds)
        for kinds in (("filtered",), ("white", "low_pass", "exponential"))
    )
    return "filtered" if low < middle / COLOURED or of_filter > others else "low"


def _corner(spectrum: Spectrum, hum: list[float]) -> float | None:
    """Below half the rate of the samples that are compared: from there on their spectrum is its own mirror image."""
    frequency = np.array(spectrum.frequency)
    kept = frequency < 0.5 / spectrum.lag[1]
    return corner(frequency[kept], np.array(spectrum.found)[kept], hum)


def _spectrum(errors: Errors, channel: int, scale: float) -> Spectrum:
    windows = len(errors.whitening.measured.windows)
    moving = [p for p, w in zip(errors.pieces[:windows], errors.weights[:windows], strict=True) if w > 0.0]
    frequency = np.arange(1.0, RATE / 2.0, 1.0)
    step = errors.step
    found, count = np.zeros_like(frequency), 0.0
    products, pairs = np.zeros(LAGS), np.zeros(LAGS)
    for piece in moving:
        own = piece.channel == channel
        values, time = piece.residual[own], piece.time[own]
        taper = np.hanning(values.size + 2)[1:-1]
        wave = np.exp(-2j * np.pi * frequency[:, None] * time[None, :])
        spacing = float(np.min(np.diff(time)))
        found += 2.0 * spacing * np.abs(wave @ (taper * (values - np.mean(values)))) ** 2 / np.sum(taper**2)
        count += 1.0
        white = whitened(piece, errors.theta)[own]
        for lag in range(min(LAGS, white.size)):
            products[lag] += float(white[lag:] @ white[: white.size - lag])
            pairs[lag] += white.size - lag
    correlation = products / np.maximum(products[0], 1e-300) * (pairs[0] / np.maximum(pairs, 1.0))
    expected = density(errors, channel, frequency, moving=True)
    spacing = float(np.min(np.diff(moving[0].time[moving[0].channel == channel]))) if moving else step
    return Spectrum(
        frequency=tuple(frequency.tolist()),
        estimated=tuple((expected * scale**2).tolist()),
        found=tuple((found / max(count, 1.0) * scale**2).tolist()),
        lag=tuple((np.arange(LAGS) * spacing).tolist()),
        correlation=tuple(correlation.tolist()),
        bound=float(1.96 / np.sqrt(max(pairs[0], 1.0))),
    )
