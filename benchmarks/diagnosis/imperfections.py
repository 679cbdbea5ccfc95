"""What a laboratory's recordings have beside an effect: impacts that scatter, noise that is not white, filters.

Each is drawn by its name (`NAMES`); ``mixture`` draws two or three others. Of the rotation's noise, of standard
deviation ``noise`` (a share of the peak) whatever its colour:

    ar1            a share of the variance is AR(1), coefficient .8 to .95 from sample to sample
    pink           a share of the variance has a density in proportion to 1/f
    hum            a line is added, amplitude .3 to 1 % of the peak, 8 to 65 Hz: that of the mains among them
    proportional   white noise of 1 to 3 % of the present rotation is added
    drift          .2 to .5 % of the peak over a recording, linear or half a cosine, other in each

``scatter_x``: theta'_after of every impact off its law by x % of theta'_before, Gaussian. ``ac_coupling``: the base
accelerometer has a first-order high-pass; ``filter``: a second-order low-pass of the rotation, causal or run both
ways (zero phase), or a causal one of every channel.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter

from benchmarks.diagnosis.instruments import Sensors
from benchmarks.diagnosis.processing import PROCESSED

FloatArray = NDArray[np.float64]

SCATTER = {"scatter_0.5": 0.005, "scatter_1": 0.01, "scatter_2": 0.02}
COLOURS = ("ar1", "pink")
OTHERS = ("hum", "proportional", "drift", "ac_coupling", "filter")
NAMES = (*SCATTER, *COLOURS, *OTHERS, "mixture")
NAMED_RIGHTLY = {"drift": ("drift",), "ac_coupling": ("base_filter",), "filter": ("filter", "base_filter")}
"""Effects of the catalogue whose name is a right answer where nothing but the imperfection is there."""
COLOURED = (0.5, 1.0)
AR_COEFFICIENT = (0.8, 0.95)
HUM_HZ = (8.0, 65.0)
HUM = (0.003, 0.01)
PROPORTIONAL = (0.01, 0.03)
DRIFT = (0.002, 0.005)
AC_HZ = (0.05, 0.3)
CORNER_HZ = (30.0, 60.0)


@dataclass(frozen=True)
class Imperfections:
    """Of one case. Shares: of the variance for the colours, of the peak for hum and drift.

    ``processing``: what is done to the recordings afterwards (`processing.PROCESSED`).
    """

    names: tuple[str, ...] = ()
    scatter: float = 0.0
    ar1_share: float = 0.0
    ar1_coefficient: float = 0.0
    pink_share: float = 0.0
    hum: float = 0.0
    hum_hz: float = 0.0
    proportional: float = 0.0
    drift: float = 0.0
    sensors: Sensors = field(default_factory=dict)
    processing: str = ""

    @property
    def named_rightly(self) -> list[str]:
        """Names of instruments that an answer may hold beside the hidden effects."""
        found = {name for one in self.names for name in NAMED_RIGHTLY.get(one, ()) if name in self._acting}
        return sorted(found.union(PROCESSED[self.processing].named_rightly) if self.processing else found)

    @property
    def _acting(self) -> set[str]:
        return {*self.sensors, *(("drift",) if self.drift else ())}

    def described(self) -> dict[str, Any]:
        return {name: value for name, value in asdict(self).items() if value}

    def kicks(self, count: int, rng: np.random.Generator) -> FloatArray:
        """Scatter of ``count`` impacts: change of theta'_after over theta'_before."""
        return self.scatter * rng.normal(size=count)

    def noise(
        self, signal: FloatArray, time_step: float, share: float, peak: float, rng: np.random.Generator
    ) -> FloatArray:
        """Errors (rad) of a rotation sampled at ``time_step`` (s), ``share`` of its ``peak`` (rad) their noise."""
        count = signal.size
        white = 1.0 - self.ar1_share - self.pink_share
        found = np.sqrt(white) * rng.normal(size=count)
        found += np.sqrt(self.ar1_share) * autoregressive(count, self.ar1_coefficient, rng)
        found += np.sqrt(self.pink_share) * pink(count, rng)
        found *= share * peak
        found += self.proportional * np.abs(signal) * rng.normal(size=count)
        time = time_step * np.arange(count)
        found += self.hum * peak * np.sin(2.0 * np.pi * (self.hum_hz * time + rng.uniform()))
        whole = time / time[-1]
        slow = whole if rng.uniform() < 0.5 else 0.5 * (1.0 - np.cos(np.pi * whole))
        return found + self.drift * peak * float(rng.choice([-1.0, 1.0])) * slow


def draw(name: str, without: tuple[str, ...], sampling_hz: float, rng: np.random.Generator) -> Imperfections:
    """The imperfection ``name`` of a case; a mixture has none that would hide an effect of ``without``."""
    names = (name,)
    if name == "mixture":
        free = [one for one in OTHERS if not set(NAMED_RIGHTLY.get(one, ())) & set(without)]
        first = str(rng.choice([*SCATTER, *COLOURS]))
        second = [one for one in (*SCATTER, *COLOURS) if (one in SCATTER) != (first in SCATTER)]
        names = (first, str(rng.choice(free)), *((str(rng.choice(second)),) if rng.uniform() < 0.5 else ()))
    found = Imperfections(names)
    for one in names:
        found = replace(found, **_drawn(one, found.sensors, sampling_hz, rng))
    return found


def _drawn(name: str, sensors: Sensors, sampling_hz: float, rng: np.random.Generator) -> Mapping[str, Any]:
    def between(ends: tuple[float, float]) -> float:
        return float(rng.uniform(*ends))

    if name in PROCESSED:
        return {"processing": name}
    if name in SCATTER:
        return {"scatter": SCATTER[name]}
    if name == "ar1":
        return {"ar1_share": between(COLOURED), "ar1_coefficient": between(AR_COEFFICIENT)}
    if name == "pink":
        return {"pink_share": between(COLOURED)}
    if name == "hum":
        return {"hum": between(HUM), "hum_hz": between(HUM_HZ)}
    if name == "ac_coupling":
        return {"sensors": {**sensors, "base_filter": {"high_pass_hz": between(AC_HZ)}}}
    if name == "filter":
        corner = between(CORNER_HZ)
        of_base = {"base_filter": {"low_pass_hz": corner}} if rng.uniform() < 0.5 else {}
        both_ways = 0.0 if of_base else float(rng.integers(2))
        own = {"corner_hz": corner, "order": 2.0, "zero_phase": both_ways}
        return {"sensors": {**sensors, "filter": own, **of_base}}
    return {name: between({"proportional": PROPORTIONAL, "drift": DRIFT}[name])}


def autoregressive(count: int, coefficient: float, rng: np.random.Generator) -> FloatArray:
    """x_k = coefficient x_{k-1} + white, of unit variance from the first sample on."""
    white = np.sqrt(1.0 - coefficient**2) * rng.normal(size=count)
    white[0] = rng.normal()
    return np.asarray(lfilter([1.0], [1.0, -coefficient], white))


def pink(count: int, rng: np.random.Generator) -> FloatArray:
    """Noise whose density is in proportion to 1/f from the first harmonic of the record on, of unit variance."""
    frequencies = np.fft.rfftfreq(count)
    amplitude = np.zeros(frequencies.size)
    amplitude[1:] = 1.0 / np.sqrt(frequencies[1:])
    spectrum = amplitude * (rng.normal(size=frequencies.size) + 1j * rng.normal(size=frequencies.size))
    found = np.fft.irfft(spectrum, count)
    return np.asarray(found / np.std(found))
