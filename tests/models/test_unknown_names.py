"""What a model does not have is refused by name: left out in silence, its effect would be missing from every result."""

from __future__ import annotations

import numpy as np
import pytest

import models
from models.errors import InputError, nearest
from models.shaking import Shaking
from tests.models.interface.walls import SHORT
from tests.models.stacked.walls import A

VALUES = {
    "housner": {"width": 0.5, "height": 2.0, "mass": 900.0}, "stacked": A, "interface": SHORT,
    "interface_linear": SHORT, "isolated": {"total_mass": 1e4, "bearing_stiffness": 4e4, "rubber_thickness": 0.1},
}  # fmt: skip
QUIET = Shaking.silence(0.5, 0.01)


def test_the_nearest_name_is_found_in_any_case_and_a_long_list_may_be_shortened() -> None:
    assert nearest("PGA", ["height", "pga"]) == "did you mean 'pga'?"
    assert nearest("fel", ["Fell", "test"]) == "did you mean 'Fell'?"
    assert nearest("nothing", ["b", "a"]) == "known: a, b."
    assert nearest("nothing", ["b", "a", "c"], ["a"]) == "known: a."


@pytest.mark.parametrize("name", VALUES)
def test_a_parameter_with_another_name_is_refused_with_the_nearest(name: str) -> None:
    model = models.get(name)
    known = model.parameters[0].name
    with pytest.raises(InputError, match=f"{name} has no parameter '{known}s'; did you mean '{known}'"):
        model.build({**VALUES[name], f"{known}s": 1.0})
    with pytest.raises(InputError, match=f"no parameter '{known}s'"):
        model.evaluate({**VALUES[name], f"{known}s": 1.0}, QUIET, np.ones(1), outputs=["status"], tail=0.0)


@pytest.mark.parametrize("name", VALUES)
def test_every_mechanism_refuses_a_parameter_that_it_does_not_have(name: str) -> None:
    model = models.get(name)
    for mechanism in model.mechanisms:
        with pytest.raises(InputError, match=f"the mechanism {mechanism} has no parameter 'nothing'"):
            model.build({**VALUES[name], f"{mechanism}.nothing": 0.0})


@pytest.mark.parametrize("name", VALUES)
def test_every_name_that_a_specimen_may_use_is_taken(name: str) -> None:
    model = models.get(name)
    for mechanism in model.mechanisms.values():
        for parameter in mechanism.addressable(name):
            model.build({**VALUES[name], f"{mechanism.name}.{parameter.name}": parameter.null})


def test_a_joint_that_a_mechanism_does_not_tell_apart_is_refused() -> None:
    with pytest.raises(InputError, match="the mechanism pivot_inset has no parameter 'inset_over_half_width_base'"):
        models.get("housner").build({**VALUES["housner"], "pivot_inset.inset_over_half_width_base": 0.1})
