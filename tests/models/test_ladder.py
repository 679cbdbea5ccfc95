"""What a specimen becomes as a specimen of another base model: the same masses in the same places."""

from __future__ import annotations

import numpy as np
import pytest

import models
from models.housner import ladder as of_block
from models.identification import Rung
from models.walls import bodies

BLOCKS = {
    "pier": {"width": 0.5, "height": 2.3, "mass": 1380.0},
    "by its aspect ratio": {"aspect_ratio": 0.22, "height": 2.3, "mass": 1380.0},
    "with a mass on top": {
        "width": 0.5, "height": 1.5, "mass": 900.0, "top_mass": 450.0, "top_mass_height": 0.4, "top_mass_inertia": 30.0,
    },
}  # fmt: skip
STACK = {
    "wall_length": 0.5, "wall_height": 1.5, "wall_mass": 900.0, "top_mass": 450.0, "top_length": 0.4, "top_height": 1.0,
}  # fmt: skip
RUNGS = [
    (name, k) for name in models.MODELS for k in range(len(getattr(models.get(name).identification, "ladder", ())))
]


def test_every_rung_is_looked_at_here() -> None:
    declared = {name: models.get(name).identification for name in models.MODELS}
    assert [(name, k) for name, found in declared.items() if found for k in range(len(found.ladder))] == RUNGS


def rung_of(name: str, k: int) -> Rung:
    found = models.get(name).identification
    assert found is not None
    return found.ladder[k]


@pytest.mark.parametrize("share", [0.2, 0.5, 0.9])
@pytest.mark.parametrize("block", BLOCKS.values(), ids=BLOCKS)
def test_a_block_that_is_cut_keeps_mass_mass_centre_and_inertia(block: dict[str, float], share: float) -> None:
    parts = bodies(of_block.cut(block, share))
    whole = models.get("housner").derive(block)
    mass = block["mass"] + block.get("top_mass", 0.0)
    over = 2.0 * parts.half_height_1 + parts.half_height_2
    centre = (parts.mass_1 * parts.half_height_1 + parts.mass_2 * over) / mass
    half = parts.half_length_1
    about_corner = (
        parts.inertia_1 + parts.mass_1 * (half**2 + parts.half_height_1**2)
        + parts.inertia_2 + parts.mass_2 * (half**2 + over**2)
    )  # fmt: skip
    radius = np.hypot(half, centre)
    np.testing.assert_allclose(parts.mass_1 + parts.mass_2, mass, rtol=1e-12)
    np.testing.assert_allclose(np.arctan2(half, centre), whole["alpha"], rtol=1e-12)
    np.testing.assert_allclose(np.sqrt(mass * 9.80665 * radius / about_corner), whole["frequency_parameter"], rtol=1e-9)


def test_a_mass_on_top_cut_off_at_the_top_of_the_block_is_itself() -> None:
    top = {"top_mass": 450.0, "top_length": 0.4, "top_height": 1.0}
    inertia = top["top_mass"] * (top["top_length"] ** 2 + top["top_height"] ** 2) / 12.0
    block = {"width": 0.5, "height": 1.5, "mass": 900.0, "top_mass": 450.0}
    found = of_block.cut({**block, "top_mass_height": 0.5, "top_mass_inertia": inertia}, 1.0)
    assert {name: found[name] for name in top} == pytest.approx(top, rel=1e-9)


@pytest.mark.parametrize(("name", "k"), RUNGS)
def test_what_a_rung_carries_over_is_a_specimen_of_the_other_model(name: str, k: int) -> None:
    rung, base = rung_of(name, k), BLOCKS["pier"] if name == "housner" else STACK
    other = models.get(rung.model)
    ranges = rung.ranges(base)
    assert list(ranges) == [p.name for p in rung.parameters] and not rung.refusal(base)
    middle = {n: float(np.sqrt(low * high)) for n, (low, high) in ranges.items()}
    values = rung.values({**base, **{f"{rung.name}.{n}": value for n, value in middle.items()}})
    assert not other.check(values, rung.options)
    assert set(values) <= {p.name for p in other.parameters}
    assert set(rung.without) <= {p.name for p in models.get(name).parameters}
    assert rung.mechanism.says(middle)
    own, theirs = models.get(name).identification, other.identification
    assert own is not None and theirs is not None
    states = {state.name for state in theirs.free}
    assert set(rung.alike) | set(rung.alike.values()) <= states


def test_a_stiff_layer_under_a_block_begins_to_lift_where_the_rigid_block_begins_to_rock() -> None:
    """The tilt at which the resultant leaves the middle third, over that of the toe: 1/3 of a stiff strip's."""
    rung = next(r for r in (rung_of("housner", k) for k in range(3)) if r.bonded)
    block = BLOCKS["pier"]
    stiff = rung.ranges(block)["base_stiffness"][1]
    own = {f"{rung.name}.base_stiffness": stiff, f"{rung.name}.base_damping_ratio": 0.05}
    values = rung.values({**block, **own})
    weight, length = block["mass"] * 9.80665, block["width"]
    found = models.get(rung.model).derive(values, rung.options)
    np.testing.assert_allclose(found["uplift_rotation"], 2.0 * weight / (stiff * length**2), rtol=1e-6)
    np.testing.assert_allclose(found["alpha"], models.get("housner").derive(block)["alpha"], rtol=1e-2)


def test_blocks_that_cannot_be_cut_say_why() -> None:
    rung = rung_of("housner", 0)
    assert "inertia" in rung.refusal({**BLOCKS["pier"], "inertia": 500.0})
    assert "no mass" in rung.refusal({"width": 0.5, "height": 2.3, "mass": 0.0, "top_mass": 900.0})


def test_a_joint_below_nothing_is_not_looked_for() -> None:
    """At the top of a block only if there is a mass on it."""
    block = {"width": 0.4, "height": 1.6, "mass": 500.0, "top_mass_height": 0.2}
    assert of_block.joints(block)["joint_over_height"][1] < 1.0
    assert of_block.joints({**block, "top_mass": 100.0})["joint_over_height"][1] == 1.0
