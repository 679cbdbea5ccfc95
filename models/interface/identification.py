"""What a diagnosis needs to know of walls on rubber layers that lift: rotations lead, the rest is carried."""

from __future__ import annotations

from models.identification import Identification, Lead, State, WindowLengths

IDENTIFICATION = Identification(
    leads=(Lead("rotation_1", 1, "base"), Lead("rotation_2", 2, "top")),
    states=(
        State("rotation_1", "rotation_1"),
        State("rotation_2", "rotation_2"),
        State("displacement_z_1", at_rest=lambda d: -d["static_compression_base"]),
        State("displacement_z_2", at_rest=lambda d: -d["static_compression_top"]),
        State("rotation_rate_1", "rotation_1", rate=True),
        State("rotation_rate_2", "rotation_2", rate=True),
        State("velocity_z_1"),
        State("velocity_z_2"),
    ),
    windows=WindowLengths(
        shortest=0.8,
        aim=1.5,
        longest=3.0,
        quiet=1.0,
        smoothing=0.1,
        carrying=0.13,
        unit=lambda d: 1.0 / d["frequency_1"],
    ),
    chaotic=False,
    coordinates=("base_stiffness", "top_stiffness", "layer_modulus", "base_layer_modulus", "top_layer_modulus"),
    whole={"bouc_wen.exponent": (1.0, 2.0)},
    carrying=True,
)
