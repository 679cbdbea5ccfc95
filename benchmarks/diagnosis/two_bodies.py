"""Concealed cases of two bodies, one on the other, by seed: what is asked for, how large it is, what is recorded.

What is of one model stands in its `Bodies`: `walls` on rubber, `stacks` of rigid blocks. The motions of every other
case, and of those with a law outside the catalogue, are those of a program apart; the others are those of the model's
lanes at an eighth of the shaking's step. Half of the cases have one of a laboratory's errors (`imperfections`) besides.

Nominal size: 10 times the noise (rms over windows and rotations) is what the effect changes in windows that start from
the true rotations, less what a linear refit of the parameters in ``refitted`` takes up. A refit within their ranges has
to leave as much as the noise: a dashpot of a layer may stand for a damping couple at many times its size, and what it
takes up nobody can find.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from benchmarks.diagnosis import imperfections, instruments, shakings, suite
from benchmarks.diagnosis.bodies import ROTATIONS, Bodies, Motion, Truth, Values
from benchmarks.diagnosis.body_size import NOISE, left, strength
from benchmarks.diagnosis.cases import LOW_PASS, RECORDINGS, Case, drawn
from benchmarks.diagnosis.imperfections import Imperfections
from benchmarks.diagnosis.open_laws import LAWS, Law
from benchmarks.diagnosis.scene import FloatArray, Unsuitable
from benchmarks.diagnosis.unseen_laws import EVERY_LAW, UNSEEN
from models.shaking import Shaking

NOMINAL, WITHIN, LEFT = 10.0, 0.1, 1.0
SHARES = np.geomspace(0.01, 1.0, 12)
BEYOND = np.geomspace(0.01, 100.0, 23)
"""Shares tried of a law outside the catalogue, whose range is one of free-standing blocks."""
COUNTS: dict[suite.Kind, int] = {"null": 60, "single": 84, "pair": 20, "open": 20}
ERRORS = (*imperfections.COLOURS, *imperfections.OTHERS)
"""A laboratory's errors of any two bodies; impacts scatter besides, of those that have any."""
MOST_IMPACTS = 1000
"""In a recording."""


