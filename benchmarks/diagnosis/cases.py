"""Concealed cases of one block, by seed: what is asked for, and how it is made.

A case is a folder in the format of the concealed recordings (specimen.toml, train_1.nc, train_2.nc,
test_1.nc) and, elsewhere, its key. The truth of a catalogue effect comes from the model's plain reference
(`models.housner.reference.run`, DOP853); that of a law outside the catalogue, and every one with a laboratory's
`imperfections` or an effect that begins, from `truth`, a program of its own. Sizes follow `size`. A motion is
scaled so that the block without the effect reaches .1-.5 alpha and impacts more than 8 times without overturning;
with the effect it must still rock.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import chain
from typing import Any

import numpy as np

from benchmarks.diagnosis import beginnings, imperfections, shakings, size, specimens, truth
from benchmarks.diagnosis.effects import CATALOGUE, Hidden
from benchmarks.diagnosis.open_laws import Law
from benchmarks.diagnosis.scene import FEWEST_IMPACTS, Effects, FloatArray, Scene, Track, Unsuitable
from benchmarks.diagnosis.suite import CaseDesign
from benchmarks.diagnosis.unseen_laws import EVERY_LAW
from models.housner.lanes import run as lanes
from models.housner.model import MODEL
from models.runs import Request
from models.shaking import Shaking

RECORDINGS = ("train_1", "train_2", "test_1")
LOW_PASS = {100.0: 14.0, 200.0: 22.0, 250.0: 25.0, 500.0: 30.0}
"""Motion's corner (Hz) by sampling frequency (Hz)."""
PEAK = (0.1, 0.5)
SCALES = np.geomspace(1.05, 6.0, 40)
"""PGA over the onset acceleration that are tried."""
ATTEMPTS = 60
SHARES = np.geomspace(1.0 / 100.0, 1.0, 40)
"""Shares of the way to the end of a range that are tried for nominal size."""
WITHIN = 0.1
"""Of nominal size, in the search with fast runs."""
EXACT_WITHIN = 0.25
"""Of nominal size, on the motion of the case itself."""
MOST_JUMPS = 3
"""Steps over nominal size after which the draw is given up."""
WEAKEST = 3.0
WEAKEST_OF_PEAK = 0.03
"""Size at the end of the range, and the same over the peak, under which the draw is given up."""
SEEN = 0.5
"""Of nominal size, what an effect that begins or ends must have in the recording in which it does."""
TAIL = 1.0
VERTICAL_SHARE = 0.2
"""Of the cases in which the base also shakes vertically, and the specimen says so."""


@dataclass(frozen=True)
class Case:
    """A finished case: recorded channels by recording and name, and the key."""

    specimen: str
    sampling_hz: float
    channels: Mapping[str, Mapping[str, FloatArray]]
    key: Mapping[str, Any]


def make(design: CaseDesign, seed: int) -> Case:
    """The case, the same for the same design and seed. Raises RuntimeError when no draw was suitable."""
    return drawn(design, seed, lambda design, seed, rng: _Draft(design, rng).case(seed))


def drawn(design: CaseDesign, seed: int, draw: Callable[[CaseDesign, int, np.random.Generator], Case]) -> Case:
    """The first suitable case that ``draw`` gives for a design and seed. Raises RuntimeError when none was."""
    rng = np.random.default_rng([seed, design.number])
    for _ in range(ATTEMPTS):
        try:
            return draw(design, seed, rng)
        except Unsuitable:
            continue
    raise RuntimeError(f"{design.label} ({design.kind} {design.names}): no suitable draw in {ATTEMPTS}")


def _alone(row: Hidden, value: float, shapes: Mapping[str, float], when: beginnings.When | None) -> Effects:
    """One effect of the catalogue."""
    numbers = {row.parameter: value, **shapes}
    if row.sensor:
        return Effects({}, {row.name: numbers}, when=when)
    return Effects({f"{row.name}.{k}": v for k, v in numbers.items()}, {}, when=when)


def _cycle(rotation: FloatArray, step: float, instants: Sequence[float]) -> float:
    """Two swings at an instant, in s: twice the longest time between impacts around it, of several the longest."""
    times = step * np.flatnonzero(rotation[1:] * rotation[:-1] < 0.0)
    around = [int(np.searchsorted(times, instant)) for instant in instants]
    return 2.0 * max((float(np.max(np.diff(times)[max(0, k - 2) : k + 1], initial=0.0)) for k in around), default=0.0)


