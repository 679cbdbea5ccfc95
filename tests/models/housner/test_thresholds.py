"""Overturning under pulses: thresholds by bisection, to the digits of the published and derived values."""

from collections.abc import Callable

import numpy as np
import pytest
from scipy.optimize import brentq

from models.shaking import Shaking
from tests.models.housner.adapter import history, outcomes, rectangle
from tests.models.housner.pulses import constant, sampled, threshold

P = 2.0
G = 9.80665
STEPS = 6000


def block_of(alpha: float, p: float = P) -> dict[str, float]:
    return rectangle(alpha, p, restitution=0.9)


def sine(omega: float, cycles: float) -> Shaking:
    return sampled(lambda t: np.sin(omega * t), 2 * np.pi * cycles / omega, STEPS)


@pytest.mark.parametrize(("pt", "expected"), [(0.5, 2.541494083), (1.0, 1.581976707), (2.0, 1.156517643)])
def test_rectangular_pulse(pt: float, expected: float) -> None:
    """A = 1/2 [1 + sqrt(1 + 2/(cosh(p t1) - 1))], in alpha g (Housner 1963)."""
    alpha = 0.2
    unit = alpha * G
    closed = 0.5 * (1 + np.sqrt(1 + 2 / (np.cosh(pt) - 1)))
    found = threshold(block_of(alpha), constant(pt / P, 200), unit, 4 * unit, digits=1e-11, linear=True)
    assert closed == pytest.approx(expected, abs=5e-10)
    assert found / unit == pytest.approx(closed, rel=2e-11)


@pytest.mark.parametrize(
    ("w", "expected"),
    [
        (0.5, 1.109417823),
        (1.0, 1.322396598),
        (2.0, 1.800723931),
        (3.0, 2.293872313),
        (5.0, 3.289146778),
        (10.0, 5.786521652),
    ],
)
def test_half_sine(w: float, expected: float) -> None:
    """w sin(psi) - cos(psi) = exp(-(pi - psi)/w), psi = asin(1/A), w = omega/p."""

    def residual(a: float) -> float:
        psi = np.arcsin(1 / a)
        return float(w * np.sin(psi) - np.cos(psi) - np.exp(-(np.pi - psi) / w))

    alpha = 0.2
    unit = alpha * G
    closed = brentq(residual, 1 + 1e-9, 20.0, xtol=1e-13)
    found = threshold(block_of(alpha), sine(w * P, 0.5), 1.05 * unit, 8 * unit, digits=1e-11, linear=True)
    assert closed == pytest.approx(expected, abs=5e-10)
    assert found / unit == pytest.approx(closed, rel=5e-11)


@pytest.mark.parametrize(
    ("w", "expected"), [(1.0, 1.418315336), (2.0, 2.349903127), (3.0, 3.631149872), (5.0, 7.168128797)]
)
def test_full_sine_without_impact(w: float, expected: float) -> None:
    """cos(psi) - w sin(psi) = exp(-(2 pi - psi)/w) (Zhang, Makris 2001)."""

    def residual(a: float) -> float:
        psi = np.arcsin(1 / a)
        return float(np.cos(psi) - w * np.sin(psi) - np.exp(-(2 * np.pi - psi) / w))

    alpha = 0.2
    unit = alpha * G
    closed = brentq(residual, 1.2, 20.0, xtol=1e-13)
    # a little below, the block overturns after one impact or none at all, by e
    found = threshold(
        block_of(alpha),
        sine(w * P, 1.0),
        0.999 * expected * unit,
        1.5 * expected * unit,
        digits=1e-11,
        linear=True,
    )
    assert closed == pytest.approx(expected, abs=5e-10)
    assert found / unit == pytest.approx(closed, rel=5e-11)


@pytest.mark.parametrize(
    ("alpha", "linear", "band", "digits"),
    [
        (0.2, True, (3.018599861, 6.318070530, 7.168128797), 5.5e-10),
        (0.25, False, (3.0323392, 6.7430192, 7.4929997), 5.5e-8),
    ],
)
def test_full_sine_with_one_impact(alpha: float, linear: bool, band: tuple[float, float, float], digits: float) -> None:
    """e = .9, omega/p = 5: overturns in a band, is safe above it, and overturns without impact beyond."""
    unit, shaking, block = alpha * G, sine(5 * P, 1.0), block_of(alpha)
    begin, end, again = band
    for low, high, value, above in (
        (1.5, 4.0, begin, True),
        (4.0, 0.5 * (end + again), end, False),
        (0.5 * (end + again), 9.0, again, True),
    ):
        found = threshold(block, shaking, low * unit, high * unit, digits=1e-11, linear=linear, overturns_above=above)
        assert found / unit == pytest.approx(value, abs=digits)


