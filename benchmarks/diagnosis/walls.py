"""Concealed cases of a wall and a block on top between rubber layers, by seed: what is asked for, and how it is made.

The motions of every other case, and of those with a law outside the catalogue, are those of `fibre_wall`, a program
apart; the others are those of the lanes of `interface` at an eighth of the shaking's step. Half of the cases have one
of a laboratory's errors (`imperfections`) besides. A motion is scaled so that the wall without the effect turns 1.5 to
8 times as far as it does when its base begins to lift.

Nominal size: 10 times the noise (rms over windows and rotations) is what the effect changes in windows that start from
the true rotations, less what a linear refit of layers, height and length takes up.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from benchmarks.diagnosis import fibre_wall, imperfections, instruments, shakings, suite
from benchmarks.diagnosis.cases import LOW_PASS, RECORDINGS, Case, drawn
from benchmarks.diagnosis.imperfections import Imperfections
from benchmarks.diagnosis.open_laws import LAWS, Law
from benchmarks.diagnosis.scene import FloatArray, Unsuitable
from benchmarks.diagnosis.unseen_laws import UNSEEN
from models.interface.model import MODEL
from models.runs import Prescribed
from models.shaking import Shaking

TOLERANCE = {
    "wall_length": 0.005, "wall_height": 0.005, "wall_mass": 0.01, "top_length": 0.005, "top_height": 0.005,
    "top_mass": 0.005, "layer_thickness": 0.01,
}  # fmt: skip
RANGES = {
    "base_stiffness": (1.5e7, 1.6e8), "top_stiffness": (1.5e7, 1.6e8), "base_damping": (1.0e4, 1.0e7),
    "top_damping": (1.0e4, 1.0e7),
}  # fmt: skip
REFITTED = {"wall_length": 0.005, "wall_height": 0.005, **dict.fromkeys(RANGES, np.inf)}
"""Parameters that a refit moves, with their relative tolerances."""
ROTATIONS = ("rotation_1", "rotation_2")
HELD = (*ROTATIONS, "rotation_rate_1", "rotation_rate_2")
OVER_UPLIFT = (1.5, 8.0)
SCALES = np.geomspace(0.3, 6.0, 24)
NOMINAL, WITHIN = 10.0, 0.1
SHARES = np.geomspace(0.01, 1.0, 12)
BEYOND = np.geomspace(0.01, 100.0, 23)
"""Shares tried of a law outside the catalogue, whose range is one of free-standing blocks."""
NOISE = 0.01
COUNTS: dict[suite.Kind, int] = {"null": 60, "single": 84, "pair": 20, "open": 20}
ERRORS = (*imperfections.COLOURS, *imperfections.OTHERS)
"""A laboratory's errors of walls: nothing that scatters."""
COARSE = 32
"""Fibres with which the size of a law outside the catalogue is sought."""


@dataclass(frozen=True)
class Hidden:
    """A row of the catalogue: class, primary parameter, its null, the ends of its range, how the others are drawn."""

    effect_class: str
    parameter: str
    null: float
    ends: tuple[float, ...]
    sensor: bool = False
    shapes: Callable[[np.random.Generator], dict[str, float]] = lambda rng: {}


