"""The slow plain route of the block: scipy's DOP853 with dense events, one lane at a time.

Everything else (kernels) is held against this route. See `models.housner.rocking` for a rigid block on
fixed corners, and `slip`, `flight`, `flexure` beside it for blocks that slide, bounce or bend.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from models.housner.block import Block
from models.housner.equation import Equation
from models.housner.flexure import Bending
from models.housner.flight import Bouncing
from models.housner.ground import pieces
from models.housner.rocking import ReferenceResult, Rocking
from models.housner.slip import Sliding
from models.shaking import Shaking


def run(
    block: Block,
    shaking: Shaking,
    scale: float = 1.0,
    *,
    tail: float = 10.0,
    linear: bool = False,
    initial: Mapping[str, float] | None = None,
    duration: float | None = None,
    follow: bool = False,
    rtol: float = 1e-10,
) -> ReferenceResult:
    """One block (a `Block` of one lane) under ``scale`` times the shaking.

    ``tail``: free motion after the record, at most, in s; ``duration`` replaces record plus tail.
    ``initial``: ``rotation_1`` (rad), ``rotation_rate_1`` (rad s-1), default at rest; and for laws with
    a memory ``peak_rotation_1`` (rad) and ``impacts`` before the run, default none.
    ``follow``: the history of a block that has overturned goes on to pi/2; outputs count to
    overturning all the same. ``rtol`` is that of DOP853, the absolute tolerance is rtol times
    (alpha, p alpha, M g R alpha^2).
    """
    until = shaking.duration + tail if duration is None else duration
    grid = shaking.time_step * np.arange(round(until / shaking.time_step) + 1, dtype=np.float64)
    body = _kind(block)(Equation(block, linear), grid, rtol, follow)
    start = dict(initial or {})
    body.begin(start.get("rotation_1", 0.0), start.get("rotation_rate_1", 0.0))
    body.largest = max(body.largest, start.get("peak_rotation_1", 0.0))
    body.earlier = start.get("impacts", 0.0)
    for piece in pieces(block, shaking, scale, until):
        body.advance(piece, shaken=piece.start < shaking.duration)
        if body.finished:
            break
    return body.result()


def _kind(block: Block) -> type[Rocking]:
    if math.isfinite(block.friction[0]):
        return Sliding
    if math.isfinite(block.first_frequency[0]):
        return Bending
    return Bouncing if block.contact_restitution[0] > 0.0 else Rocking
