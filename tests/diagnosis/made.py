"""Simulated recordings, for tests of the diagnosis.

The lanes make them unless a test asks for the plain reference: both agree to some 1e-6 of the peak
(`tests.models.mechanisms`), and the noise is 1e-2 of it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import lru_cache

import numpy as np
from scipy.signal import butter, sosfiltfilt

import models
from diagnosis.data.measured import Measured
from diagnosis.fit.misfit import Misfit
from diagnosis.fit.prediction import Predictor
from diagnosis.fit.solver import Fitted
from diagnosis.fit.unknowns import of_specimen
from diagnosis.fit.whitening import sensor_noise_only
from diagnosis.progress import silent
from diagnosis.search.found import Search
from diagnosis.search.select import first_effect, further_effects
from grids.instruments import moved, recorded
from grids.instruments.base import Surroundings
from grids.recordings.base import Recording
from grids.specimen import Specimen
from models.shaking import Shaking

TIME_STEP = 0.005
ATTEMPTS = 10
OVERTURNS = 1.0
"""rad, that only an overturned block reaches."""
PEAK = 0.1
"""rad, over which levels of instruments are given."""
TRUE = {"width": 0.2505, "height": 1.795, "mass": 540.0}
SPECIMEN = Specimen(
    title="test block",
    model="housner",
    parameters={"width": 0.25, "height": 1.8, "mass": 540.0},
    tolerance={"width": 0.005, "height": 0.005},
)


def searched(found: Search) -> Search:
    """A search gone through all its stages."""
    for stages in (first_effect, further_effects):
        for stage in stages(found, silent):
            found = stage
    return found


def misfit(measured: Measured) -> Misfit:
    """Of the specimen, its mass known, against white noise of the sensors."""
    predictor = Predictor(measured)
    unknowns = of_specimen(SPECIMEN, measured.model)
    return Misfit(predictor, sensor_noise_only(predictor), unknowns, {"mass": TRUE["mass"]})


def at_truth(measured: Measured) -> Fitted:
    """The base model at the true parameters and the measured states, not fitted."""
    one = misfit(measured)
    u = np.array([x.coordinate(TRUE[x.name]) for x in one.unknowns])
    each = one.losses(one.residuals([one.point(u, measured.states)]))[0]
    return Fitted(one, u, measured.states, each, float(each.sum()))


def motion(seed: int, duration: float = 9.0, pga: float = 3.0) -> Shaking:
    """Noise between .6 and 6 Hz under an envelope."""
    rng = np.random.default_rng(seed)
    count = round(duration / TIME_STEP) + 1
    time = np.arange(count) * TIME_STEP
    band = butter(3, [0.6, 6.0], "band", fs=1.0 / TIME_STEP, output="sos")
    signal = sosfiltfilt(band, rng.normal(size=count)) * np.minimum(1.0, time) * np.exp(-time / duration)
    signal[-1] = signal[0] = 0.0
    return Shaking(TIME_STEP, signal * pga / np.max(np.abs(signal)))


def as_read(base: Shaking, effect: Mapping[str, Mapping[str, float]]) -> Shaking:
    """A base that comes back to rest as an accelerometer with a wrong zero reads it."""
    zero = effect.get("accelerometer_offset", {}).get("offset", 0.0)
    return replace(base, horizontal=base.horizontal + zero)


@lru_cache(maxsize=32)
def _made(
    name: str, seed: int, effect: tuple[tuple[str, tuple[tuple[str, float], ...]], ...], noise: float, integrator: str
) -> Recording:
    mechanisms = {k: dict(v) for k, v in effect}
    measured = as_read(motion(seed), mechanisms)
    model = models.get("housner")
    of_wall = {f"{m}.{k}": v for m, values in mechanisms.items() for k, v in values.items() if m in model.mechanisms}
    ran = model.simulate(
        {**TRUE, **of_wall}, moved(measured, mechanisms), duration=measured.duration, integrator=integrator
    )
    return _seen(name, seed, measured, np.ravel(ran.channels["rotation_1"]), mechanisms, noise)


def _seen(
    name: str,
    seed: int,
    measured: Shaking,
    rotation: np.ndarray,
    mechanisms: Mapping[str, Mapping[str, float]],
    noise: float,
    errors: Callable[[np.random.Generator, int], np.ndarray] | None = None,
) -> Recording:
    """What the instruments record: the rotation with white noise, or with ``errors`` (of unit deviation)."""
    true = {"rotation_1": rotation}
    around = Surroundings(TIME_STEP, moved(measured, mechanisms).horizontal, PEAK)
    seen = recorded(true, mechanisms, around)["rotation_1"]
    rng = np.random.default_rng(seed + 1000)
    peak = float(np.max(np.abs(seen)))
    channels = {
        "base_acceleration_x": measured.horizontal + 0.003 * measured.pga * rng.normal(size=seen.size),
        "rotation_1": seen + noise * peak * (rng.normal(size=seen.size) if errors is None else errors(rng, seen.size)),
    }
    return Recording(name, TIME_STEP, np.arange(seen.size) * TIME_STEP, channels)


def recording(
    name: str,
    seed: int,
    effect: Mapping[str, Mapping[str, float]] | None = None,
    noise: float = 0.01,
    integrator: str = "lanes",
) -> Recording:
    """The recording of a block with an effect, at 1 % noise of the peak."""
    frozen = tuple((k, tuple(v.items())) for k, v in (effect or {}).items())
    return _made(name, seed, frozen, noise, integrator)


def scattered(
    name: str,
    seed: int,
    scatter: float = 0.0,
    noise: float = 0.01,
    errors: Callable[[np.random.Generator, int], np.ndarray] | None = None,
    still: float = 1.5,
) -> Recording:
    """The plain block's recording with a laboratory's errors: impacts that scatter, and noise of any colour.

    It begins with ``still`` s without shaking. The rate is changed at the first sample after each impact.
    """
    plain = motion(seed)
    lead = np.zeros(round(still / TIME_STEP))
    measured = Shaking(TIME_STEP, np.concatenate([lead, plain.horizontal, lead]))
    rng = np.random.default_rng(seed + 2000)
    for _ in range(ATTEMPTS):
        rotation = _with_kicks(measured, scatter, rng)
        if np.max(np.abs(rotation)) < OVERTURNS:
            return _seen(name, seed, measured, rotation, {}, noise, errors)
    raise ValueError(f"the block overturns under motion {seed}: take another")


def _with_kicks(measured: Shaking, scatter: float, rng: np.random.Generator) -> np.ndarray:
    """Rotation of the plain block whose rate is changed at random after every impact."""
    model = models.get("housner")
    rotation, start, initial = np.zeros(measured.horizontal.size), 0, None
    while True:
        left = Shaking(TIME_STEP, measured.horizontal[start:])
        ran = model.simulate(TRUE, left, initial=initial, duration=left.duration)
        angle, rate = (np.ravel(ran.channels[c]) for c in ("rotation_1", "rotation_rate_1"))
        rotation[start:] = angle
        turns = np.flatnonzero(angle[1:] * angle[:-1] < 0.0)
        if not scatter or not turns.size or start + turns[0] + 4 > rotation.size:
            return rotation
        k = int(turns[0]) + 1
        start += k
        initial = {"rotation_1": float(angle[k]), "rotation_rate_1": float(rate[k] * (1.0 + scatter * rng.normal()))}
