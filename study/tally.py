"""How many cells of a cube came to what end."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import dask
import numpy as np
from dask.array import asarray

from models.base import STATUS
from study.open import open_study
from study.wording import spoken


def tally(cube: Path) -> dict[str, int]:
    """Cells of a cube's file by the word of their ``status``, all words in the order of `models.base.STATUS`."""
    with open_study(cube, ["status"], lazy=True) as opened, dask.config.set(scheduler="synchronous"):
        status: Any = asarray(opened["status"].data)  # type: ignore[no-untyped-call]  # of a single cell none of dask
        chunks = status.to_delayed().ravel()
        counts = sum(np.bincount(chunk.compute().ravel(), minlength=len(STATUS)) for chunk in chunks)
    return dict(zip(STATUS, np.asarray(counts).tolist(), strict=True))


def tally_line(counts: Mapping[str, int]) -> str:
    """``at rest 12, rocking 40, ...``; what never happened is left out."""
    return f"cells: {', '.join(f'{spoken(word)} {n}' for word, n in counts.items() if n)}"
