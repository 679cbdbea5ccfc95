"""The stiffness that a fit works with is the slope of the layers' laws under the static load."""

from __future__ import annotations

import numpy as np
import pytest

from models.interface import modes
from tests.models.interface.walls import MODEL, wall

LAYERS = {
    "wall_length": 0.72, "wall_height": 1.8, "wall_mass": 161.0, "top_mass": 5000.0, "top_length": 0.72,
    "top_height": 0.6, "layer_thickness": 0.01, "base_damping": 8.7e5, "top_damping": 4.0e5,
}  # fmt: skip
GIVEN = {"base_stiffness": 4.0e7, "top_stiffness": 5.0e7}
LAWS = [
    {"hardening.beta2": 60.0},
    {"mullins.softening": 0.4, "mullins.strain": 0.1},
    {"locking.lock_strain": 1.5},
    {"bouc_wen.post_yield_ratio": 0.4, "bouc_wen.yield_compression": 2e-3, "bouc_wen.exponent": 2.0},
    {"hardening.beta2": 60.0, "mullins.softening": 0.4, "mullins.strain": 0.1},
]


@pytest.mark.parametrize("law", LAWS)
def test_layers_have_the_slope_that_was_asked_for(law: dict[str, float]) -> None:
    found = MODEL.declared({**LAYERS, **GIVEN, **law}, tuple(GIVEN))
    one = wall({**LAYERS, **{name: float(x[0]) for name, x in found.items()}, **law})
    slopes = modes.tangents(one, modes.static_state(one))
    np.testing.assert_allclose([s[0] for s in slopes], list(GIVEN.values()), rtol=2e-3)


@pytest.mark.parametrize("softer", [1.0, 0.9, 0.7, 0.5, 0.45])
def test_a_layer_that_yields_and_softens_has_a_slope_at_which_it_could_not_stand(softer: float) -> None:
    """The slope under the load is a fraction of the stiffness: a layer as stiff as the slope would be crushed."""
    law = {
        "bouc_wen.post_yield_ratio": 0.4, "bouc_wen.yield_compression": 6e-4, "bouc_wen.exponent": 1.0,
        "mullins.softening": 0.62, "mullins.strain": 0.33,
    }  # fmt: skip
    asked = {name: softer * value for name, value in GIVEN.items()}
    assert (softer < 1.0) == bool(np.any(np.isnan(modes.static_state(wall({**LAYERS, **asked, **law})))))
    found = MODEL.declared({**LAYERS, **asked, **law}, tuple(asked))
    one = wall({**LAYERS, **{name: float(x[0]) for name, x in found.items()}, **law})
    slopes = modes.tangents(one, modes.static_state(one))
    np.testing.assert_allclose([s[0] for s in slopes], list(asked.values()), rtol=1e-4)


def test_an_arm_that_is_relaxed_at_rest_is_no_part_of_it() -> None:
    found = MODEL.declared({**LAYERS, **GIVEN, "maxwell.arm_stiffness_ratio": 0.8}, tuple(GIVEN))
    assert not found


def test_each_wall_has_its_own_and_one_that_cannot_stand_keeps_what_it_has() -> None:
    law = {"bouc_wen.post_yield_ratio": np.array([1.0, 1e-6]), "bouc_wen.yield_compression": 1e-4}
    stiff = {"hardening.beta2": np.array([0.0, 60.0])}
    assert MODEL.declared({**LAYERS, **GIVEN, **law}, ("base_stiffness",))["base_stiffness"][1] == 4.0e7
    plain, hard = MODEL.declared({**LAYERS, **GIVEN, **stiff}, ("base_stiffness",))["base_stiffness"]
    assert plain == 4.0e7 and hard < 3.5e7


def test_a_modulus_of_both_layers_is_the_stiffness_of_both() -> None:
    modulus = {"layer_modulus": 4.0e6, "wall_thickness": 0.1}
    found = MODEL.declared({**LAYERS, **modulus, "hardening.beta2": 60.0}, ("layer_modulus",))["layer_modulus"]
    each = MODEL.declared(
        {**LAYERS, "base_stiffness": 4.0e7, "top_stiffness": 4.0e7, "hardening.beta2": 60.0}, tuple(GIVEN)
    )
    np.testing.assert_allclose(found[0] * 10.0, np.mean([x[0] for x in each.values()]), rtol=1e-9)