CATALOGUE: dict[str, Hidden] = {
    "maxwell": Hidden(
        "maxwell", "arm_stiffness_ratio", 0.0, (1.5,),
        shapes=lambda rng: {"relaxation_time": float(np.exp(rng.uniform(np.log(0.02), np.log(0.3))))},
    ),
    "hardening": Hidden("hardening", "beta2", 0.0, (80.0,)),
    "mullins": Hidden(
        "mullins", "softening", 0.0, (0.7,), shapes=lambda rng: {"strain": float(rng.uniform(0.1, 0.5))}
    ),
    "bouc_wen": Hidden(
        "bouc_wen", "post_yield_ratio", 1.0, (0.2,),
        shapes=lambda rng: {
            "yield_compression": float(rng.uniform(5e-4, 3e-3)), "exponent": float(rng.choice([1.0, 2.0])),
        },
    ),
    "pivot_inset": Hidden("contact_geometry", "inset_over_half_width", 0.0, (0.35,)),
    "one_sided_stiffness": Hidden("one_sided_stiffness", "right_over_left", 1.0, (0.5, 2.0)),
    "added_stiffness": Hidden("added_stiffness", "couple_stiffness", 0.0, (-1e6, 5e6)),
    "viscous_damping": Hidden("viscous_damping", "couple_damping", 0.0, (5e5,)),
    "coulomb_damping": Hidden("coulomb_damping", "over_m_g_b", 0.0, (0.1,)),
    "tilt": Hidden("tilt", "tilt", 0.0, (-0.05, 0.05)),
    "eccentricity": Hidden("tilt", "offset_top", 0.0, (-0.2, 0.2)),
    "offset": Hidden("offset", "offset_over_peak", 0.0, (-0.15, 0.15), sensor=True),
    "delay": Hidden("delay", "delay", 0.0, (0.04,), sensor=True),
    "accelerometer_offset": Hidden("tilt", "offset", 0.0, (-0.5, 0.5), sensor=True),
}  # fmt: skip
"""Without gains: beside a refit, one of 12 % leaves 1 to 3 times the noise, one of the base of 15 % .4 to 2."""


@dataclass(frozen=True)
class WallDesign(suite.CaseDesign):
    """What a case of a wall is to hold."""


