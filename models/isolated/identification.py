"""What a diagnosis needs to know of a building on rubber bearings: it runs once from rest through each recording.

The motion is not sensitive to its start, and a test begins at rest with rubber that remembers nothing: nothing has to
be measured or carried at the start of a window.
"""

from __future__ import annotations

from models.identification import Identification, Lead, State, Stretches

IDENTIFICATION = Identification(
    leads=(Lead("level_displacement_x", 1, "base"),),
    states=(State("bearing_displacement"), State("bearing_velocity")),
    windows=None,
    chaotic=False,
    whole={"bouc_wen.exponent": (1.0, 2.0), "bouc_wen_2.exponent": (1.0, 2.0)},
    stretches=Stretches(
        unit=lambda d: 1.0 / d["frequency_1"],
        mean=0.05,
        length=5.0,
        smooth=(0.1, 0.3),
        integrals=(("level_displacement_x", "level_acceleration_x"),),
    ),
    most_effects=4,
    further_work=3.2,
)