def designs(of: Bodies, seed: int, design: type[suite.CaseDesign]) -> list[suite.CaseDesign]:
    """All cases in mixed order; every effect as often as every other one, pairs of two classes at random.

    Every second case of a kind has one of a laboratory's errors, in turn. Laws outside the catalogue are those kept
    for the evaluation at its seed, the others at any other.
    """
    rng = np.random.default_rng(seed)
    laws = [n for n, law in (UNSEEN if seed == suite.EVALUATION_SEED else LAWS).items() if of.knows(law)]
    kinds = (*ERRORS, *imperfections.SCATTER) if of.impacts else ERRORS
    groups: list[list[tuple[suite.Kind, tuple[str, ...], str]]] = []
    for kind, count in COUNTS.items():
        pairs = kind == "pair"
        chosen = _pairs(of, count, rng) if pairs else suite.names_of(kind, count, list(of.catalogue), laws, rng)
        errors = [str(one) for _ in range(count) for one in rng.permutation(kinds)]
        groups.append([(kind, names, errors[k // 2] if k % 2 else "") for k, names in enumerate(chosen)])
    return [
        design(number, kind, chosen, NOISE, 1.0, error)
        for number, (kind, chosen, error) in enumerate(suite.in_mixed_order(groups, rng))
    ]


def _pairs(of: Bodies, count: int, rng: np.random.Generator) -> list[tuple[str, ...]]:
    """Pairs of two classes."""
    found: list[tuple[str, ...]] = []
    while len(found) < count:
        one, other = rng.choice(list(of.catalogue), 2, replace=False).tolist()
        if of.catalogue[one].effect_class != of.catalogue[other].effect_class:
            found.append((one, other))
    return found


def make(of: Bodies, design: suite.CaseDesign, seed: int) -> Case:
    """The case, the same for the same design and seed. Raises RuntimeError when no draw was suitable."""
    return drawn(design, seed, lambda design, seed, rng: _case(of, design, seed, rng))


def _case(of: Bodies, design: suite.CaseDesign, seed: int, rng: np.random.Generator) -> Case:
    nominal, true = of.specimen(rng)
    sampling = float(rng.choice(list(LOW_PASS)))
    drawn = [of.motion(true, rng, LOW_PASS[sampling]) for _ in RECORDINGS]
    peak = drawn[0][2]
    errors = Imperfections()
    if design.imperfection:
        errors = imperfections.draw(design.imperfection, design.names, sampling, rng)
    apart = design.number % 2 == 0 or design.kind == "open" or errors.scatter > 0.0
    truth, sensors, effects, kind = Truth(of, true, {}, apart), {}, [], str(design.kind)
    if design.kind == "open":
        law = EVERY_LAW[design.names[0]]
        kind = law.kind
        truth, size = _law(law, truth, drawn, rng)
        effects = [law.described(size)]
    else:
        found = [_sized(of, name, true, drawn, rng) for name in design.names]
        wall = {f"{n}.{k}": v for n, p in found if not of.catalogue[n].sensor for k, v in p.items()}
        truth, sensors = replace(truth, mechanisms=wall), {n: p for n, p in found if of.catalogue[n].sensor}
        if len(found) > 1:  # what a sensor reads is in shares of the rotation that the other effect leaves
            peak = float(np.max(np.abs(truth.rotations(drawn[0][1])["rotation_1"])))
        effects = [
            {"name": n, "class": of.catalogue[n].effect_class, "parameters": p, "primary": of.catalogue[n].parameter}
            for n, p in found
        ]
    channels, notes = {}, {}
    for name, (source, shaking, _) in zip(RECORDINGS, drawn, strict=True):
        channels[name], noise = _recorded(truth, sensors, errors, shaking, sampling, peak, design.noise, rng)
        notes[name] = {"motion": source, "pga": shaking.pga, "noise_std": noise, "duration": shaking.duration}
    key = {
        "kind": kind, "model": of.model.name, "seed": seed, "number": design.number,
        "noise_fraction_of_peak": design.noise, "relative_size": 1.0, "sampling_hz": sampling, "weak": False,
        "effects": effects, "over_peak": peak, "true_parameters": true, "recordings": notes, "program_apart": apart,
        "imperfections": errors.described(), "named_rightly": errors.named_rightly,
    }  # fmt: skip
    return Case(_specimen(of, design.label, nominal), sampling, channels, key)


def _sized(
    of: Bodies, name: str, true: Values, drawn: Sequence[Motion], rng: np.random.Generator
) -> tuple[str, dict[str, float]]:
    """The effect at nominal size, by bisection between shares of the way to the end of its range."""
    row = of.catalogue[name]
    end, peak = float(rng.choice(row.ends)), drawn[0][2]
    shapes = row.shapes(rng, peak)

    def at(share: float) -> dict[str, float]:
        return {row.parameter: row.at(share, end), **shapes}

    def largest(measure: Callable[..., float], share: float) -> float:
        sensors = {name: at(share)} if row.sensor else {}
        wall = {} if row.sensor else {f"{name}.{k}": v for k, v in at(share).items()}
        return max(measure(Truth(of, true, wall, False), sensors, shaking, peak) for _, shaking, _ in drawn[:2])

    share = _nominal(lambda share: largest(strength, share))
    if largest(left, share) < LEFT:
        raise Unsuitable
    return name, at(share)


def _law(law: Law, plain: Truth, drawn: Sequence[Motion], rng: np.random.Generator) -> tuple[Truth, float]:
    """The bodies with a law outside the catalogue at nominal size, and that size."""
    end = law.end * (float(rng.choice([-1.0, 1.0])) if law.either else 1.0)
    numbers, peak, length = law.draw(rng), drawn[0][2], min(shaking.duration for _, shaking, _ in drawn)
    begin = float(rng.uniform(0.25, 0.5)) * length
    interval = begin, begin + float(rng.uniform(0.15, 0.3)) * length

    def at(share: float) -> Truth:
        return replace(plain, law=law, numbers=(share * end, *numbers, *interval, 0.0), largest=peak)

    share = _nominal(
        lambda share: max(strength(at(share), {}, shaking, peak, coarse=True) for _, shaking, _ in drawn[:2]), BEYOND
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
                return float(middle)
            low, high = (middle, high) if found < NOMINAL else (low, middle)
        raise Unsuitable
    raise Unsuitable


def _recorded(
    truth: Truth, sensors: instruments.Sensors, errors: Imperfections, shaking: Shaking, sampling: float, peak: float,
    noise: float, rng: np.random.Generator,
) -> tuple[dict[str, FloatArray], dict[str, float]]:  # fmt: skip
    """Channels as written to the file, and the standard deviation of the noise in each."""
    fine = shakings.on_fine_grid(shaking)
    kicks = errors.kicks(MOST_IMPACTS, rng) if errors.scatter else None
    ran, seen = replace(truth, kicks=kicks).rotations(fine), {**sensors, **errors.sensors}
    if np.max(np.abs(ran["rotation_1"])) > float(truth.of.model.derive(truth.values)["alpha"][0]):
        raise Unsuitable  # with the effect it falls
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


def _specimen(of: Bodies, label: str, nominal: Values) -> str:
    lines = [f'title = "{label}"', f'model = "{of.model.name}"', "", "[parameters]"]
    lines += [f"{name} = {value!r}" for name, value in nominal.items()]
    lines += ["", "[tolerance]", *(f"{name} = {value!r}" for name, value in of.tolerance.items())]
    if of.calibrated:
        lines += ["", "[calibrate]", *(f"{name} = [{low!r}, {high!r}]" for name, (low, high) in of.calibrated.items())]
    return "\n".join(lines) + "\n"
