"""The no-tension strip: closed form against quadrature, and the static uplift curve."""

import itertools

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from models.interface.lanes.strip import resultants, slopes
from models.interface.observe import share
from models.interface.stored import in_contact
from models.interface.strip import pressing, stored, strip


def quadrature(b, k, c, z, s, z_rate, s_rate, clip):
    """Midpoints of 400 000 fibres."""
    n = 400_000
    x = (np.arange(n) + 0.5) / n * 2.0 * b - b
    w, rate = z - x * s, z_rate - x * s_rate
    stress = np.where(w < 0.0, -(k * w + c * rate), 0.0)
    if clip:
        stress = np.maximum(stress, 0.0)
    return stress.sum() * 2.0 * b / n, (stress * x).sum() * 2.0 * b / n


STATES = st.tuples(
    st.floats(0.1, 1.5), st.floats(1e6, 1e9), st.floats(0.0, 3e6), st.floats(-4e-3, 4e-3), st.floats(-0.1, 0.1),
    st.floats(-0.2, 0.2), st.floats(-1.0, 1.0), st.booleans(),
)  # fmt: skip


@settings(max_examples=60, deadline=None, derandomize=True)
@given(STATES)
def test_forces_are_the_integrals_of_the_stress(state) -> None:
    b, k, c, z, s, z_rate, s_rate, clip = state
    force, moment = quadrature(*state)
    found = strip(b, k, c, z, s, z_rate, s_rate, clip)
    size = 2.0 * b * (k * (abs(z) + b * abs(s)) + c * (abs(z_rate) + b * abs(s_rate)))
    assert found.force == pytest.approx(force, abs=2e-5 * size)
    assert found.moment == pytest.approx(moment, abs=2e-5 * size * b)


def test_eight_thousand_random_states_against_gauss_points_between_the_kinks() -> None:
    rng = np.random.default_rng(4)
    nodes, weights = np.polynomial.legendre.leggauss(4)
    worst = 0.0
    for _ in range(8000):
        b, k, c = rng.uniform(0.1, 1.5), np.exp(rng.uniform(14, 20)), np.exp(rng.uniform(5, 14))
        z, s, z_rate, s_rate = rng.normal(0, 2e-3), rng.normal(0, 0.03), rng.normal(0, 0.1), rng.normal(0, 0.3)
        cuts = [-b, b, z / s, (k * z + c * z_rate) / (k * s + c * s_rate)]
        cuts = np.sort(np.clip(cuts, -b, b))
        force = moment = scale = 0.0
        for low, high in itertools.pairwise(cuts):
            x = 0.5 * (low + high) + 0.5 * (high - low) * nodes
            stress = -(k * (z - x * s) + c * (z_rate - x * s_rate))
            stress = np.where(z - x * s < 0.0, np.maximum(stress, 0.0), 0.0)
            force += 0.5 * (high - low) * weights @ stress
            moment += 0.5 * (high - low) * weights @ (stress * x)
        scale = 2.0 * b * (k * (abs(z) + b * abs(s)) + c * (abs(z_rate) + b * abs(s_rate)))
        found = strip(b, k, c, z, s, z_rate, s_rate, True)
        worst = max(worst, abs(found.force - force) / scale, abs(found.moment - moment) / (scale * b))
    assert worst < 4e-15


@settings(max_examples=300, deadline=None, derandomize=True)
@given(STATES)
def test_the_branch_free_strip_of_the_lanes_is_the_same(state) -> None:
    b, k, c, z, s, z_rate, s_rate, clip = state
    # at the very edges (an underside that just touches, a stress that vanishes everywhere) the share is undetermined
    assume(abs(z) > 1e-9 and abs(k * z + c * z_rate) > 1e-6 * k)
    slow = strip(b, k, c, z, s, z_rate, s_rate, clip)
    slope, steep, lean = slopes.py_func(k, c, s, s_rate)
    fast = resultants.py_func(
        b, float(clip), z, k * z + c * z_rate, s, slope, steep, lean, 1.0 / (lean * steep), 3.0
    )  # fmt: skip
    size = 2.0 * b * (k * (abs(z) + b * abs(s)) + c * (abs(z_rate) + b * abs(s_rate)))
    assert fast[0] == pytest.approx(slow.force, abs=1e-13 * size + 1e-30)
    assert fast[1] == pytest.approx(slow.moment, abs=1e-13 * size * b + 1e-30)
    assert fast[5] / (2.0 * b) == pytest.approx(slow.share, abs=1e-12)
    # the tangent stiffness: integrals of a constant times 1, x, x^2 over the stretch that presses
    low, high = pressing((-b, b), k, c, z, s, z_rate, s_rate, clip)
    for power in (1, 2, 3):
        exact = 3.0 * (high**power - low**power) / power
        assert fast[1 + power] == pytest.approx(exact, abs=1e-11 * b**power)


@pytest.mark.parametrize("share", [0.2, 0.9, 1.0, 1.5, 4.0, 30.0])
def test_static_uplift_curve_under_constant_weight(share: float) -> None:
    b, k, weight = 0.36, 6.21e7, 5.0e4
    uplift = weight / (2.0 * k * b**2)
    lean = share * uplift
    # balance of the weight: full contact below uplift, else contact length sqrt(2 W/(k S))
    z = -weight / (2.0 * k * b) if share <= 1.0 else lean * (b - np.sqrt(2.0 * weight / (k * lean)))
    found = strip(b, k, 0.0, z, lean)
    assert found.force == pytest.approx(weight, rel=1e-12)
    curve = weight * b * (share / 3.0 if share <= 1.0 else 1.0 - 2.0 / 3.0 * np.sqrt(1.0 / share))
    assert found.moment == pytest.approx(curve, rel=1e-12)


def test_the_dashpot_may_pull_under_law_a_and_never_under_law_b() -> None:
    pulled = {"b": 0.36, "k": 6e7, "c": 8e5, "z": -1e-3, "s": 0.0, "z_rate": 0.2, "s_rate": 0.0}
    assert strip(**pulled, clip=False).force < 0.0
    assert strip(**pulled, clip=True).force == 0.0


@pytest.mark.parametrize("lean", [5e-324, -5e-324])
@pytest.mark.parametrize("z", [2e-3, -2e-3])
def test_a_lean_too_small_to_divide_by_is_none(lean: float, z: float) -> None:
    """A solver of states may end there; the line through the contact then has its root beyond all numbers."""
    b, k = np.array([0.3]), np.array([4e7])
    level, slopes = np.array([z]), (np.array([lean]), np.zeros(1))
    tiny, flat = (stored(b, k, level, s) for s in slopes)
    assert tiny == pytest.approx(flat, rel=1e-12)
    tiny, flat = (np.diff(in_contact((-b, b), level, s), axis=0) for s in slopes)
    assert tiny == pytest.approx(flat, rel=1e-12)
    still = np.zeros(1)
    tiny, flat = (share(b, still, level, s, still - 1.0, still) for s in slopes)
    assert tiny == pytest.approx(flat, rel=1e-12)
