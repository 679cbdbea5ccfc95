"""What a diagnosis needs to know of two stacked blocks: both rotations lead and are measured.

Forces outside the library are not declared: which bodies an impulse at a joint moves depends on which joints are open.
"""

from __future__ import annotations

from models.identification import Identification, Lead, State, WindowLengths
from models.stacked.ladder import LADDER

IDENTIFICATION = Identification(
    leads=(Lead("rotation_1", 1, "base"), Lead("rotation_2", 2, "top")),
    states=(
        State("rotation_1", "rotation_1"),
        State("rotation_rate_1", "rotation_1", rate=True),
        State("rotation_2", "rotation_2"),
        State("rotation_rate_2", "rotation_2", rate=True),
    ),
    windows=WindowLengths(
        shortest=1.0, aim=2.0, longest=2.8, quiet=1.2, smoothing=0.17, unit=lambda d: 1.0 / d["frequency_parameter"]
    ),
    chaotic=True,
    ladder=LADDER,
)
