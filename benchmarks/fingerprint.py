"""What every model answers on random cells, kept in files, so that a change of the code can be held against it.

    python -m benchmarks.fingerprint write DIR [--only interface]
    python -m benchmarks.fingerprint compare DIR [--only interface] [--renamed needed_friction=friction_demand]

One file a model and variant (a formulation, a mechanism or rubber law at random values in its range, some
combinations): 64 random cells under 3 s of motion by the lanes with all outputs, histories of a few cells by
`simulate` and `trajectories`, and two cells of 1 s by the reference. ``write`` goes on where it was interrupted.
``compare`` runs the cells that the files hold with the code as it is and prints per file, for lanes and reference,
whether all is identical; else the largest difference of the histories' first second over the largest value of the
channel, the cells whose outcome (whole numbers, flags) differs, the largest relative difference of the other
outputs, and the cells that hold nan now.
"""

from __future__ import annotations

import argparse
import time
import zlib
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

import models
from models.base import STATUS
from models.model import Model
from models.shaking import Shaking

CELLS, FOLLOWED, BY_REFERENCE = 64, 4, 2
STEP, DURATION, FIRST_CYCLE, TAIL = 0.005, 3.0, 1.0, 0.5
"""Seconds."""
EVERY = 10
"""Samples between those of a history that are kept."""
COMBINATIONS = {
    "housner": (("restitution", "viscous_damping", "tilt"), ("sliding", "crushing"), ("degradation", "rounded_corner")),
    "stacked": (("pivot_inset", "tilt", "viscous_damping"),),
    "interface": (("hardening", "mullins"), ("maxwell", "bouc_wen"), ("hardening", "maxwell", "permanent_set")),
    "interface_linear": (),
    "isolated": (("hardening", "mullins"), ("maxwell", "bouc_wen", "degradation"), ("payne", "hardening")),
}
RANGES = {
    "bouc_wen.post_yield_ratio": (0.3, 0.9),
    "bouc_wen.yield_compression": (5e-4, 0.02),
    "mullins.softening": (0.05, 0.5),
    "payne.softening": (0.05, 0.5),
    "hardening.beta2": (0.1, 5.0),
    "permanent_set.strain_limit": (0.6, 2.0),
}
"""Narrower than declared where the declared range holds cells that cannot stand at rest."""
Values = dict[str, Any]
Found = dict[str, np.ndarray]


def random_motion(rng: np.random.Generator) -> Shaking:
    """Noise between .5 and 6 Hz under an envelope, PGA 1 m s-2, vertical .4."""
    at = np.arange(round(DURATION / STEP) + 1) * STEP
    lines = np.linspace(0.5, 6.0, 30)

    def component() -> np.ndarray:
        phases = 2 * np.pi * (lines[:, None] * at + rng.random(30)[:, None])
        signal = np.sin(np.pi * at / DURATION) ** 0.5 * np.sum(np.sin(phases), axis=0)
        return np.asarray(signal / np.max(np.abs(signal)))

    return Shaking(STEP, component(), 0.4 * component())


def random_cells(model: str, rng: np.random.Generator) -> Values:
    """Parameters of `CELLS` blocks, walls or buildings, and ``scale``, the PGA (m s-2)."""

    def uniform(low: float, high: float) -> np.ndarray:
        return rng.uniform(low, high, CELLS)

    def spread(low: float, high: float) -> np.ndarray:
        return np.exp(uniform(np.log(low), np.log(high)))

    if model == "housner":
        block = {"height": uniform(0.5, 5.0), "aspect_ratio": uniform(0.1, 0.5), "mass": uniform(100.0, 5000.0)}
        return {**block, "top_mass": uniform(0.0, 3000.0), "scale": uniform(0.5, 8.0)}
    if model == "isolated":
        mass, omega = spread(1e4, 1e6), 2 * np.pi / uniform(0.5, 3.0)
        return {
            "levels": rng.integers(1, 6, CELLS).astype(float),
            "total_mass": mass,
            "bearing_stiffness": mass * omega**2,
            "bearing_damping": uniform(0.0, 0.4) * mass * omega,
            "rubber_thickness": uniform(0.05, 0.3),
            "storey_stiffness": mass * omega**2 * spread(3.0, 1000.0),
            "storey_damping": uniform(0.0, 1.0) * mass * omega,
            "scale": uniform(0.5, 6.0),
        }
    slender = model == "stacked"
    wall = {
        "wall_height": uniform(1.2, 3.0),
        "aspect_ratio": uniform(0.15, 0.5) if slender else uniform(0.35, 1.2),
        "top_mass": uniform(500.0, 6000.0),
        "top_length": uniform(0.3, 1.0) if slender else uniform(0.4, 2.5),
        "top_height": uniform(0.3, 0.9),
        "scale": uniform(0.5, 9.0),
    }
    if slender:
        return {**wall, "wall_mass": uniform(300.0, 3000.0)}
    return {
        **wall,
        "wall_thickness": np.full(CELLS, 0.138),
        "wall_density": uniform(700.0, 1500.0),
        "layer_thickness": np.full(CELLS, 0.01),
        "base_layer_modulus": spread(2e6, 2e7),
        "top_layer_modulus": spread(2e6, 2e7),
        "damping_ratio": uniform(0.01, 0.12),
    }


