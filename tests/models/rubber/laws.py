"""The rubber laws with numbers of theirs: given ones in a layer alone, random ones in random walls that they carry."""

from __future__ import annotations

import numpy as np

from models.interface import modes
from models.rubber import LAWS
from models.rubber.layer import Layer
from tests.models.interface.walls import MODEL, random_wall, stacked, wall

GIVEN = {
    "hardening": {"hardening.beta2": 20.0},
    "maxwell": {"maxwell.arm_stiffness_ratio": 0.5, "maxwell.relaxation_time": 0.05},
    "bouc_wen": {"bouc_wen.post_yield_ratio": 0.4, "bouc_wen.yield_compression": 2e-3, "bouc_wen.exponent": 2.0},
    "locking": {"locking.lock_strain": 0.7},
    "mullins": {"mullins.softening": 0.3, "mullins.strain": 0.3},
    "permanent_set": {"permanent_set.rate": 2.0, "permanent_set.strain_limit": 0.3},
}


def numbers(name: str, **more: float) -> dict[str, np.ndarray]:
    """What the law itself is called with: its given numbers, or ``more``."""
    own = {key.partition(".")[2]: value for key, value in GIVEN[name].items()}
    shared = {"stiffness": 6.21e7, "thickness": 0.01}
    return {k: np.asarray(v) for k, v in {**own, **shared, **more}.items()}


def alone(*names: str, **more: float) -> Layer:
    """A layer with these laws at their given numbers, or at ``more``."""
    return Layer(np.asarray(6.21e7), [(LAWS[name], numbers(name, **more)) for name in LAWS if name in names])


def laden(name: str, rng: np.random.Generator, count: int) -> dict[str, np.ndarray]:
    """Random walls with random numbers of a law that carries them at rest."""
    values = stacked([random_wall(rng) for _ in range(4 * count)])
    numbers = {p.name: rng.uniform(0.8 * p.low + 0.2 * p.high, 0.2 * p.low + 0.8 * p.high, 4 * count) for p in
               MODEL.mechanisms[name].parameters}  # fmt: skip
    if name == "bouc_wen":
        numbers["exponent"] = rng.integers(1, 5, 4 * count).astype(float)
    compressed = -modes.static_state(wall(values).with_law(name, numbers))[:, 2:] / 0.01
    carried = np.max(compressed, axis=1) < numbers.get("strain_limit", 1.0)
    kept = np.flatnonzero(carried)[:count]
    assert kept.size == count
    return {k: v[kept] for k, v in (values | {f"{name}.{k}": v for k, v in numbers.items()}).items()}
