"""Laws together: what softens multiplies, the stiffness stays positive, only a set under tension gives energy."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from models.isolated.lanes import run as lanes
from models.rubber import LAWS
from models.rubber.layer import Layer
from models.shaking import Shaking
from tests.models.isolated.buildings import BODY, chain
from tests.models.requests import asked
from tests.models.rubber.laws import alone, numbers

K = 6.21e7
PULLING = {"bouc_wen", "maxwell"}
"""Laws whose stress turns to tension under compression: a set that grows then gives energy."""


@st.composite
def layers(draw: st.DrawFn) -> Layer:
    """Two to all laws, their numbers anywhere in what a fit may reach (a lock strain that holds the paths here)."""
    names = draw(st.lists(st.sampled_from(list(LAWS)), min_size=2, max_size=len(LAWS), unique=True))
    given = []
    for name in (n for n in LAWS if n in names):
        own = {p.name: draw(st.floats(p.low, p.high)) for p in LAWS[name].mechanism.parameters}
        if name == "bouc_wen":
            own["exponent"] = draw(st.sampled_from([1.0, 2.0, 3.0, 4.0]))
        if name == "locking":
            own["lock_strain"] = draw(st.floats(1.0, 3.0))
        given.append((LAWS[name], numbers(name, **own)))
    return Layer(np.asarray(K), given)


@given(layers(), st.integers(0, 1000))
@settings(max_examples=6)
def test_a_combination_takes_energy_and_has_a_positive_stiffness(layer: Layer, seed: int) -> None:
    """Random paths in compression: over every step the work is at least the change of what is stored."""
    rng, count = np.random.default_rng(seed), 4000
    time = np.linspace(0.0, 1.0, count)
    u = 3e-3 + sum(rng.normal(0, 6e-4) * np.sin(2 * np.pi * rng.integers(1, 6) * time) for _ in range(4))
    u = np.clip(u, 0.0, 8e-3)[:, None]
    h = layer.relaxed(u[0])
    before, worst, most = None, 0.0, 0.0
    for old, new in pairwise(u):
        rates = layer.rates(0.5 * (old + new), (new - old) * count, h)
        h = layer.reached(new, [one + rate / count for one, rate in zip(h, rates, strict=True)])
        stress, energy = layer.stress(new, h), layer.energy(new, h)
        assert layer.slope(new, h) >= 0.0
        assert energy >= -1e-12 * K * 1e-4
        if before is not None:
            worst = min(worst, float(0.5 * (stress + before[0]) @ (new - old) - (energy - before[1]).item()))
        before, most = (stress, energy), max(most, float(energy.item()))
    names = {law.mechanism.name for law, _ in layer.laws}
    if "permanent_set" not in names or not names & PULLING:
        assert worst > -1e-4 * most


@pytest.mark.parametrize("softening", [0.3, 0.7])
def test_softening_is_a_share_of_what_the_others_carry(softening: float) -> None:
    """At every u of a first compression."""
    hard, both = alone("bouc_wen", "maxwell"), alone("bouc_wen", "maxwell", "mullins", softening=softening)
    u = np.linspace(0.0, 0.02, 50)
    share = 1.0 - softening * -np.expm1(-u / (0.3 * 0.01))
    np.testing.assert_allclose(both.stress(u, both.relaxed(u)), share * hard.stress(u, hard.relaxed(u)), rtol=1e-14)


def test_bearings_with_yielding_and_softening_do_not_run_away() -> None:
    """Random buildings of both laws, whose net stiffness would be negative if softening were taken off k."""
    rng = np.random.default_rng(1)
    values = {
        **BODY, "bouc_wen.post_yield_ratio": rng.uniform(0.1, 0.5, 64), "bouc_wen.yield_compression": 0.005,
        "mullins.softening": rng.uniform(0.5, 0.7, 64), "mullins.strain": rng.uniform(0.02, 0.3, 64),
    }  # fmt: skip
    time = 0.01 * np.arange(1001)
    shaking = Shaking(0.01, 4.0 * np.sin(2 * np.pi * 0.7 * time) * np.exp(-0.2 * time))
    found = lanes.run(chain(values), asked(shaking, np.ones(64))).outputs
    assert np.all(found["peak_bearing_displacement"] < 2.0)
    assert np.all(found["dissipated_energy"] > 0.0)