def variants(model: Model) -> dict[str, tuple[dict[str, str], tuple[str, ...]]]:
    """By name: options and mechanisms of every variant of ``model``; laws of rubber are mechanisms."""
    found: dict[str, tuple[dict[str, str], tuple[str, ...]]] = {"plain": ({}, ()), "vertical": ({}, ())}
    for option, words in model.options.items():
        if not option.endswith("rubber_law"):
            found |= {f"{option}={word}": ({option: word}, ()) for word in words[1:]}
    found |= {name: ({}, (name,)) for name in model.mechanisms}
    return found | {"+".join(names): ({}, names) for names in COMBINATIONS[model.name]}


def drawn(model: Model, variant: str) -> tuple[Values, dict[str, str]]:
    """Values of the variant's cells, seeded by its name, and its options."""
    options, mechanisms = variants(model)[variant]
    rng = np.random.default_rng(zlib.crc32(f"{model.name}.{variant}".encode()))
    values = random_cells(model.name, rng)
    for name in mechanisms:
        for parameter in model.mechanisms[name].parameters:
            if parameter.name == "exponent":  # of Bouc-Wen, whole
                values[f"{name}.exponent"] = rng.integers(1, 5, CELLS).astype(float)
                continue
            low, high = RANGES.get(f"{name}.{parameter.name}", (parameter.low, parameter.high))
            values[f"{name}.{parameter.name}"] = rng.uniform(low, high, CELLS)
    return values, options


def answers(model: Model, variant: str, values: Values, options: Mapping[str, str], outputs: list[str]) -> Found:
    """What the lanes and the reference say of the cells, by ``route/name``."""
    motion = random_motion(np.random.default_rng(zlib.crc32(model.name.encode())))
    vertical = variant in ("vertical", "vertical_acceleration")
    shaking = Shaking(STEP, motion.horizontal, motion.vertical if vertical else None, variant == "vertical")
    given = {name: value for name, value in values.items() if name != "scale"}
    scale = np.asarray(values["scale"])
    found = model.evaluate(given, shaking, scale, outputs=outputs, tail=TAIL, options=options)
    kept = {f"lanes/{name}": value for name, value in found.items()}
    for k in range(FOLLOWED):
        one = {name: float(value[k]) for name, value in given.items()}
        history = model.simulate(one, shaking, scale=float(scale[k]), options=options)
        kept |= {f"simulate {k}/{name}": channel[..., ::EVERY] for name, channel in history.channels.items()}
    # chains of one length, from a rotation or displacement of their own, at samples of their own
    alike = np.flatnonzero(given.get("levels", np.ones(CELLS)) == given.get("levels", np.ones(CELLS))[0])[:FOLLOWED]
    size = "bearing_displacement" if "bearing_displacement" in model.states else "rotation_1"
    if hasattr(model, "trajectories"):
        traced = model.trajectories(
            {name: value[alike] for name, value in given.items()}, shaking, first=np.arange(alike.size) * 50,
            samples=round(FIRST_CYCLE / STEP) + 1, initial={size: np.linspace(2e-3, 8e-3, alike.size)}, options=options,
        )  # fmt: skip
        kept |= {f"trajectories/{name}": channel[..., ::EVERY] for name, channel in traced.items()}
    n = round(FIRST_CYCLE / STEP) + 1
    short = Shaking(
        STEP, shaking.horizontal[:n], None if shaking.vertical is None else shaking.vertical[:n], shaking.vertical_acts
    )
    few = {name: value[:BY_REFERENCE] for name, value in given.items()}
    slow = model.evaluate(
        few, short, scale[:BY_REFERENCE], outputs=outputs, tail=0.0, options=options, integrator="reference"
    )
    return kept | {f"reference/{name}": value for name, value in slow.items()}


def worded(status: np.ndarray, words: np.ndarray) -> np.ndarray:
    """The status of every cell in words, whose codes may change between versions."""
    return np.asarray(words)[status.astype(int)]


