"""A Latin hypercube sample: each of ``count`` slices of every parameter holds one point.

McKay, Beckman, Conover (Technometrics 21, 1979).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from grids.axes.base import Axis, AxisKind, Request
from grids.axes.sample import BESIDE, read_sample


def _draw(choices: Sequence[int], count: int, seed: int) -> Any:
    from scipy.stats import qmc

    return qmc.LatinHypercube(len(choices), seed=seed).random(count)


def _read(request: Request) -> Axis:
    return read_sample(request, "latin_hypercube", _draw)


KIND = AxisKind("latin_hypercube", BESIDE, _read)
