"""The slow plain route of the block: scipy's DOP853 with dense events, one lane at a time.

Everything else (kernels) is held against this route. See `models.housner.reference.rocking` for a rigid block on
fixed corners, and `slip`, `flight`, `flexure` beside it for blocks that slide, bounce or bend.
"""

from __future__ import annotations

import math

from models.ground import pitched_pieces
from models.housner.block import Block
from models.housner.reference.equation import Equation
from models.housner.reference.flexure import Bending
from models.housner.reference.flight import Bouncing
from models.housner.reference.rocking import Rocking
from models.housner.reference.slip import Sliding
from models.oscillator import felt
from models.runs import Request, Run


def run(block: Block, request: Request, rtol: float = 1e-10) -> Run:
    """One block (a `Block` of one lane) as requested.

    Samples: theta (rad), theta' (rad s-1) and what the mass centre's displacement has beyond that of rocking on
    fixed corners (m). ``initial`` may hold ``peak_rotation_1`` (rad), ``swing_peak_1`` (rad, since the last impact)
    and ``impacts`` before the run, too.
    A history of a block that has overturned goes on to pi/2; outputs count to overturning all the same.
    ``rtol`` is that of DOP853, the absolute tolerance is rtol times (alpha, p alpha, M g R alpha^2).
    """
    body = _kind(block)(Equation(block, request.linear), request.times, rtol, request.history)
    start = request.start
    body.begin(start.get("rotation_1", 0.0), start.get("rotation_rate_1", 0.0))
    body.largest = max(body.largest, start.get("peak_rotation_1", 0.0))
    body.arc = max(body.arc, start.get("swing_peak_1", 0.0))
    body.earlier = start.get("impacts", 0.0)
    pitching = float(block.pitch_per_acceleration[0]), float(block.pitch_low_pass[0])
    gains = block.oscillator_motion, block.oscillator_force
    driven = (float(x[0]) for x in (*gains, block.oscillator_frequency, block.oscillator_damping))
    shaking = felt(request.shaking, *driven)
    for piece in pitched_pieces(block, shaking, float(request.scale[0]), request.until, *pitching):
        body.advance(piece, shaken=piece.start < request.shaking.duration)
        if body.finished:
            break
    return body.result()


def _kind(block: Block) -> type[Rocking]:
    if math.isfinite(block.friction[0]):
        return Sliding
    if math.isfinite(block.first_frequency[0]):
        return Bending
    return Bouncing if block.contact_restitution[0] > 0.0 else Rocking
