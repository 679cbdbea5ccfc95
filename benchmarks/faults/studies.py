"""Small studies of every model, and what of their folders must survive."""

from __future__ import annotations

import hashlib
from pathlib import Path

import numpy as np

from benchmarks.faults.row import Row
from study.open import open_study
from study.store import BlockStore

NAME = "faults"
PLAN = """
[study]
name = "faults"
model = "{model}"
[motion]
pulse = {{ shape = "sine", amplitude = "0.3 g", frequency = "2 Hz" }}
[parameters]
{parameters}
[axes]
{axes}
pga = {{ linspace = [0.05, {largest}, {levels}], unit = "g" }}
[run]
block_seconds = {block_seconds}
"""
BLOCK = 'height = "1.8 m"\nmass = "800 kg"'
WALL = """wall_height = "1.8 m"
wall_thickness = "0.138 m"
wall_density = "900 kg/m^3"
top_length = "2 m"
top_height = "0.6 m\""""
RUBBER = 'layer_thickness = "10 mm"\nlayer_modulus = "4.5 MPa"\ndamping_ratio = 0.0544'
BUILDING = """levels = 4
total_mass = "300 t"
storey_stiffness = 3e8
storey_damping = 1e6"""
WALLS = "aspect_ratio = {{ linspace = [{span}] }}\ntop_mass = {{ linspace = [500, 4000, {size}] }}"
BEARINGS = "bearing_stiffness = {{ geomspace = [{span}] }}\nbearing_damping = {{ linspace = [1e5, 9e5, {size}] }}"
MODELS = {
    "housner": (BLOCK, WALLS, "0.1, 0.4, 30", 37),
    "stacked": (WALL, WALLS, "0.2, 0.6, 10", 75),
    "interface": (f"{WALL}\n{RUBBER}", WALLS, "0.4, 1.2, 5", 25),
    "interface_linear": (f"{WALL}\n{RUBBER}", WALLS, "0.4, 1.2, 2", 4),
    "isolated": (BUILDING, BEARINGS, "1e6, 9e6, 6", 75),
}
"""Parameters, two axes, the span of the first, number of PGA: cells of like cost in all, a second or two."""


def plan_text(model: str, size: int, *, more: int = 0, block_seconds: float = 0.03) -> str:
    """A study of one model, the longer the more points ``size`` of its second axis; ``more`` levels of PGA above
    those that are there."""
    parameters, axes, span, levels = MODELS[model]
    largest = 0.05 + 0.72 * (levels - 1 + more) / (levels - 1)
    return PLAN.format(
        model=model,
        parameters=parameters,
        axes=axes.format(span=span, size=size),
        largest=largest,
        levels=levels + more,
        block_seconds=block_seconds,
    )


def tiny_text() -> str:
    """Some hundred cells of one block in a handful of blocks, for faults that are injected between runs."""
    parameters, axes, _, _ = MODELS["housner"]
    axes = axes.format(span="0.1, 0.4, 7", size=5)
    return PLAN.format(model="housner", parameters=parameters, axes=axes, largest=0.77, levels=8, block_seconds=0.003)


def digests(folder: Path, row: Row) -> dict[str, str]:
    """Digest of every finished block's content by key; a block that cannot be read is noted."""
    store, found = BlockStore(folder), {}
    for key in store.finished():
        try:
            _, outputs = store.read(key)
        except Exception as error:
            row.unreadable += 1
            row.notes.append(f"block {key}: {error}")
            continue
        parts = b"".join(name.encode() + values.tobytes() for name, values in sorted(outputs.items()))
        found[key] = hashlib.sha256(parts).hexdigest()
    return found


def compare_blocks(before: dict[str, str], after: dict[str, str], row: Row) -> None:
    """Note blocks that were finished and are gone, or hold something else."""
    lost = [key for key, digest in before.items() if after.get(key) != digest]
    row.blocks_lost += len(lost)
    row.notes += [f"block {key} is {'changed' if key in after else 'gone'}" for key in lost]


def compare_cubes(reference: Path, other: Path, row: Row) -> None:
    """Count cells in which any variable differs in any bit from the cube of an undisturbed run."""
    one, two = open_study(reference), open_study(other)
    for name in one.variables.keys() | two.variables.keys():
        a, b = (np.asarray(cube[name].values) if name in cube.variables else np.empty(0) for cube in (one, two))
        if a.shape != b.shape or a.dtype != b.dtype:
            wrong = max(a.size, b.size)
        elif a.dtype.kind in "OU":
            wrong = int(np.sum(a != b))
        else:
            wrong = int(
                np.sum(np.ascontiguousarray(a).view(f"V{a.itemsize}") != np.ascontiguousarray(b).view(f"V{a.itemsize}"))
            )
        if wrong:
            row.wrong_cells += wrong
            row.notes.append(f"{wrong} cells of {name} differ from the undisturbed cube")
