"""The kernels of stationary errors: each is the transform of its density."""

from __future__ import annotations

import numpy as np
import pytest

from diagnosis.errors.components import CORNERS, Component

KINDS = [
    Component("low_pass", 0, 0.012),
    Component("exponential", 0, 0.05),
    Component("inadequacy", 0, 0.05),
    *[Component("filtered", 0, corner) for corner in CORNERS],
]


@pytest.mark.parametrize("component", KINDS, ids=lambda c: f"{c.kind}-{c.scale:g}")
def test_a_kernel_is_the_transform_of_its_density(component: Component) -> None:
    """k(lag) = int_0^inf S(f) cos(2 pi f lag) df, k(0) = 1."""
    lag = np.array([0.0, 0.003, 0.02, 0.07, 0.2])
    frequency = np.linspace(0.0, 4000.0, 1_600_001)
    density = component.density(frequency, 0.005)
    found = [np.trapezoid(density * np.cos(2.0 * np.pi * frequency * each), frequency) for each in lag]
    np.testing.assert_allclose(component.kernel(lag), found, atol=2e-3)
    assert component.kernel(lag)[0] == pytest.approx(1.0, abs=1e-12)
