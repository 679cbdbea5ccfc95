"""Which cases are asked for, and in which order: any beginning of the list is a fair share of all."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np

from benchmarks.diagnosis.effects import CATALOGUE
from benchmarks.diagnosis.open_laws import LAWS
from benchmarks.diagnosis.unseen_laws import UNSEEN

Kind = Literal["null", "single", "pair", "open"]

DEVELOPMENT_SEED = 20_000
"""Seeds of cases looked at while developing; the evaluation's own is never one of them."""
EVALUATION_SEED = 4_620_815

TOO_SMALL = ("bounce",)
"""A bouncing corner keeps the angular momentum about itself, so at the end of its range it moves the response
of slender blocks by less than the noise (.05-.7 of 1 %): nominal size does not exist."""
NOT_HALVED = ("sliding",)
"""At twice the friction that gives nominal size nothing slides any more."""


@dataclass(frozen=True)
class Wish:
    """What case ``number`` is to hold: catalogue names (or one law's), at which noise and size."""

    number: int
    kind: Kind
    names: tuple[str, ...]
    noise: float
    relative_size: float

    @property
    def label(self) -> str:
        return f"case_{self.number:04d}"


@dataclass(frozen=True)
class Group:
    """Cases of one noise (share of the peak) and one size over the nominal, by kind."""

    noise: float
    relative_size: float
    counts: dict[Kind, int]


GROUPS = (
    Group(0.01, 1.0, {"null": 100, "single": 130, "pair": 40, "open": 40}),
    Group(0.03, 0.5, {"null": 30, "single": 75, "pair": 10, "open": 13}),
    Group(0.005, 1.0, {"null": 15, "single": 26}),
)


MAKERS = (
    "cases", "effects", "instruments", "open_laws", "scene", "shakings", "size", "specimens", "suite", "truth",
    "unseen_laws",
)  # fmt: skip
"""Files that the cases of a seed depend on."""


def place(folder: Path, seed: int) -> Path:
    """Where the cases of ``seed`` and their answers lie: another place when what makes them changes."""
    digest = hashlib.sha256()
    for name in MAKERS:
        digest.update(Path(__file__).with_name(f"{name}.py").read_bytes())
    return folder / "diagnosis" / f"{seed}-{digest.hexdigest()[:8]}"


def suite(seed: int) -> list[Wish]:
    """All cases, numbered in the order in which they are run; ``seed`` draws the pairs and the order.

    Laws outside the catalogue are those kept for the evaluation at its seed, the others at any other.
    """
    laws = list(UNSEEN if seed == EVALUATION_SEED else LAWS)
    rng = np.random.default_rng(seed)
    placed: list[tuple[float, Kind, tuple[str, ...], Group]] = []
    for group in GROUPS:
        for kind, count in group.counts.items():
            for k, names in enumerate(_names(kind, count, group.relative_size, laws, rng)):
                placed.append(((k + float(rng.uniform())) / count, kind, names, group))
    placed.sort(key=lambda item: item[0])
    return [
        Wish(number, kind, names, group.noise, group.relative_size)
        for number, (_, kind, names, group) in enumerate(placed)
    ]


def _names(
    kind: Kind, count: int, relative_size: float, laws: list[str], rng: np.random.Generator
) -> list[tuple[str, ...]]:
    """Every effect as often as every other one; pairs of two classes at random."""
    if kind == "null":
        return [()] * count
    without = TOO_SMALL if relative_size == 1.0 else TOO_SMALL + NOT_HALVED
    known = [name for name in CATALOGUE if name not in without]
    if kind == "pair":
        pairs: list[tuple[str, ...]] = []
        while len(pairs) < count:
            first, second = rng.choice(known, 2, replace=False).tolist()
            if CATALOGUE[first].effect_class != CATALOGUE[second].effect_class:
                pairs.append((first, second))
        return pairs
    known = known if kind == "single" else laws
    drawn: list[tuple[str, ...]] = []
    while len(drawn) < count:
        drawn += [(known[i],) for i in rng.permutation(len(known))]
    return drawn[:count]
