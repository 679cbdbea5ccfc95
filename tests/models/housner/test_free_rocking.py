"""Free rocking against closed forms: quarter period, impact velocity, decay of the peaks, rest."""

import numpy as np
import pytest
from scipy.special import ellipk, ellipkinc

from models.shaking import Shaking
from tests.models.housner.adapter import EXACT, INTEGRATORS, history, rectangle

P = 2.0


def test_quarter_period_of_the_oracle() -> None:
    """The closed form itself, to the twelve digits of the published table."""
    alpha, start = 0.25, 0.15
    k = np.cos((alpha - start) / 2)
    # the amplitude belongs to the pendulum measured from its inverted rest position
    quarter = ellipk(k**2) - ellipkinc(np.arcsin(np.cos(alpha / 2) / k), k**2)
    assert quarter == pytest.approx(1.568974874250, abs=1e-12)
    assert np.arccosh(1 / (1 - start / alpha)) == pytest.approx(1.566799236972, abs=1e-12)


@pytest.mark.parametrize("integrator", EXACT)
@pytest.mark.parametrize(("linear", "expected"), [(False, 1.568974874250), (True, 1.566799236972)])
def test_quarter_period(integrator: str, linear: bool, expected: float) -> None:
    silence = Shaking.silence(1.0, 0.0025)
    run = history(integrator, rectangle(0.25, P), silence, initial={"rotation_1": 0.15}, linear=linear)
    first = run.events[0]
    assert first.kind == "impact"
    assert P * first.time == pytest.approx(expected, abs=2e-11)


@pytest.mark.parametrize("integrator", EXACT)
def test_velocity_at_impact(integrator: str) -> None:
    """From the energy the first impact takes: (1 - e^2) I_O theta'^2 / 2."""
    values = rectangle(0.25, P, restitution=0.8)
    outputs = history(integrator, values, Shaking.silence(0.9, 0.0025), initial={"rotation_1": 0.15}).outputs
    radius = np.hypot(values["width"], values["height"]) / 2
    corner = 4 / 3 * values["mass"] * radius**2
    rate = np.sqrt(2 * outputs["dissipated_energy"] / (corner * (1 - 0.8**2)))
    assert outputs["impacts"] == 1
    assert rate / P == pytest.approx(0.228437052894, abs=2e-11)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_peaks_of_free_rocking(integrator: str) -> None:
    """cos(alpha - theta_n) - cos(alpha) = e^2 [cos(alpha - theta_n-1) - cos(alpha)]."""
    alpha = 0.2
    shown = [0.612708, 0.502588, 0.422332, 0.359602, 0.308789, 0.266730]
    run = history(integrator, rectangle(alpha, P), Shaking.silence(9.0, 0.001), initial={"rotation_1": 0.8 * alpha})
    size = np.abs(run.channels["rotation_1"]) / alpha
    top = np.flatnonzero((size[1:-1] > size[:-2]) & (size[1:-1] >= size[2:])) + 1
    assert run.outputs["peak_rotation_ratio"] == pytest.approx(0.8, rel=1e-15)
    np.testing.assert_allclose(size[top][:6], shown, rtol=0, atol=2e-6)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_all_energy_is_lost_when_the_block_is_at_rest(integrator: str) -> None:
    values = rectangle(0.25, P)
    run = history(integrator, values, Shaking.silence(30.0, 0.0025), initial={"rotation_1": 0.15})
    radius = np.hypot(values["width"], values["height"]) / 2
    released = values["mass"] * values["gravity"] * radius * (np.cos(0.1) - np.cos(0.25))
    accuracy = 1e-4 if integrator == "newmark" else 1e-9
    outputs, last = run.outputs, run.events[-1]
    assert last.kind == "rest"
    assert run.channels["rotation_1"][-1] == 0.0 == outputs["residual_rotation"]
    assert outputs["dissipated_energy"] == pytest.approx(released, rel=accuracy)
    assert outputs["uplift_duration"] == pytest.approx(last.time, rel=1e-12)
    assert np.isnan(outputs["overturning_time"])