def designs(seed: int) -> list[suite.CaseDesign]:
    """All cases in mixed order; every effect as often as every other one, pairs of two classes at random.

    Every second case of a kind has one of a laboratory's errors, in turn. Laws outside the catalogue are those kept for
    the evaluation at its seed, the others at any other.
    """
    rng = np.random.default_rng(seed)
    laws = [name for name, law in (UNSEEN if seed == suite.EVALUATION_SEED else LAWS).items() if fibre_wall.knows(law)]
    groups: list[list[tuple[suite.Kind, tuple[str, ...], str]]] = []
    for kind, count in COUNTS.items():
        chosen = _pairs(count, rng) if kind == "pair" else suite.names_of(kind, count, list(CATALOGUE), laws, rng)
        errors = [str(one) for _ in range(count) for one in rng.permutation(ERRORS)]
        groups.append([(kind, names, errors[k // 2] if k % 2 else "") for k, names in enumerate(chosen)])
    return [
        WallDesign(number, kind, chosen, NOISE, 1.0, error)
        for number, (kind, chosen, error) in enumerate(suite.in_mixed_order(groups, rng))
    ]


def _pairs(count: int, rng: np.random.Generator) -> list[tuple[str, ...]]:
    """Pairs of two classes."""
    found: list[tuple[str, ...]] = []
    while len(found) < count:
        one, other = rng.choice(list(CATALOGUE), 2, replace=False).tolist()
        if CATALOGUE[one].effect_class != CATALOGUE[other].effect_class:
            found.append((one, other))
    return found


def make(design: suite.CaseDesign, seed: int) -> Case:
    """The case, the same for the same design and seed. Raises RuntimeError when no draw was suitable."""
    return drawn(design, seed, _case)


@dataclass(frozen=True)
class Truth:
    """A wall, what is missing in it, and the program that moves it: `fibre_wall` (``apart``), or the lanes."""

    wall: Mapping[str, float]
    mechanisms: Mapping[str, float]
    apart: bool
    law: Law | None = None
    numbers: tuple[float, ...] = (0.0,) * 7
    largest: float = 1.0

    def rotations(self, shaking: Shaking, fibres: int = fibre_wall.FIBRES) -> dict[str, FloatArray]:
        """Rotations (rad) and their rates at the shaking's steps. Raises Unsuitable where a body falls."""
        if not self.apart:
            channels = MODEL.simulate({**self.wall, **self.mechanisms}, shaking).channels
            return {name: channels[name] for name in HELD}
        try:
            found = fibre_wall.run(
                self.wall, shaking.horizontal, shaking.time_step, self.mechanisms, self.law, self.numbers, self.largest,
                fibres,
            )  # fmt: skip
        except np.linalg.LinAlgError as error:  # it fell, far
            raise Unsuitable from error
        if not np.isfinite(found).all():
            raise Unsuitable
        rates = np.gradient(found, shaking.time_step, axis=1)
        return dict(zip(HELD, (*found, *rates), strict=True))


def _case(design: suite.CaseDesign, seed: int, rng: np.random.Generator) -> Case:
    nominal, true = _wall(rng)
    sampling = float(rng.choice(list(LOW_PASS)))
    drawn = [_motion(true, rng, LOW_PASS[sampling]) for _ in RECORDINGS]
    peak = drawn[0][2]
    apart = design.number % 2 == 0 or design.kind == "open"
    errors = Imperfections()
    if design.imperfection:
        errors = imperfections.draw(design.imperfection, design.names, sampling, rng)
    truth, sensors, effects = Truth(true, {}, apart), {}, []
    if design.kind == "open":
        truth, size = _law({**LAWS, **UNSEEN}[design.names[0]], truth, drawn, rng)
        effects = [{"name": design.names[0], "class": "open", "parameters": {"size": size}}]
    else:
        found = [_sized(CATALOGUE[name], name, true, drawn, rng) for name in design.names]
        wall = {f"{n}.{k}": v for n, p in found if not CATALOGUE[n].sensor for k, v in p.items()}
        truth, sensors = replace(truth, mechanisms=wall), {n: p for n, p in found if CATALOGUE[n].sensor}
        effects = [
            {"name": n, "class": CATALOGUE[n].effect_class, "parameters": p, "primary": CATALOGUE[n].parameter}
            for n, p in found
        ]
    channels, notes = {}, {}
    for name, (source, shaking, _) in zip(RECORDINGS, drawn, strict=True):
        channels[name], noise = _recorded(truth, sensors, errors, shaking, sampling, peak, design.noise, rng)
        notes[name] = {"motion": source, "pga": shaking.pga, "noise_std": noise, "duration": shaking.duration}
    key = {
        "kind": design.kind, "model": MODEL.name, "seed": seed, "number": design.number,
        "noise_fraction_of_peak": design.noise, "relative_size": 1.0, "sampling_hz": sampling, "weak": False,
        "effects": effects, "over_peak": peak, "true_parameters": true, "recordings": notes, "program_apart": apart,
        "imperfections": errors.described(), "named_rightly": errors.named_rightly,
    }  # fmt: skip
    return Case(_specimen(design.label, nominal), sampling, channels, key)


def _wall(rng: np.random.Generator) -> tuple[dict[str, float], dict[str, float]]:
    """Nominal and true values of a wall of hollow masonry, .7 to 2.2 m long, under a heavy top."""
    length = round(float(rng.uniform(0.7, 2.2)), 2)
    height = round(float(rng.uniform(1.5, 2.4)), 2)
    nominal = {
        "wall_length": length, "wall_height": height, "wall_mass": round(124.0 * length * height, 0),
        "top_length": length, "top_height": round(float(rng.uniform(0.4, 0.7)), 2),
        "top_mass": round(float(rng.uniform(3000.0, 6000.0)), -2), "layer_thickness": 0.01,
    }  # fmt: skip
    true = {name: value * (1.0 + TOLERANCE[name] * float(rng.normal())) for name, value in nominal.items()}
    layers = {f"{joint}_stiffness": float(np.exp(rng.uniform(np.log(3e7), np.log(8e7)))) for joint in ("base", "top")}
    true |= layers
    omega = 2.0 * np.pi * float(MODEL.derive({**true, "base_damping": 0.0, "top_damping": 0.0})["frequency_1"][0])
    for joint in ("base", "top"):
        true[f"{joint}_damping"] = 2.0 * float(rng.uniform(0.03, 0.1)) * layers[f"{joint}_stiffness"] / omega
    if not all(low < true[name] < high for name, (low, high) in RANGES.items()):
        raise Unsuitable
    return nominal, true


def _motion(true: Mapping[str, float], rng: np.random.Generator, low_pass: float) -> tuple[str, Shaking, float]:
    """A motion at a scale at which the wall without effects lifts well; its largest rotation (rad)."""
    source, unit = shakings.draw(rng, low_pass)
    unit = Shaking(unit.time_step, unit.horizontal)
    found = MODEL.evaluate(true, unit, SCALES, outputs=("peak_rotation_1", "overturned"), tail=0.0)
    ratio = found["peak_rotation_1"] / MODEL.derive(true)["uplift_rotation"][0]
    good = np.flatnonzero((ratio > OVER_UPLIFT[0]) & (ratio < OVER_UPLIFT[1]) & (found["overturned"] == 0))
    if not good.size:
        raise Unsuitable
    chosen = int(rng.choice(good))
    return source, shakings.scaled(unit, float(SCALES[chosen]), False), float(found["peak_rotation_1"][chosen])


def _sized(
    row: Hidden, name: str, true: Mapping[str, float], drawn: Sequence[tuple[str, Shaking, float]],
    rng: np.random.Generator,
) -> tuple[str, dict[str, float]]:  # fmt: skip
    """The effect at nominal size, by bisection between shares of the way to the end of its range."""
    end, shapes, peak = float(rng.choice(row.ends)), row.shapes(rng), drawn[0][2]

    def at(share: float) -> dict[str, float]:
        return {row.parameter: row.null + share * (end - row.null), **shapes}

    def size(share: float) -> float:
        sensors = {name: at(share)} if row.sensor else {}
        wall = {} if row.sensor else {f"{name}.{k}": v for k, v in at(share).items()}
        return max(strength(Truth(true, wall, False), sensors, shaking, peak) for _, shaking, _ in drawn[:2])

    return name, at(_nominal(size))


def _law(
    law: Law, plain: Truth, drawn: Sequence[tuple[str, Shaking, float]], rng: np.random.Generator
) -> tuple[Truth, float]:
    """The wall with a law outside the catalogue at nominal size, and that size."""
    end = law.end * (float(rng.choice([-1.0, 1.0])) if law.either else 1.0)
    numbers, peak, length = law.draw(rng), drawn[0][2], min(shaking.duration for _, shaking, _ in drawn)
    begin = float(rng.uniform(0.25, 0.5)) * length
    interval = begin, begin + float(rng.uniform(0.15, 0.3)) * length

    def at(share: float) -> Truth:
        return replace(plain, law=law, numbers=(share * end, *numbers, *interval, 0.0), largest=peak)

    share = _nominal(
        lambda share: max(strength(at(share), {}, shaking, peak, COARSE) for _, shaking, _ in drawn[:2]), BEYOND
    )
    return at(share), share * end


def _nominal(size: Callable[[float], float], shares: FloatArray = SHARES) -> float:
    """Share of the way to the end of a range at which the effect has nominal size."""
    low = 0.0
    for share in shares.tolist():
        if size(share) < NOMINAL:
            low = share
            continue
        high = share
        for _ in range(8):
            middle = 0.5 * (low + high)
            found = size(middle)
            if abs(found / NOMINAL - 1.0) < WITHIN:
                return middle
            low, high = (middle, high) if found < NOMINAL else (low, middle)
        raise Unsuitable
    raise Unsuitable


def strength(
    truth: Truth, sensors: instruments.Sensors, shaking: Shaking, peak: float, fibres: int = fibre_wall.FIBRES
) -> float:
    """Of an effect in one recording, over its noise."""
    true, step = truth.wall, shaking.time_step
    channels = truth.rotations(shaking, fibres)
    base = instruments.base(shaking.horizontal, step, sensors)
    seen = np.stack([instruments.response(channels[c], shaking.horizontal, step, sensors, peak) for c in ROTATIONS])
    noise = NOISE * np.max(np.abs(seen), axis=1)
    period = 1.0 / float(MODEL.derive(true)["frequency_1"][0])
    samples = round(max(0.4, 1.5 * period) / step)
    first = np.arange(0, shaking.horizontal.size - samples, samples)
    first = first[[np.max(np.abs(seen[0, k : k + samples])) > 8.0 * noise[0] for k in first]]
    if not first.size:
        return 0.0
    names, measured = list(REFITTED), Shaking(step, base)
    changes = np.ones((1 + 2 * len(names), len(names)))
    for k in range(len(names)):
        changes[1 + 2 * k : 3 + 2 * k, k] += [1e-2, -1e-2]
    varied = {**true, **{name: true[name] * changes[:, k] for k, name in enumerate(names)}}
    lanes = changes.shape[0]
    motion = {name: channels[name][None] for name in HELD}
    carried = MODEL.carry(varied, measured, Prescribed(motion, first, np.zeros(lanes, np.int64)))
    initial = {name: np.tile(channels[name][first], lanes) for name in HELD}
    initial |= {name: x.reshape(-1, *x.shape[2:]) for name, x in carried.items()}
    each = {name: np.repeat(value, first.size) if np.ndim(value) else value for name, value in varied.items()}
    ran = MODEL.trajectories(each, measured, first=np.tile(first, lanes), samples=samples, initial=initial)
    index = first[:, None] + np.arange(samples)
    predicted = np.stack([ran[c].reshape(lanes, -1) / s for c, s in zip(ROTATIONS, noise, strict=True)], axis=1)
    wanted = np.stack([x[index].ravel() / s for x, s in zip(seen, noise, strict=True)]) - predicted[0]
    columns = ((predicted[1::2] - predicted[2::2]) / 2e-2).reshape(len(names), -1).T
    rows = np.vstack([columns, np.diag([1.0 / tolerance for tolerance in REFITTED.values()])])
    change = np.linalg.lstsq(rows, np.concatenate([wanted.ravel(), np.zeros(len(names))]), rcond=None)[0]
    return float(np.sqrt(np.mean((wanted.ravel() - columns @ change) ** 2)))


def _recorded(
    truth: Truth, sensors: instruments.Sensors, errors: Imperfections, shaking: Shaking, sampling: float, peak: float,
    noise: float, rng: np.random.Generator,
) -> tuple[dict[str, FloatArray], dict[str, float]]:  # fmt: skip
    """Channels as written to the file, and the standard deviation of the noise in each."""
    fine = shakings.on_fine_grid(shaking)
    ran, seen = truth.rotations(fine), {**sensors, **errors.sensors}
    base = instruments.base(fine.horizontal, fine.time_step, seen)
    share, largest = float(rng.uniform(0.002, 0.005)), float(np.max(np.abs(base)))
    sampled = instruments.logged(base, fine.time_step, sampling, shaking.duration)
    deviations = {"base_acceleration_x": share * largest}
    channels = {"base_acceleration_x": sampled + share * largest * rng.normal(size=sampled.size)}
    for name in ROTATIONS:
        signal = instruments.response(ran[name], fine.horizontal, fine.time_step, seen, peak)
        largest = float(np.max(np.abs(signal)))
        sampled = instruments.logged(signal, fine.time_step, sampling, shaking.duration)
        deviations[name] = noise * largest
        channels[name] = sampled + errors.noise(sampled, 1.0 / sampling, noise, largest, rng)
    return channels, deviations


def _specimen(label: str, nominal: Mapping[str, Any]) -> str:
    lines = [f'title = "{label}"', f'model = "{MODEL.name}"', "", "[parameters]"]
    lines += [f"{name} = {value!r}" for name, value in nominal.items()]
    lines += ["", "[tolerance]", *(f"{name} = {value!r}" for name, value in TOLERANCE.items())]
    lines += ["", "[calibrate]", *(f"{name} = [{low!r}, {high!r}]" for name, (low, high) in RANGES.items())]
    return "\n".join(lines) + "\n"
