"""What a diagnosis needs to know of walls on rubber layers that lift: rotations lead, the rest is carried."""

from __future__ import annotations

from models.identification import Exposure, Identification, Lead, State, WindowLengths

PROPERTIES = ("stiffness", "layer_modulus", "damping", "damping_ratio")


def _of_layer(joint: str) -> tuple[Exposure, Exposure]:
    """What may have changed the layer of a joint, both layers where ``joint`` is empty."""
    before, after = (f"{joint}_", f"_{joint}") if joint else ("", "")
    of = tuple(f"{before}{name}" for name in PROPERTIES)
    which = f"the {joint} layer" if joint else "either layer"
    return (
        Exposure("strain", f"largest strain of {which} so far", f"peak_strain{after}", of),
        Exposure("cycles", f"closings of {which} so far", f"impacts{after}", of, summed=True),
    )


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
    exposures=(*_of_layer("base"), *_of_layer("top"), *_of_layer("")),
)
