"""What holds for every block and motion: energy, symmetry, similarity, rest."""

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from models.shaking import Shaking
from tests.models.housner.adapter import INTEGRATORS, MODEL, by_reference, outcomes, rectangle
from tests.models.strategies import SEEDS, cases, random_block, random_motion

SETTINGS = settings(max_examples=15, deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow])
Case = tuple[dict[str, float], Shaking, float]


@SETTINGS
@given(cases())
def test_mirrored_shaking_gives_the_mirrored_response(case: Case) -> None:
    values, shaking, scale = case
    assume(not MODEL.check(values))
    mirrored = Shaking(shaking.time_step, -shaking.horizontal, shaking.vertical)
    one = outcomes("lanes", values, shaking, np.array([scale]))
    other = outcomes("lanes", values, mirrored, np.array([scale]))
    for name, value in one.items():
        np.testing.assert_array_equal(other[name], -value if name == "residual_rotation" else value, name)


@SETTINGS
@given(SEEDS, st.floats(0.5, 3.0))
def test_similarity(seed: int, stretch: float) -> None:
    """theta/alpha depends on omega/p, a/g, alpha and e only: p times ``stretch``, time over it."""
    rng = np.random.default_rng(seed)
    shaking = random_motion(rng, vertical=True)
    faster = Shaking(shaking.time_step / stretch, shaking.horizontal, shaking.vertical)
    alpha = float(rng.uniform(0.1, 0.4))
    scale = np.array([9.80665 * np.tan(alpha) * float(rng.uniform(1.1, 2.5))])
    one = outcomes("lanes", rectangle(alpha, 2.0), shaking, scale, tail=10.0)
    two = outcomes("lanes", rectangle(alpha, 2.0 * stretch), faster, scale, tail=10.0 / stretch)
    assume(not one["overturned"][0] and one["peak_rotation_ratio"][0] < 0.8)
    np.testing.assert_allclose(two["peak_rotation_ratio"], one["peak_rotation_ratio"], rtol=0, atol=1e-8)


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("vertical", [False, True])
def test_no_rocking_below_the_onset_and_rocking_above(integrator: str, vertical: bool) -> None:
    """|a| > G tan(alpha), with the vertical motion in G."""
    up = np.array([0.0, -2.0, 0.0]) if vertical else None
    shaking = Shaking(0.05, np.array([0.0, 1.0, 0.0]), up)
    gravity = 9.80665
    # where the apparent gravity falls with the motion: a s = (g - 2 s a) tan(alpha) at the peak
    tangent = np.tan(0.25)
    limit = gravity * tangent / (1 + 2 * tangent) if vertical else gravity * tangent
    found = outcomes(integrator, rectangle(0.25), shaking, limit * np.array([1 - 1e-9, 1 + 1e-9]), tail=1.0)
    assert found["status"].tolist() == [1, 2]
    assert np.isnan(found["onset_time"][0])
    assert found["onset_time"][1] == pytest.approx(0.05, abs=1e-8)
    assert found["uplift_duration"][0] == 0.0 == found["friction_demand"][0] == found["peak_rotation"][0]


def test_at_the_acceleration_of_onset_itself_every_block_rests() -> None:
    """|a| > G tan(alpha) is strict, whatever rounding makes of width/height and of a given in g."""
    ratios, heights = (x.ravel() for x in np.meshgrid(np.linspace(0.05, 1.0, 96), np.linspace(0.3, 3.0, 28)))
    blocks = {"aspect_ratio": ratios, "height": heights, "mass": 800.0}
    shaking = Shaking(0.05, np.array([0.0, 0.5, 1.0, 1.0, -1.0, 0.3, 0.0]))
    for factor, status in ((1.0, 1), (1.0 + 1e-12, 2)):
        found = MODEL.evaluate(blocks, shaking, factor * 9.80665 * ratios, outputs=["status", "onset_time"], tail=1.0)
        assert np.all(found["status"] == status)
        assert np.all(np.isnan(found["onset_time"]) == (status == 1))


@SETTINGS
@given(SEEDS, st.floats(0.05, 0.9))
def test_energy_between_impacts_and_at_impacts(seed: int, start: float) -> None:
    """Free rocking: energy is kept between impacts, and what is lost is what the impacts took."""
    values = random_block(np.random.default_rng(seed))
    block = MODEL.build(values)
    assume(block.momentum_restitution[0] > 0.05)
    alpha, theta = float(block.slenderness[0]), start * float(block.slenderness[0])
    p = float(block.frequency_parameter[0])
    silence = Shaking.silence(8.0 / p, 0.02 / p)
    run = by_reference(block, silence, initial={"rotation_1": theta})
    turning = 0.5 * float(block.pivot_inertia[0])
    weight = float(block.mass[0] * block.gravity[0] * block.radius[0])
    energy = turning * run.rate**2 + weight * (np.cos(alpha - np.abs(run.rotation)) - np.cos(alpha))
    assert np.all(np.diff(energy) <= 1e-9 * energy[0])
    impacts = np.array([event.time for event in run.events if event.kind == "impact"])
    between = np.searchsorted(impacts, run.time[:-1]) == np.searchsorted(impacts, run.time[1:])
    assert np.max(np.abs(np.diff(energy)[between])) <= 1e-8 * energy[0]
    assert energy[0] - energy[-1] == pytest.approx(run.outputs["dissipated_energy"], abs=1e-8 * energy[0])
