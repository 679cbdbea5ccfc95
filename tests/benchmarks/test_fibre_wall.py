"""The program apart that moves walls in the benchmark, against the model's own lanes."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest
from scipy.signal import butter, sosfiltfilt

from benchmarks.diagnosis import fibre_wall
from benchmarks.diagnosis.open_laws import LAWS
from models.interface.model import MODEL
from models.shaking import Shaking

WALL = {
    "wall_length": 1.2, "wall_height": 1.9, "wall_mass": 280.0, "top_length": 1.2, "top_height": 0.5,
    "top_mass": 4000.0,
    "layer_thickness": 0.01, "base_stiffness": 5e7, "top_stiffness": 4e7, "base_damping": 4e5, "top_damping": 3e5,
}  # fmt: skip
STEP = 0.002
LAW = LAWS["right_damping"]
ROUGH = {"maxwell.arm_stiffness_ratio", "bouc_wen.exponent", "mullins.strain"}
"""Where the programs differ more: the lanes' 16 Gauss points of a law with history (for a Maxwell arm the model's
reference is within 1 % of the fibres with 16 points, within 2e-4 with 48)."""


def shaking() -> Shaking:
    """Four seconds of noise between .5 and 6 Hz that lifts the wall."""
    noise = np.random.default_rng(4).normal(size=2000)
    motion = sosfiltfilt(butter(2, (0.5, 6.0), "bandpass", fs=1.0 / STEP, output="sos"), noise)
    motion *= np.minimum(1.0, STEP * np.arange(2000))
    return Shaking(STEP, 3.5 * motion / np.max(np.abs(motion)))


def lanes(mechanisms: Mapping[str, float]) -> np.ndarray:
    channels = MODEL.simulate({**WALL, **mechanisms}, shaking()).channels
    return np.stack([channels["rotation_1"], channels["rotation_2"]])


def fibres(mechanisms: Mapping[str, float], size: float = 0.0, count: int = fibre_wall.FIBRES) -> np.ndarray:
    """Of the program apart, with a law outside the catalogue of this size (so that it compiles once)."""
    numbers = (size, *(6 * (0.0,)))
    return fibre_wall.run(WALL, shaking().horizontal, STEP, mechanisms, LAW, numbers, fibres=count)


def apart(one: np.ndarray, other: np.ndarray) -> float:
    return float(np.sqrt(np.mean((one - other) ** 2) / np.mean(other**2)))


@pytest.mark.parametrize(
    "mechanisms",
    [
        {},
        {"maxwell.arm_stiffness_ratio": 0.8, "maxwell.relaxation_time": 0.1},
        {"hardening.beta2": 40.0},
        {"mullins.softening": 0.4, "mullins.strain": 0.3},
        {"bouc_wen.post_yield_ratio": 0.5, "bouc_wen.yield_compression": 1e-3, "bouc_wen.exponent": 2.0},
        {"pivot_inset.inset_over_half_width": 0.15, "one_sided_stiffness.right_over_left": 1.5},
        {"tilt.tilt": 0.004, "eccentricity.offset_top": 0.02},
        {"added_stiffness.couple_stiffness": 2e5, "viscous_damping.couple_damping": 1e4},
        {"coulomb_damping.over_m_g_b": 0.02},
        {"coulomb_damping.over_m_g_b": 0.1},
        {"interface_shear.shear_over_normal": 1.0},
    ],
    ids=lambda mechanisms: "+".join(sorted({name.split(".")[0] for name in mechanisms})) or "plain",
)
def test_both_programs_move_a_wall_alike(mechanisms: dict[str, float]) -> None:
    plain, found = lanes({}), lanes(mechanisms)
    assert np.max(np.abs(plain[0])) > 2.0 * float(MODEL.derive(WALL)["uplift_rotation"][0])
    assert not mechanisms or apart(found, plain) > 0.05
    assert apart(fibres(mechanisms), found) < (0.016 if ROUGH & set(mechanisms) else 0.005)


def test_fibres_lose_their_number_squared_of_the_stiffness() -> None:
    exact = lanes({})
    few, many = (apart(fibres({}, count=n), exact) for n in (12, 24))
    assert few / many == pytest.approx(4.0, rel=0.25)


def test_a_law_outside_the_catalogue_acts_as_a_couple_on_the_wall() -> None:
    assert fibre_wall.knows(LAW) and not fibre_wall.knows(LAWS["sloshing"])
    off, on = fibres({}), fibres({}, 2.0)
    right = off[0] > 0.5 * np.max(off[0])
    assert np.max(np.abs(on[0][right])) < np.max(np.abs(off[0][right]))
