"""Which cases with a laboratory's errors are asked for: every imperfection alike, as null, single, pair and open.

Effects are those that `truth` knows and those of the instruments; an effect that is the imperfection itself is
not hidden beside it. Noise 1 % of the peak whatever its colour, effects at nominal size.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from benchmarks.diagnosis import truth
from benchmarks.diagnosis.effects import CATALOGUE
from benchmarks.diagnosis.imperfections import NAMED_RIGHTLY, NAMES
from benchmarks.diagnosis.open_laws import LAWS
from benchmarks.diagnosis.processing import PROCESSED
from benchmarks.diagnosis.suite import EVALUATION_SEED, CaseDesign, Kind, in_mixed_order, names_of
from benchmarks.diagnosis.unseen_laws import UNSEEN

NOISE = 0.01
EACH: dict[Kind, int] = {"null": 8, "single": 8, "pair": 3, "open": 3}
"""Cases of an imperfection, by kind."""
EACH_PROCESSED: dict[Kind, int] = {"null": 3, "single": 3}
"""The same of what is done to recordings afterwards."""
EFFECTS = tuple(
    row.name for row in CATALOGUE.values() if row.sensor or f"{row.name}.{row.parameter}" in truth.NULLS
)  # fmt: skip


def suite(seed: int) -> list[CaseDesign]:
    """All cases in the order in which they are run; any beginning is a fair share of kinds and imperfections."""
    return _suite(seed, NAMES, EACH)


def processed(seed: int) -> list[CaseDesign]:
    """The same of what is done to recordings afterwards: nulls and singles."""
    return _suite(seed, tuple(PROCESSED), EACH_PROCESSED)


def _suite(seed: int, names: Sequence[str], counts: Mapping[Kind, int]) -> list[CaseDesign]:
    laws = list(UNSEEN if seed == EVALUATION_SEED else LAWS)
    rng = np.random.default_rng(seed)
    groups: list[list[tuple[Kind, tuple[str, ...], str]]] = []
    for kind, each in counts.items():
        drawn = names_of(kind, each * len(names), EFFECTS, laws, rng)
        errors = [str(one) for _ in range(each) for one in rng.permutation(names)]
        groups.append(list(zip([kind] * len(drawn), _apart(drawn, errors), errors, strict=True)))
    return [
        CaseDesign(number, kind, names, NOISE, 1.0, imperfection)
        for number, (kind, names, imperfection) in enumerate(in_mixed_order(groups, rng))
    ]


def _apart(drawn: list[tuple[str, ...]], imperfections: list[str]) -> list[tuple[str, ...]]:
    """The same effects in an order in which none stands beside an imperfection that is its like."""
    drawn = list(drawn)

    def alike(i: int, j: int) -> bool:
        own = imperfections[j]
        named = PROCESSED[own].named_rightly if own in PROCESSED else NAMED_RIGHTLY.get(own, ())
        return bool(set(drawn[i]) & set(named))

    for i in range(len(drawn)):
        if alike(i, i):
            other = next(j for j in range(len(drawn)) if not (alike(i, j) or alike(j, i)))
            drawn[i], drawn[other] = drawn[other], drawn[i]
    return drawn
