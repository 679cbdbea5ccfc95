"""What a diagnosis needs to know of a building on rubber bearings: no state of the bearings is measured."""

from __future__ import annotations

from models.identification import Identification, Lead, State

IDENTIFICATION = Identification(
    leads=(Lead("level_displacement_x", 1, "base"),),
    states=(State("bearing_displacement"), State("bearing_velocity")),
    windows=None,
    chaotic=False,
    not_carried=("the strain history of the rubber that its laws remember",),
)