def differences(before: Found, after: Found) -> str:
    """One line: what differs between two answers to the same cells."""
    routes: dict[str, list[str]] = {"lanes": [], "reference": []}
    for route in routes:
        changed, histories, others, emptied = np.zeros(CELLS, bool), 0.0, 0.0, np.zeros(CELLS, bool)
        identical, missing = True, []
        prefixes = ("lanes/", "simulate", "trajectories") if route == "lanes" else ("reference/",)
        for name in (name for name in before if name.startswith(prefixes)):
            old, new = before[name], after.get(name)
            if new is None:
                missing.append(name)
                continue
            cells = slice(0, old.shape[0]) if name.startswith((f"{route}/",)) else slice(0, 0)
            if not np.issubdtype(old.dtype, np.floating):
                differs = old != new
                gone = differs & (new == -1) if new.dtype.kind == "i" else np.zeros_like(differs)
                identical &= not np.any(differs)
                changed[cells] |= differs & ~gone
                emptied[cells] |= gone
                continue
            identical &= np.array_equal(old, new, equal_nan=True)
            if name.startswith(f"{route}/"):
                gone = np.isnan(new) & ~np.isnan(old)
                emptied[cells] |= gone
                both = np.isfinite(old) & np.isfinite(new)
                changed[cells] |= ~both & ~gone & ~((old == new) | (np.isnan(old) & np.isnan(new)))
                size = np.abs(old[both]) + 1e-300
                others = max(others, float(np.max(np.abs(new[both] - old[both]) / size, initial=0.0)))
            else:
                until = round(FIRST_CYCLE / STEP / EVERY) + 1
                most = np.max(np.abs(old[..., :until]), initial=0.0) + 1e-300
                apart = np.abs(new[..., :until] - old[..., :until]) / most
                histories = max(histories, float(np.max(np.nan_to_num(apart, nan=np.inf), initial=0.0)))
        if identical and not missing:
            routes[route].append("identical")
            continue
        if route == "lanes":
            routes[route].append(f"first cycle {histories:.1e}")
        outcomes, empty = np.sum(changed & ~emptied), np.sum(emptied)
        routes[route].append(f"outcomes {outcomes} cells, others {others:.1e}, now nan {empty} cells")
        routes[route] += [f"missing {', '.join(missing)}"] if missing else []
    return " | ".join(f"{route}: {', '.join(said)}" for route, said in routes.items())


def renamed(found: Found, names: list[tuple[str, str]]) -> Found:
    """The answers by their names of today; each pair replaces a part of a name."""
    new = {}
    for name, value in found.items():
        for old, today in names:
            name = name.replace(old, today)
        new[name] = value
    return new


def write(folder: Path, model: Model, variant: str) -> str:
    """Answer the variant's cells and keep them with their values."""
    path = folder / f"{model.name}.{variant}.npz"
    if path.exists():
        return "kept"
    values, options = drawn(model, variant)
    found = answers(model, variant, values, options, [q.name for q in model.outputs])
    kept = {f"values/{name}": value for name, value in values.items()}
    hidden = path.with_suffix(".part.npz")
    np.savez_compressed(hidden, words=np.array(STATUS), **kept, **found)
    hidden.rename(path)
    return f"{len(found)} arrays"


def compare(folder: Path, model: Model, variant: str, names: list[tuple[str, str]]) -> str:
    """Run the kept cells again and say what differs."""
    path = folder / f"{model.name}.{variant}.npz"
    if not path.exists():
        return "not written"
    with np.load(path) as stored:
        before = {name: stored[name] for name in stored.files}
    words = before.pop("words")
    values = {name.removeprefix("values/"): before.pop(name) for name in list(before) if name.startswith("values/")}
    before = renamed(before, names)
    outputs = [q.name for q in model.outputs if f"lanes/{q.name}" in before]
    after = answers(model, variant, values, variants(model)[variant][0], outputs)
    for kept, code in ((before, words), (after, np.array(STATUS))):
        kept |= {name: worded(status, code) for name, status in kept.items() if name.endswith("/status")}
    return differences(before, after)


def chosen(only: str | None) -> Iterator[tuple[Model, str]]:
    for name in models.MODELS:
        model = models.get(name)
        yield from ((model, variant) for variant in variants(model) if (only or "") in f"{name}.{variant}")


def main() -> None:
    """Write or compare, a line for every model and variant."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("task", choices=("write", "compare"))
    parser.add_argument("folder", type=Path)
    parser.add_argument("--only", help="a part of MODEL.VARIANT, for instance 'housner.' or 'isolated.mullins'")
    parser.add_argument("--renamed", nargs="+", default=[], metavar="OLD=NEW", help="outputs and channels")
    given = parser.parse_args()
    given.folder.mkdir(parents=True, exist_ok=True)
    names = [(old, new) for old, _, new in (pair.partition("=") for pair in given.renamed)]
    print(f"models of {Path(models.__file__).parent}", flush=True)
    for model, variant in chosen(given.only):
        began = time.perf_counter()
        task: Callable[[], str] = (
            (lambda m=model, v=variant: write(given.folder, m, v))
            if given.task == "write"
            else (lambda m=model, v=variant: compare(given.folder, m, v, names))
        )
        try:
            said = task()
        except Exception as error:
            said = f"{type(error).__name__}: {error}"
        print(f"{model.name}.{variant}: {said} ({time.perf_counter() - began:.1f} s)", flush=True)


if __name__ == "__main__":
    main()
