"""At its null value a mechanism leaves the base model alone, in the plain kernel and in the general one."""

import numpy as np
import pytest

from models.housner.lanes import run as lanes
from models.runs import Request
from tests.models.mechanisms.cases import HOUSNER, TYPICAL, WALL, dotted, pulse


@pytest.mark.parametrize("name", TYPICAL)
def test_null_equals_base(name: str) -> None:
    shaking = pulse(3.9, 0.5)
    plain = HOUSNER.build({**WALL, "restitution_amplitude_exponent": 0.1})
    base = lanes.run(plain, Request(shaking, np.ones(1), samples=shaking.horizontal.size))
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
    general = HOUSNER.build(values)
    assert plain.plain and general.take([0]).plain and not general.plain
    ran = lanes.run(general, Request(shaking, np.ones(2), samples=shaking.horizontal.size))
    for channel, expected in zip(ran.samples[0].T[:2], base.samples[0].T[:2], strict=True):
        np.testing.assert_allclose(channel, expected, rtol=0, atol=1e-12 * np.max(np.abs(expected)))
    np.testing.assert_array_equal(ran.samples[0, :, 2], 0.0)
    for output, expected in base.outputs.items():
        np.testing.assert_allclose(ran.outputs[output][0], expected[0], rtol=1e-11, err_msg=output)


@pytest.mark.parametrize("name", TYPICAL)
def test_a_typical_value_does_not(name: str) -> None:
    shaking = pulse(3.9, 0.5)
    request = Request(shaking, np.ones(1), samples=shaking.horizontal.size)
    base = lanes.run(HOUSNER.build(WALL), request).samples[..., 0]
    block = HOUSNER.build({**WALL, **dotted(name, TYPICAL[name])})
    ran = lanes.run(block, request).samples[..., 0]
    assert np.max(np.abs(ran - base)) > 1e-4 * np.max(np.abs(base))
