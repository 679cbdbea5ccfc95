"""Cases whose base model is the wrong one, by seed: a stack or a wall on rubber that the specimen takes for a block, a
wall on rubber that it takes for a stack, and blocks and stacks that are what the specimen says.

The motions are those of the lanes of the true model at an eighth of the shaking's step. What the laboratory measures
stands in the specimen with its tolerance; of a joint in a pier, and of rubber, it knows nothing. Half of the recordings
taken for those of a block hold the rotation of the upper part too. A motion is scaled so that the specimen rocks well;
bodies taken for one move against each other by `APART` of the peak at least in every recording.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from benchmarks.diagnosis import instruments, shakings, specimens, suite
from benchmarks.diagnosis.cases import LOW_PASS, RECORDINGS, Case, drawn
from benchmarks.diagnosis.scene import FloatArray, Unsuitable
from models import get
from models.shaking import Shaking

COUNTS = {"stack_as_block": 20, "rubber_as_block": 20, "rubber_as_stack": 20, "block": 20, "stack": 20}
"""Cases of each group; in the last two nothing is missing."""
WRONG = {"stack_as_block": "second_body", "rubber_as_block": "compliant_base", "rubber_as_stack": "compliant_base"}
"""The base model that is to be named, by group."""
NOISE = 0.01
PEAK = (0.08, 0.5)
"""Largest rotation over the slenderness angle."""
SCALES = np.geomspace(0.5, 8.0, 24)
APART = 0.15
COMPRESSION = (2e-4, 1.5e-3)
"""m, of layers under their static load."""
ROTATIONS = ("rotation_1", "rotation_2")
TOLERANCE = {
    "width": 0.005, "height": 0.005, "mass": 0.01, "top_mass": 0.005, "wall_length": 0.005, "wall_height": 0.005,
    "wall_mass": 0.01, "top_length": 0.005, "top_height": 0.005, "top_mass_height": 0.005, "top_mass_inertia": 0.01,
}  # fmt: skip


@dataclass(frozen=True)
class BaseDesign(suite.CaseDesign):
    """What a case is to hold: its group is its only name."""


@dataclass(frozen=True)
class Taken:
    """A specimen: ``true`` values of ``model`` with ``options``, and the ``base`` model and values it is taken for."""

    model: str
    true: Mapping[str, float]
    base: str
    nominal: Mapping[str, float]
    channels: tuple[str, ...]
    options: Mapping[str, str] = field(default_factory=dict)


def designs(seed: int) -> list[suite.CaseDesign]:
    """All cases in mixed order."""
    rng = np.random.default_rng(seed)
    groups: list[list[str]] = [[name] * count for name, count in COUNTS.items()]
    return [
        BaseDesign(number, "single" if name in WRONG else "null", (name,), NOISE, 1.0)
        for number, name in enumerate(suite.in_mixed_order(groups, rng))
    ]


def make(design: suite.CaseDesign, seed: int) -> Case:
    """The case, the same for the same design and seed. Raises RuntimeError when no draw was suitable."""
    return drawn(design, seed, _case)


def _case(design: suite.CaseDesign, seed: int, rng: np.random.Generator) -> Case:
    (group,) = design.names
    taken = SPECIMENS[group](rng)
    sampling = float(rng.choice(list(LOW_PASS)))
    channels, notes = {}, {}
    for name in RECORDINGS:
        source, shaking = _motion(taken, group, rng, LOW_PASS[sampling])
        channels[name] = _recorded(taken, group, shaking, sampling, rng)
        notes[name] = {"motion": source, "pga": shaking.pga, "duration": shaking.duration}
    named = WRONG.get(group)
    effects = [{"name": named, "class": named, "parameters": {}, "primary": ""}] if named else []
    key = {
        "kind": design.kind, "group": group, "model": taken.model, "options": dict(taken.options), "base": taken.base,
        "seed": seed, "number": design.number, "noise_fraction_of_peak": NOISE, "relative_size": 1.0,
        "sampling_hz": sampling, "weak": False, "effects": effects, "true_parameters": dict(taken.true),
        "recordings": notes,
    }  # fmt: skip
    return Case(_specimen(design.label, taken), sampling, channels, key)


def near(nominal: Mapping[str, float], rng: np.random.Generator) -> dict[str, float]:
    """True values within the tolerance of the drawing."""
    return {name: value * (1.0 + TOLERANCE.get(name, 0.0) * float(rng.normal())) for name, value in nominal.items()}


def _block(rng: np.random.Generator) -> Taken:
    block = specimens.draw(rng)
    return Taken("housner", block.true, "housner", block.nominal, _channels(rng))


def _channels(rng: np.random.Generator) -> tuple[str, ...]:
    """Half of the laboratories measure the rotation of the upper part too."""
    return ROTATIONS if rng.uniform() < 0.5 else ROTATIONS[:1]


def two_bodies(rng: np.random.Generator, narrowest: float) -> dict[str, float]:
    """A wall and a block on top, by its drawing."""
    height = round(float(rng.uniform(1.0, 1.8)), 2)
    length = round(height * float(rng.uniform(0.22, 0.4)), 3)
    top = round(length * float(rng.uniform(narrowest, 1.0)), 3)
    over = round(height * float(rng.uniform(0.5, 1.0)), 2)
    density = float(rng.uniform(*specimens.DENSITY)) * float(rng.uniform(*specimens.LENGTH))
    return {
        "wall_length": length, "wall_height": height, "wall_mass": round(density * length * height, 1),
        "top_mass": round(density * top * over, 1), "top_length": top, "top_height": over,
    }  # fmt: skip


def _as_block(two: Mapping[str, float]) -> dict[str, float]:
    """The wall with what stands on it as one block with a mass on top."""
    inertia = two["top_mass"] * (two["top_length"] ** 2 + two["top_height"] ** 2) / 12.0
    return {
        "width": two["wall_length"], "height": two["wall_height"], "mass": two["wall_mass"],
        "top_mass": two["top_mass"], "top_mass_height": two["top_height"] / 2.0, "top_mass_inertia": inertia,
    }  # fmt: skip


def _stack(rng: np.random.Generator) -> Taken:
    nominal = two_bodies(rng, 0.6)
    return Taken("stacked", near(nominal, rng), "stacked", nominal, ROTATIONS)


def _stack_as_block(rng: np.random.Generator) -> Taken:
    """A block on a wall, or a pier with a joint that nobody has seen."""
    if rng.uniform() < 0.5:
        nominal = two_bodies(rng, 0.6)
        return Taken("stacked", near(nominal, rng), "housner", _as_block(nominal), _channels(rng))
    block = specimens.draw(rng)
    return Taken(
        "stacked", _parted(block.true, float(rng.uniform(0.25, 0.75))), "housner", block.nominal, _channels(rng)
    )


def _parted(block: Mapping[str, float], share: float) -> dict[str, float]:
    """A rectangle cut at a share of its height."""
    width, height, mass = (block[name] for name in ("width", "height", "mass"))
    return {
        "wall_length": width, "wall_height": share * height, "wall_mass": share * mass,
        "top_length": width, "top_height": (1.0 - share) * height, "top_mass": (1.0 - share) * mass,
    }  # fmt: skip


def _rubber_as_block(rng: np.random.Generator) -> Taken:
    """A pier on a mat, or, where both rotations are measured, a wall and a block on top between two layers."""
    channels = _channels(rng)
    if channels == ROTATIONS:
        nominal = two_bodies(rng, 0.8)
        return Taken("interface", _on_rubber(near(nominal, rng), rng), "housner", _as_block(nominal), channels)
    block = specimens.draw(rng)
    true = _on_rubber(_parted(block.true, 0.5), rng, ("base",))
    return Taken("interface", true, "housner", block.nominal, channels, {"joints": "base"})


def _rubber_as_stack(rng: np.random.Generator) -> Taken:
    nominal = two_bodies(rng, 0.8)
    return Taken("interface", _on_rubber(near(nominal, rng), rng), "stacked", nominal, ROTATIONS)


def _on_rubber(
    two: Mapping[str, float], rng: np.random.Generator, joints: tuple[str, ...] = ("base", "top")
) -> dict[str, float]:
    """Two bodies with layers in their joints, by how far their load compresses them."""
    upper = two["top_mass"] * specimens.GRAVITY
    loads = {"base": (upper + two["wall_mass"] * specimens.GRAVITY, two["wall_length"]),
             "top": (upper, min(two["wall_length"], two["top_length"]))}  # fmt: skip
    found = {**two, "layer_thickness": float(rng.uniform(0.008, 0.015))}
    for joint in joints:
        load, length = loads[joint]
        found[f"{joint}_stiffness"] = load / (length * float(np.exp(rng.uniform(*np.log(COMPRESSION)))))
        found[f"{joint}_damping_ratio"] = float(rng.uniform(0.03, 0.1))
    return found


SPECIMENS: dict[str, Callable[[np.random.Generator], Taken]] = {
    "stack_as_block": _stack_as_block, "rubber_as_block": _rubber_as_block, "rubber_as_stack": _rubber_as_stack,
    "block": _block, "stack": _stack,
}  # fmt: skip


def _motion(taken: Taken, group: str, rng: np.random.Generator, low_pass: float) -> tuple[str, Shaking]:
    """A motion at a scale at which the specimen rocks well."""
    model = get(taken.model)
    source, unit = shakings.draw(rng, low_pass)
    unit = Shaking(unit.time_step, unit.horizontal)
    asked = ("peak_rotation_ratio", "overturned")
    options = dict(taken.options)
    if model.check(taken.true, options):
        raise Unsuitable
    found = model.evaluate(taken.true, unit, SCALES, outputs=asked, tail=0.0, options=options)
    ratio = found["peak_rotation_ratio"]
    good = np.flatnonzero((ratio > PEAK[0]) & (ratio < PEAK[1]) & (found["overturned"] == 0))
    for scale in rng.permutation(SCALES[good]):
        shaking = shakings.scaled(unit, float(scale), False)
        ran = model.simulate(taken.true, shaking, options=options).channels
        one, other = (ran.get(name, ran["rotation_1"]) for name in ROTATIONS)
        peak = float(np.max(np.abs(one)))
        if peak < PEAK[0] * float(model.derive(taken.true, options)["alpha"][0]):
            continue
        if group != "stack_as_block" or np.max(np.abs(other - one)) > APART * peak:
            return source, shaking
    raise Unsuitable


def _recorded(
    taken: Taken, group: str, shaking: Shaking, sampling: float, rng: np.random.Generator
) -> dict[str, FloatArray]:
    """Channels as written to the file."""
    fine = shakings.on_fine_grid(shaking)
    ran = get(taken.model).simulate(taken.true, fine, options=dict(taken.options)).channels
    signals = {"base_acceleration_x": fine.horizontal}
    signals |= {name: ran.get(name, ran["rotation_1"]) for name in taken.channels}
    if np.max(np.abs(signals["rotation_1"])) > 1.0:
        raise Unsuitable
    found = {}
    for name, signal in signals.items():
        sampled = instruments.logged(signal, fine.time_step, sampling, shaking.duration)
        share = NOISE if name in ROTATIONS else float(rng.uniform(0.002, 0.005))
        found[name] = sampled + share * float(np.max(np.abs(signal))) * rng.normal(size=sampled.size)
    return found


def _specimen(label: str, taken: Taken) -> str:
    lines = [f'title = "{label}"', f'model = "{taken.base}"', "", "[parameters]"]
    lines += [f"{name} = {value!r}" for name, value in taken.nominal.items()]
    lines += ["", "[tolerance]"]
    lines += [f"{name} = {TOLERANCE[name]!r}" for name in taken.nominal if name in TOLERANCE]
    return "\n".join(lines) + "\n"
