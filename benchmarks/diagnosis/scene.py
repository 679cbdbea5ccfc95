"""One block, its base motions and instruments: how it moves, how large an effect is, what is recorded."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from benchmarks.diagnosis import instruments, shakings, size, specimens, truth
from benchmarks.diagnosis.imperfections import Imperfections
from benchmarks.diagnosis.processing import PROCESSED
from models.housner.lanes import run as lanes
from models.housner.model import MODEL
from models.housner.reference import run as reference
from models.runs import Request
from models.shaking import Shaking

FloatArray = NDArray[np.float64]

PEAK_WITH_EFFECT = (0.06, 0.65)
"""Over alpha, and the fewest impacts: a case must rock between these."""
FEWEST_IMPACTS = 8


class Unsuitable(Exception):
    """A draw whose block hardly rocks, or overturns: another one is drawn."""


@dataclass(frozen=True)
class Track:
    """One recording in the making: the true base motion, and the largest rotation (rad) without effects."""

    motion: str
    shaking: Shaking
    plain_peak: float


@dataclass(frozen=True)
class Effects:
    """What is hidden: the block's mechanisms, the instruments' faults, or a law outside the catalogue.

    ``active``: the one interval of a law in each recording; ``when``: those of everything else, None: always.
    """

    mechanisms: Mapping[str, float]
    sensors: Mapping[str, Mapping[str, float]]
    law: truth.Applied | None = None
    active: tuple[tuple[float, float], ...] = ()
    when: tuple[tuple[tuple[float, float], ...], ...] | None = None


@dataclass(frozen=True)
class Scene:
    """A block under its base motions; ``vertical_acts``: the vertical one acts and the specimen says so.

    ``noise``: standard deviation of the rotation's noise over its peak. ``tracks`` in the order of the
    recordings, the two for training first. ``imperfections``: errors of a laboratory; with them (None: none) every
    motion comes from `truth`, which shares nothing with the models.
    """

    block: specimens.Block
    tracks: Sequence[Track]
    vertical_acts: bool
    sampling_hz: float
    noise: float
    imperfections: Imperfections | None = None

    @property
    def alpha(self) -> float:
        """Slenderness (rad)."""
        return math.atan2(self.block.true["width"], self.block.true["height"])

    def rocks(self, rotation: FloatArray, impacts: int) -> bool:
        """Whether a motion is one of a case: large enough, not too large, with enough impacts."""
        ratio = float(np.max(np.abs(rotation))) / self.alpha
        return PEAK_WITH_EFFECT[0] < ratio < PEAK_WITH_EFFECT[1] and impacts > FEWEST_IMPACTS

    def truth(
        self, k: int, effects: Effects, exact: bool, kicks: FloatArray | None = None
    ) -> tuple[FloatArray, FloatArray, int]:
        """Rotation, rate and impacts: on the fine grid by the slow route, else on that of the shaking.

        ``kicks``: scatter of the impacts (see `truth`), of a laboratory alone.
        """
        shaking = self.tracks[k].shaking
        true = self.block.true
        if effects.law is not None or effects.when is not None or self.imperfections is not None:
            law = None if effects.law is None else replace(effects.law, active=effects.active[k])
            fine = shakings.fine(shaking.horizontal)
            step = shaking.time_step / shakings.FINE
            ran = truth.run(
                true["width"], true["height"], specimens.GRAVITY, fine, step, law, effects.mechanisms,
                None if effects.when is None else effects.when[k], kicks,
            )  # fmt: skip
            every = 1 if exact else shakings.FINE
            return ran.rotation[::every], ran.rate[::every], ran.impacts
        block = MODEL.build({**true, **effects.mechanisms}, vertical=self.vertical_acts)
        if exact:
            ran = reference.run(block, Request(shakings.on_fine_grid(shaking), np.ones(1)), 1e-8)
            if ran.outputs["overturned"][0]:
                raise Unsuitable
        else:
            ran = lanes.run(block, Request(shaking, np.ones(1), samples=shaking.horizontal.size))
        return ran.samples[0, :, 0], ran.samples[0, :, 1], int(ran.outputs["impacts"][0])

    def strength(self, k: int, effects: Effects, rotation: FloatArray, rate: FloatArray, peak: float) -> float:
        """Of the effects in recording ``k``, over its noise (see `size`), from the true motion."""
        shaking = self.tracks[k].shaking
        step = shaking.time_step
        base, recorded = self._seen(k, effects, effects.sensors, shaking.horizontal, rotation, step, peak)
        noise = self.noise * float(np.max(np.abs(recorded)))
        measured = Shaking(
            step,
            base,
            shaking.vertical if self.vertical_acts else None,
        )
        windows = size.windows(rotation, rate, step, noise)
        return size.over_noise(self.block.true, specimens.TOLERANCE, measured, recorded, windows, noise)

    def _seen(
        self, k: int, effects: Effects, sensors: instruments.Sensors, base: FloatArray, rotation: FloatArray,
        step: float, peak: float,
    ) -> tuple[FloatArray, FloatArray]:  # fmt: skip
        """Signals of the base's accelerometer and of the rotation sensor, each fault in its time."""
        acts = truth.within(step * np.arange(base.size), None if effects.when is None else effects.when[k])
        return (
            np.where(acts, instruments.base(base, step, sensors), base),
            np.where(acts, instruments.response(rotation, base, step, sensors, peak), rotation),
        )

    def size(self, effects: Effects, peak: float) -> float:
        """Of the effects over the noise, from fast runs; infinite where the block no longer rocks as asked."""
        motions = [self.truth(k, effects, exact=False) for k in range(2)]
        if not all(self.rocks(rotation, impacts) for rotation, _, impacts in motions):
            return math.inf
        return max(self.strength(k, effects, motions[k][0], motions[k][1], peak) for k in range(2))

    def recorded(
        self, k: int, effects: Effects, rotation: FloatArray, peak: float, rng: np.random.Generator
    ) -> tuple[dict[str, FloatArray], dict[str, float]]:
        """Channels as written to the file, and the standard deviation of the noise in each."""
        shaking = self.tracks[k].shaking
        step = shaking.time_step / shakings.FINE
        base = shakings.fine(shaking.horizontal)
        errors = self.imperfections or Imperfections()
        sensors = {**effects.sensors, **errors.sensors}
        measured, response = self._seen(k, effects, sensors, base, rotation, step, peak)
        signals = {"base_acceleration_x": measured, "rotation_1": response}
        if shaking.vertical is not None:
            signals["base_acceleration_z"] = shakings.fine(shaking.vertical)
        fraction = float(rng.uniform(0.002, 0.005))
        channels, noise = {}, {}
        for name, signal in signals.items():
            sampled = instruments.logged(signal, step, self.sampling_hz, shaking.duration)
            if name == "rotation_1":
                sampled = instruments.clip(sampled, sensors, peak)
            share = self.noise if name == "rotation_1" else fraction
            largest = float(np.max(np.abs(signal)))
            noise[name] = share * largest
            if name == "rotation_1":
                channels[name] = sampled + errors.noise(sampled, 1.0 / self.sampling_hz, share, largest, rng)
            else:
                channels[name] = sampled + noise[name] * rng.normal(size=sampled.size)
        if errors.processing:
            channels = PROCESSED[errors.processing](channels, self.sampling_hz, rng)
        return channels, noise
