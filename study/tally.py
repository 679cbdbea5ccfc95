"""How many cells of a cube came to what end."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from models.base import STATUS
from study.open import open_study

WORDS = {"rest": "at rest", "outside_model": "outside the model"}


def tally(cube: Path) -> dict[str, int]:
    """Cells of a cube's file by the word of their ``status``, all words in the order of `models.base.STATUS`."""
    counts = np.bincount(open_study(cube, ["status"])["status"].values.ravel(), minlength=len(STATUS))
    return dict(zip(STATUS, counts.tolist(), strict=True))


def tally_line(counts: Mapping[str, int]) -> str:
    """``at rest 12, rocking 40, ...``; what never happened is left out."""
    parts = [f"{WORDS.get(word, word.replace('_', ' '))} {n}" for word, n in counts.items() if n]
    return f"cells: {', '.join(parts)}"
