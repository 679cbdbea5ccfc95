"""What a diagnosis needs to know of two stacked blocks: both rotations lead and are measured.

Windows last about as long as neighbouring trajectories stay together: an impact or two of either joint.
"""

from __future__ import annotations

from models.identification import Closing, Force, Identification, Lead, Scatter, State, WindowLengths
from models.stacked.ladder import LADDER
from models.stacked.ports import BASE, BLOCK, TOP
from models.unknown_forces import DEPENDENCES, PHASES, couples, over_largest_base, over_largest_rate, over_reach

FORCES = (
    *couples(BASE, where=" in the base"),
    *couples(TOP, "_top", " in the top joint"),
    Force("viscous_damping_block", "force on the upper block with its velocity", BLOCK, over_largest_rate),
    Force("stiffness_block", "force on the upper block with its displacement", BLOCK, over_reach),
    Force("base_motion", "force on the upper block with the base acceleration", BLOCK, over_largest_base),
)

IDENTIFICATION = Identification(
    leads=(Lead("rotation_1", 1, "base"), Lead("rotation_2", 2, "top")),
    states=(
        State("rotation_1", "rotation_1"),
        State("rotation_rate_1", "rotation_1", rate=True),
        State("rotation_2", "rotation_2"),
        State("rotation_rate_2", "rotation_2", rate=True),
    ),
    windows=WindowLengths(
        shortest=0.4, aim=0.8, longest=1.1, quiet=1.2, smoothing=0.17, unit=lambda d: 1.0 / d["frequency_parameter"]
    ),
    chaotic=True,
    forces=FORCES,
    dependences=DEPENDENCES,
    scatter=Scatter(
        "impacts",
        (
            Closing(BASE, lambda rates: rates["rotation_rate_1"]),
            Closing(TOP, lambda rates: rates["rotation_rate_2"] - rates["rotation_rate_1"]),
        ),
    ),
    phases=PHASES,
    ladder=LADDER,
)
