"""Laws in combination by the compiled kernels: each in a pass of its own, with the numbers of the laws alone."""

import numpy as np
import pytest

from models.interface.lanes import run as walls
from models.isolated.lanes import run as buildings
from models.rubber import LAWS
from models.rubber import lanes as rubber
from models.shaking import Shaking
from tests.models.interface.walls import SHORT, wall
from tests.models.isolated.buildings import BODY, chain
from tests.models.requests import asked

TIME = 0.01 * np.arange(151)
SHAKING = Shaking(0.01, 2.0 * np.sin(2 * np.pi * 1.3 * TIME))
TYPICAL = {
    "hardening.beta2": 3.0, "maxwell.arm_stiffness_ratio": 0.5, "maxwell.relaxation_time": 0.1,
    "mullins.softening": 0.3, "mullins.strain": 0.2,
}  # fmt: skip
NULL = {"hardening.beta2": 0.0, "maxwell.arm_stiffness_ratio": 0.0, "mullins.softening": 0.0}


def given(name: str) -> dict[str, float]:
    return {key: value for key, value in TYPICAL.items() if key.startswith(name)}


@pytest.mark.parametrize("name", ["hardening", "maxwell", "mullins"])
def test_a_law_in_a_combination_of_nulls_is_the_law_alone(name: str) -> None:
    nulls = {key: value for key, value in NULL.items() if not key.startswith(name)}
    for run, build, values in ((walls.run, wall, SHORT), (buildings.run, chain, BODY)):
        request = asked(SHAKING, samples=151)
        alone, among = (run(build({**values, **given(name), **more}), request).samples for more in ({}, nulls))
        np.testing.assert_allclose(among, alone, rtol=0, atol=1e-12 * np.max(np.abs(alone)))
        plain = run(build(values), request).samples
        assert np.max(np.abs(plain - alone)) > 1e-3 * np.max(np.abs(alone))


def test_the_bits_say_which_laws_act() -> None:
    for laws in ((), ("maxwell",), ("hardening", "mullins"), tuple(LAWS)):
        bits = rubber.acting([(LAWS[name], {}) for name in laws])
        assert {law.name for k, law in enumerate(rubber.ORDER) if bits >> k & 1} == set(laws)
