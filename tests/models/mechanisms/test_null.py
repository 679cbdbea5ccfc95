"""At its null value a mechanism leaves the base model alone, in the plain kernel and in the general one."""

import numpy as np
import pytest

from models.housner.block import build
from models.housner.lanes import run as lanes
from tests.models.mechanisms.cases import HOUSNER, TYPICAL, WALL, dotted, pulse


@pytest.mark.parametrize("name", TYPICAL)
def test_null_equals_base(name: str) -> None:
    shaking = pulse(3.9, 0.5)
    plain = build({**WALL, "restitution_amplitude_exponent": 0.1}, False)
    base = lanes.run(plain, shaking, np.ones(1), samples=shaking.horizontal.size)
    nulls = HOUSNER.mechanisms[name].nulls
    # a second lane with a couple makes the first one run in the kernel of all mechanisms
    values = {
        **WALL,
        "restitution_amplitude_exponent": 0.1,
        "viscous_damping.rate": np.array([0.0, 0.5]),
        **{key: np.full(2, value) for key, value in dotted(name, nulls).items()},
    }
    if name == "viscous_damping":
        values["quadratic_damping.coefficient"] = values[f"{name}.rate"] = np.array([0.0, 0.5])
    general = build(values, False)
    assert plain.plain and general.take([0]).plain and not general.plain
    ran = lanes.run(general, shaking, np.ones(2), samples=shaking.horizontal.size)
    for told, expected in ((ran.rotation, base.rotation), (ran.rate, base.rate)):
        assert told is not None and expected is not None
        np.testing.assert_allclose(told[0], expected[0], rtol=0, atol=1e-12 * np.max(np.abs(expected)))
    assert ran.shift is not None
    np.testing.assert_array_equal(ran.shift[0], 0.0)
    both = lanes.outputs(plain, base.result), lanes.outputs(general, ran.result)
    for output in both[0]:
        np.testing.assert_allclose(both[1][output][0], both[0][output][0], rtol=1e-11, err_msg=output)


@pytest.mark.parametrize("name", TYPICAL)
def test_a_typical_value_does_not(name: str) -> None:
    shaking = pulse(3.9, 0.5)
    base = lanes.run(build(WALL, False), shaking, np.ones(1), samples=shaking.horizontal.size)
    block = build({**WALL, **dotted(name, TYPICAL[name])}, False)
    ran = lanes.run(block, shaking, np.ones(1), samples=shaking.horizontal.size)
    assert base.rotation is not None and ran.rotation is not None
    assert np.max(np.abs(ran.rotation - base.rotation)) > 1e-4 * np.max(np.abs(base.rotation))