class _Draft:
    """One attempt at a case."""

    def __init__(self, design: CaseDesign, rng: np.random.Generator) -> None:
        self.design, self.rng = design, rng
        self.block = specimens.draw(rng)
        self.sampling_hz = float(rng.choice(list(LOW_PASS)))
        left_out = "vertical_acceleration" in design.names
        plain = design.kind != "open" and not design.imperfection and not design.beginning and not left_out
        acts = plain and rng.uniform() < VERTICAL_SHARE
        self.vertical_channel, self.vertical_acts = left_out or acts, acts
        tracks = [self._track() for _ in RECORDINGS]
        if "saturation" in design.names:  # its level refers to the first training recording, the largest one
            tracks[:2] = sorted(tracks[:2], key=lambda track: -track.plain_peak)
        errors = None
        if design.imperfection:
            errors = imperfections.draw(design.imperfection, design.names, self.sampling_hz, rng)
        motions = [track.shaking for track in tracks]
        self.when = beginnings.draw(design.beginning, motions, rng) if design.beginning else None
        self.scene = Scene(self.block, tuple(tracks), acts, self.sampling_hz, design.noise, errors)

    def _track(self) -> Track:
        """A motion at a scale, drawn among those at which the block without effects rocks well."""
        name, unit = shakings.draw(self.rng, LOW_PASS[self.sampling_hz])
        true = self.block.true
        onset = specimens.GRAVITY * true["width"] / true["height"]
        if not self.vertical_channel:
            unit = Shaking(unit.time_step, unit.horizontal)
        block = MODEL.build(true, vertical=self.vertical_acts, size=SCALES.size)
        found = lanes.run(block, Request(unit, onset * SCALES, tail=TAIL)).outputs
        ratio = found["peak_rotation_ratio"]
        good = (ratio > PEAK[0]) & (ratio < PEAK[1]) & (found["impacts"] > FEWEST_IMPACTS) & ~found["overturned"]
        if not np.any(good):
            raise Unsuitable
        chosen = int(self.rng.choice(np.flatnonzero(good)))
        shaking = shakings.scaled(unit, onset * float(SCALES[chosen]), self.vertical_channel)
        return Track(name, shaking, float(found["peak_rotation"][chosen]))

    def case(self, seed: int) -> Case:
        peak = self.scene.tracks[0].plain_peak
        effects, described, weak = self._effects(peak)
        errors = self.scene.imperfections
        scatters = errors is not None and errors.scatter > 0.0
        kicks = [errors.kicks(truth.MOST_IMPACTS, self.rng) if errors else None for _ in RECORDINGS]
        motions = [self.scene.truth(k, effects, exact=True, kicks=kicks[k]) for k in range(len(RECORDINGS))]
        channels: dict[str, Mapping[str, FloatArray]] = {}
        notes: dict[str, dict[str, Any]] = {}
        scale = self._sensor_peak(effects, peak, motions)
        for k, name in enumerate(RECORDINGS):
            rotation, _, impacts = motions[k]
            if not self.scene.rocks(rotation, impacts):
                raise Unsuitable
            largest = float(np.max(np.abs(rotation))) / self.scene.alpha
            repeatable = self.scene.truth(k, effects, exact=True) if scatters else motions[k]
            strength = self.scene.strength(
                k, effects, repeatable[0][:: shakings.FINE], repeatable[1][:: shakings.FINE], scale
            )
            channels[name], noise = self.scene.recorded(k, effects, rotation, scale, self.rng)
            track = self.scene.tracks[k]
            notes[name] = {
                "motion": track.motion, "pga": track.shaking.pga, "peak_over_alpha": largest,
                "impacts": impacts, "noise_std": noise, "strength": strength,
            }  # fmt: skip
            if effects.active:
                notes[name]["active_interval"] = effects.active[k]
            if effects.when is not None:
                notes[name] |= {"duration": track.shaking.duration, "active": effects.when[k]}
                step, end = track.shaking.time_step / shakings.FINE, track.shaking.duration
                instants = [[one for one in span if 0.0 < one < end] for span in effects.when[k]]
                notes[name]["cycles"] = [_cycle(rotation, step, some) for some in instants]
                if k < 2 and not weak and not self._seen(k, motions[k], [*chain(*instants)], notes[name]):
                    raise Unsuitable
        exact = max(notes[name]["strength"] for name in RECORDINGS[:2])
        if described and len(described) == 1 and not weak and self.design.relative_size == 1.0:
            if not abs(exact / size.NOMINAL - 1.0) < EXACT_WITHIN:
                raise Unsuitable
        key = {
            "kind": self._kind, "model": "housner", "seed": seed, "number": self.design.number,
            "noise_fraction_of_peak": self.design.noise, "relative_size": self.design.relative_size,
            "sampling_hz": self.sampling_hz, "weak": weak, "effects": described, "over_peak": scale,
            "true_parameters": dict(self.block.true), "recordings": notes,
        }  # fmt: skip
        if self.design.beginning:
            key["beginning"] = self.design.beginning
        if errors is not None:
            key |= {"imperfections": errors.described(), "named_rightly": errors.named_rightly}
        return Case(self._specimen(), self.sampling_hz, channels, key)

    def _seen(
        self, k: int, motion: tuple[FloatArray, FloatArray, int], instants: Sequence[float], note: Mapping[str, Any]
    ) -> bool:
        """Whether the recordings can tell the instants (s) of recording ``k``.

        The effect has to show in that recording, and the block to rock before and after each of them.
        """
        step = self.scene.tracks[k].shaking.time_step / shakings.FINE
        found = size.windows(*motion[:2], step, note["noise_std"]["rotation_1"])
        begins, ends = step * found.first, step * (found.first + found.samples)
        if instants and note["strength"] < SEEN * size.NOMINAL:
            return False
        return all(bool(np.any(ends < one)) and bool(np.any(begins > one)) for one in instants)

    def _specimen(self) -> str:
        lines = [f'title = "{self.design.label}"', 'model = "housner"', "", "[parameters]"]
        lines += [f"{name} = {value!r}" for name, value in self.block.nominal.items()]
        lines += ["", "[tolerance]", *(f"{name} = {value!r}" for name, value in specimens.TOLERANCE.items())]
        if self.vertical_acts:
            lines += ["", "[motion]", "vertical = true"]
        return "\n".join(lines) + "\n"

    # what is hidden

    def _effects(self, peak: float) -> tuple[Effects, list[dict[str, Any]], bool]:
        """The effects at their sizes, as the key tells them, and whether one could not reach its size."""
        if self.design.kind == "open":
            return self._open(EVERY_LAW[self.design.names[0]], peak)
        both, described, weak = Effects({}, {}, when=self.when), [], False
        for name in self.design.names:
            row = CATALOGUE[name]
            given = beginnings.BEGINNINGS[self.design.beginning].ends if self.design.beginning else ()
            end = float(self.rng.choice(given or row.ends))
            if name == "sliding":  # below the slope of the diagonal the block slides and does not rock
                end = max(end, self.block.true["width"] / self.block.true["height"])
            shapes = row.shapes(self.rng, peak)

            shares = SHARES[row.smallest <= SHARES]
            share, reached = self._nominal(lambda x: _alone(row, row.at(x, end), shapes, self.when), peak, shares)  # noqa: B023
            value = row.at(share, end)
            if self.design.relative_size == 0.5:
                value = row.half(value)
            alone = _alone(row, value, shapes, self.when)
            both = replace(
                both,
                mechanisms={**both.mechanisms, **alone.mechanisms},
                sensors={**both.sensors, **alone.sensors},
            )
            described.append(
                {"name": name, "class": row.effect_class, "parameters": {row.parameter: value, **shapes},
                 "primary": row.parameter}
            )  # fmt: skip
            weak = weak or not reached
        return both, described, weak

    @property
    def _kind(self) -> str:
        """What the key says: a law that is the catalogue's, at work for a while, is no law outside."""
        return EVERY_LAW[self.design.names[0]].kind if self.design.kind == "open" else self.design.kind

    def _open(self, law: Law, peak: float) -> tuple[Effects, list[dict[str, Any]], bool]:
        end = law.end * (float(self.rng.choice([-1.0, 1.0])) if law.either else 1.0)
        numbers = law.draw(self.rng)
        active = []
        for track in self.scene.tracks:
            length = track.shaking.duration
            start = self.rng.uniform(0.25, 0.5)
            stop = (start + self.rng.uniform(0.15, 0.3)) * length
            active.append((start * length, length if law.lasts else stop))

        def with_size(share: float) -> Effects:
            return Effects({}, {}, truth.Applied(law, share * end, numbers, active[0], peak), tuple(active))

        share, reached = self._nominal(with_size, peak, SHARES)
        share *= self.design.relative_size
        return with_size(share), [law.described(share * end)], not reached

    def _nominal(self, effects_at: Callable[[float], Effects], peak: float, shares: FloatArray) -> tuple[float, bool]:
        """Share (0-1) of the way to the end of the range that has nominal size, and whether one has.

        Rocking from rest is chaotic: the peak, hence the noise, jumps with the parameter. So shares are
        tried in turn, and between the last too small one and the next. False: the range ends, or the block
        no longer rocks, before nominal size; the share is then the largest possible.
        """
        below, size_below, jumps = 0.0, 0.0, 0
        for share in shares.tolist():
            found = self.scene.size(effects_at(share), peak)
            if found < (1.0 - WITHIN) * size.NOMINAL:
                below, size_below, jumps = share, found, 0
                continue
            if found <= (1.0 + WITHIN) * size.NOMINAL:
                return share, True
            low, high = below, share
            for _ in range(4):
                middle = 0.5 * (low + high)
                found = self.scene.size(effects_at(middle), peak)
                if abs(found / size.NOMINAL - 1.0) <= WITHIN:
                    return middle, True
                low, high = (middle, high) if found < size.NOMINAL else (low, middle)
            jumps += math.isfinite(found)
            if jumps == MOST_JUMPS:
                raise Unsuitable
        # the largest share at which the block still rocks is too small
        if size_below > min(WEAKEST, WEAKEST_OF_PEAK / self.design.noise) and jumps == 0:
            return below, False
        raise Unsuitable

    def _sensor_peak(self, effects: Effects, plain: float, motions: list[tuple[FloatArray, FloatArray, int]]) -> float:
        """Largest rotation of the first recording before its sensors: without a mechanism, the plain model's."""
        return plain if not effects.mechanisms else float(np.max(np.abs(motions[0][0])))
