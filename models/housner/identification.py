"""What a diagnosis needs to know of the one-block model: theta leads, impacts separate, wear is remembered."""

from __future__ import annotations

from models.housner.ladder import LADDER
from models.identification import (
    Closing,
    Count,
    Force,
    Identification,
    Largest,
    Lead,
    Port,
    Scatter,
    Separation,
    State,
    WindowLengths,
)
from models.unknown_forces import DEPENDENCES, PHASES, couples, over_largest_base

BASE = Port("base", lambda seen: seen["rotation_1"], lambda block, at: {"rotation_rate_1": -1.0})
"""A couple between block and base, over the moment of inertia about the corner."""
FORCES = (
    Force("restitution", "loss of velocity at impacts", BASE, None, event="impact"),
    *couples(BASE),
    Force("base_motion", "couple with the base acceleration", BASE, over_largest_base),
)  # fmt: skip

IDENTIFICATION = Identification(
    leads=(Lead("rotation_1", 1, "base"),),
    states=(State("rotation_1", "rotation_1"), State("rotation_rate_1", "rotation_1", rate=True)),
    # In s, not in 1/p: the lengths with which the rates of right answers were measured, on piers of 1 to 2.6 m.
    windows=WindowLengths(shortest=0.3, aim=0.6, longest=0.85, quiet=0.35, smoothing=0.05),
    chaotic=True,
    memories=(Largest("peak_rotation_1", "rotation_1"), Count("impacts", "impact", "rotation_1")),
    forces=FORCES,
    dependences=DEPENDENCES,
    separation=Separation("impact", lambda m: m.coordinate, "between_impacts"),
    scatter=Scatter("impacts", (Closing(BASE, lambda rates: rates["rotation_rate_1"]),)),
    phases={"impact": "at impacts", "between_impacts": "between impacts", **PHASES},
    same={"rotation_2": "rotation_1"},
    ladder=LADDER,
)  # fmt: skip