def test_full_sine_of_zhang_and_makris() -> None:
    """omega = 15.7 rad/s, p = 2.14 s-1, alpha = .25, e = .9, nonlinear, in g."""
    block, shaking = block_of(0.25, 2.14), sine(15.7, 1.0)
    for low, high, value, above in (
        (1.0, 2.4, 2.2232, True),
        (2.4, 3.0, 2.6170, False),
        (3.0, 4.0, 3.4369, True),
    ):
        found = threshold(block, shaking, low * G, high * G, digits=1e-7, overturns_above=above)
        assert found / G == pytest.approx(value, abs=5.5e-5)


def test_full_cosine() -> None:
    """p = 2 s-1, alpha = 15 deg, e = .9, T = 2 s: three bands, in g."""
    block = block_of(np.radians(15.0))
    shaking = sampled(lambda t: np.cos(np.pi * t), 2.0, 2000)
    for low, high, value, above in (
        (0.27, 0.32, 0.3150057, True),
        (0.32, 0.3295, 0.3281605, False),
        (0.3295, 0.335, 0.3314369, True),
        (0.335, 0.349, 0.3460574, False),
        (0.349, 0.36, 0.3510708, True),
    ):
        found = threshold(block, shaking, low * G, high * G, digits=1e-9, overturns_above=above)
        assert found / G == pytest.approx(value, abs=6e-8)


@pytest.mark.parametrize("integrator", ["reference", "newmark"])
@pytest.mark.parametrize(
    ("alpha", "shaking", "value", "linear"),
    [
        (0.2, constant(0.5, 200), 1.581976707 * 0.2 * G, True),
        (0.2, sampled(lambda t: np.sin(4 * t), np.pi / 4, 400), 1.800723931 * 0.2 * G, True),
        (0.25, sampled(lambda t: np.sin(10 * t), np.pi / 5, 400), 3.0323392 * 0.25 * G, False),
        (np.radians(15.0), sampled(lambda t: np.cos(np.pi * t), 2.0, 400), 0.3150057 * G, False),
    ],
)
def test_brackets_of_the_other_integrators(
    integrator: str, alpha: float, shaking: Shaking, value: float, linear: bool
) -> None:
    """Safe just below each threshold, overturned just above it."""
    width = 1e-3 if integrator == "newmark" else 1e-6
    block = block_of(alpha)
    scale = value * np.array([1 - width, 1 + width])
    tail = 6.0 if integrator == "newmark" else 10.0  # lingering for ln(1/width)/p
    over = outcomes(integrator, block, shaking, scale, tail=tail, linear=linear, outputs=["overturned"])["overturned"]
    assert over.tolist() == [False, True]


def test_velocity_impulse_that_overturns() -> None:
    """V = sqrt(8 g R (1 - cos(alpha))/(3 cos^2(alpha))) = .910983 m/s for alpha = atan(.25), R = 1 m.

    The base jumps to velocity V: theta'_0 = 3 V cos(alpha)/(4 R). Two equal impulses, the second one at
    the impact between them, overturn from V/(1 + e) = .476514 m/s on.
    """
    alpha, g = np.arctan(0.25), 9.81
    values = rectangle(alpha, np.sqrt(3 * g / 4), g)
    silence = Shaking.silence(25.0, 0.005)
    jump = 3 * np.cos(alpha) / 4

    def overturns(rate: float) -> bool:
        run = history("lanes", values, silence, initial={"rotation_rate_1": rate})
        return bool(run.outputs["overturned"])

    def critical(starting_rate: Callable[[float], float]) -> float:
        low, high = 0.3, 1.5
        while high - low > 1e-8:
            middle = 0.5 * (low + high)
            low, high = (low, middle) if overturns(starting_rate(middle)) else (middle, high)
        return high

    def after_impact(velocity: float) -> float:
        """The rate with which the block leaves the impact, from the energy it loses there, plus a jump."""
        before = jump * velocity
        silence = Shaking.silence(12.0, 0.005)
        first = history("lanes", values, silence, initial={"rotation_rate_1": before}).events[0]
        if first.kind != "impact":
            return 100.0
        shortly = Shaking.silence((round(first.time / 0.005) + 1) * 0.005, 0.005)
        lost = history("lanes", values, shortly, initial={"rotation_rate_1": before}).outputs
        energy = 0.5 * 4 / 3 * values["mass"]
        kept = before**2 - lost["dissipated_energy"] / energy
        return float(np.sqrt(kept)) + before

    closed = np.sqrt(8 * g * (1 - np.cos(alpha)) / (3 * np.cos(alpha) ** 2))
    e = 1 - 1.5 * np.sin(alpha) ** 2
    assert closed == pytest.approx(0.910983, abs=5e-7)
    assert critical(lambda v: jump * v) == pytest.approx(closed, abs=1e-7)
    assert closed / (1 + e) == pytest.approx(0.476514, abs=5e-7)
    assert critical(after_impact) == pytest.approx(closed / (1 + e), abs=1e-7)
