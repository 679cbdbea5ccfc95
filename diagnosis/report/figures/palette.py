"""Colours by their meaning: what was measured, the model before, the model after, chance."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Palette:
    """One accent on ink and greys, so that a page may exchange all of them for a dark screen.

    ``ink``: what was measured, and words; ``before``: the base model; ``accent``: the extended model
    and every residual; ``faint``: grids and frames; ``band``: what chance alone gives.
    """

    ink: str = "#1b1f24"
    before: str = "#7a828c"
    accent: str = "#0067a5"
    faint: str = "#d5d9de"
    band: str = "#eceef1"


PAPER = Palette()
