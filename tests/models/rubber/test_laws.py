"""The rubber laws: closed forms, rest, dissipation, and lanes against the reference."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from models.errors import InputError
from models.interface import modes
from models.interface.fibres import Fibres
from models.interface.lanes import run as lanes
from models.interface.reference import run as reference
from models.interface.strip import strip
from models.rubber import LAWS
from models.shaking import Shaking
from tests.models.interface.walls import MODEL, SHORT, wall
from tests.models.requests import asked
from tests.models.rubber.laws import GIVEN, alone, laden, numbers
from tests.models.strategies import random_motion

NULLS = {
    "hardening": {"hardening.beta2": 0.0},
    "maxwell": {"maxwell.arm_stiffness_ratio": 0.0},
    "bouc_wen": {"bouc_wen.post_yield_ratio": 1.0},
    "locking": {"locking.lock_strain": np.inf},
    "mullins": {"mullins.softening": 0.0},
    "permanent_set": {"permanent_set.rate": 0.0},
}
SHAKING = Shaking(0.01, 3.0 * np.sin(2 * np.pi * 2.5 * 0.01 * np.arange(41)))


@pytest.mark.parametrize("name", LAWS)
def test_lanes_agree_with_the_reference(name: str) -> None:
    one = wall({**SHORT, **GIVEN[name]})
    slow = reference.run(one, asked(SHAKING, duration=0.25), 1e-5).samples[0].T
    for refinement, share in ((1, 2e-3), (4, 5e-4)):
        fast = lanes.run(one, asked(SHAKING, samples=26), refinement).samples[0].T
        error = np.max(np.abs(fast - slow)[:4], axis=1) / np.max(np.abs(slow)[:4], axis=1)
        assert np.max(error) < share


@pytest.mark.parametrize("name", LAWS)
def test_a_shaken_random_wall_and_its_values_agree_with_the_reference(name: str) -> None:
    rng = np.random.default_rng([11, list(LAWS).index(name)])
    one = wall({k: float(v[0]) for k, v in laden(name, rng, 1).items()}).replace(vertical_factor=0.0)
    hard = float(np.tan(one.slenderness[0])) * 9.81 / SHAKING.pga
    slow = reference.run(one, asked(SHAKING, hard, duration=0.3), 1e-5)
    assert slow.outputs["minimum_contact"][0] < 1.0  # it opens
    slow, fast = slow.samples[0].T, lanes.run(one, asked(SHAKING, hard, samples=31), 4).samples[0].T
    error = np.max(np.abs(fast - slow)[:4], axis=1) / np.max(np.abs(slow)[:4], axis=1)
    assert np.max(error) < 1e-3


@pytest.mark.parametrize("name", LAWS)
def test_steps_hardly_matter_to_random_walls_and_values(name: str) -> None:
    """Sixteen shaken walls against eight times finer steps."""
    rng = np.random.default_rng([7, list(LAWS).index(name)])
    values, shaking = laden(name, rng, 16), random_motion(rng, duration=0.8)
    many = wall(values)
    scale = 9.81 * values["aspect_ratio"] * rng.uniform(0.5, 1.2, 16)
    coarse, fine, near = (
        lanes.run(many, asked(shaking, scale * more, samples=81), n).samples[:, :, :4]
        for n, more in ((1, 1.0), (8, 1.0), (8, 1.0 + 1e-5))
    )
    size = np.max(np.abs(fine), axis=1)
    assert np.sum(size[:, 0] > 1e-3) > 4  # they open
    apart, error = (np.max(np.max(np.abs(run - fine), axis=1) / size, axis=1) for run in (near, coarse))
    # a wall that amplifies a change of the motion by 1e-5 amplifies what the step leaves
    assert np.mean(error < 1e-2 + 100 * apart) > 0.85
    calm = apart < 1e-4
    assert np.median(error[calm]) < 2e-3
    assert np.sum(calm & (size[:, 0] > 1e-3)) > 1


@pytest.mark.parametrize("name", LAWS)
def test_at_its_null_a_law_is_the_linear_one(name: str) -> None:
    plain = MODEL.simulate(SHORT, SHAKING).channels
    with_law = MODEL.simulate({**SHORT, **NULLS[name]}, SHAKING).channels
    for channel, expected in plain.items():
        size = np.max(np.abs(expected))
        np.testing.assert_allclose(with_law[channel], expected, rtol=0, atol=1e-9 * size, err_msg=channel)


@pytest.mark.parametrize("name", LAWS)
def test_relaxed_walls_stay_at_rest_and_carry_their_weight(name: str) -> None:
    one = wall({**SHORT, **GIVEN[name]})
    rest = modes.static_state(one)[0]
    state = lanes.run(one, asked(Shaking.silence(1.0, 0.01), samples=101)).samples[0]
    assert np.max(np.abs(state - state[0])) < 1e-12
    layer, u = one.layer("base"), np.array([-rest[2]])
    carried = layer.stress(u, layer.relaxed(u))
    assert carried[0] * one.base_half_width[0] * 2.0 == pytest.approx(float(one.mass[0] * 9.81), rel=1e-12)


@pytest.mark.parametrize("name", LAWS)
def test_closed_cycles_never_give_energy_back(name: str) -> None:
    layer = alone(name)
    rng = np.random.default_rng(2)
    count = 4000
    time = np.linspace(0.0, 1.0, count, endpoint=False)
    lines, ways = 2 * np.pi * rng.integers(1, 6, (3, 3)), rng.uniform(-1, 1, (3, 3))
    way = sum(w * np.sin(f * time[:, None]) for w, f in zip(ways, lines, strict=True))
    u = np.tile(3e-3 + 5e-4 * way, (4, 1))
    u_rate = np.gradient(u, 1.0 / count, axis=0)
    h, stress = layer.relaxed(u[0]), np.empty(u.shape)
    for k in range(len(u)):
        stress[k] = layer.stress(u[k], h)
        rates = layer.rates(u[k], u_rate[k], h)
        h = layer.reached(u[k], [one + rate / count for one, rate in zip(h, rates, strict=True)])
    # the fourth cycle: the hidden state has closed its loop by then, apart from the creep of a set
    last = slice(3 * count - 1, None)
    work = np.sum(0.5 * (stress[last][1:] + stress[last][:-1]) * np.diff(u[last], axis=0), axis=0)
    assert np.all(work > -2e-4 * 6.21e7 * 1e-6)


def test_bouc_wen_follows_its_closed_forms_for_exponents_one_and_two() -> None:
    law = LAWS["bouc_wen"]
    for n, virgin in ((1.0, lambda x: 1 - np.exp(-x)), (2.0, np.tanh)):
        p = numbers("bouc_wen", exponent=n)
        limit = float(p["yield_compression"])
        u = np.linspace(0.0, 4 * limit, 9)
        np.testing.assert_allclose(law.relaxed(u, p), limit * virgin(u / limit), rtol=1e-12)
        found = solve_ivp(
            lambda t, h, p=p: law.rate(np.full(1, t), np.ones(1), h, p),
            (0, u[-1]),
            [0.0],
            t_eval=u,
            rtol=1e-9,
            atol=1e-14,
        )
        np.testing.assert_allclose(found.y[0], limit * virgin(u / limit), rtol=1e-6)
    # an exponent without a closed form lies between its neighbours
    three, two, four = (law.relaxed(u, numbers("bouc_wen", exponent=n)) for n in (3.0, 2.0, 4.0))
    assert np.all((two[1:] < three[1:]) & (three[1:] < four[1:]))


def test_sixteen_fibres_of_the_difference_against_ten_thousand_of_the_whole_law() -> None:
    one = wall({**SHORT, **GIVEN["hardening"], "damping_ratio": 0.0})
    b, k = float(one.base_half_width[0]), float(one.base_stiffness[0])
    x = (np.arange(10_000) + 0.5) / 10_000 * 2 * b - b
    for z, angle in ((-1.1e-3, 2e-3), (1e-3, 0.02), (8e-3, 0.04)):
        u = np.maximum(x * np.sin(angle) - z, 0.0)
        stress = k * u * (1 + 20.0 * (u / 0.01) ** 2)
        exact = stress.sum() * 2 * b / 10_000
        more = Fibres(one, "base").difference((z, angle, 0.0, 0.0), [np.zeros(1)]).force.item()
        assert strip(b, k, 0.0, z, np.sin(angle)).force + more == pytest.approx(exact, rel=3e-3)


def test_other_laws_at_each_joint() -> None:
    values = {**SHORT, **GIVEN["mullins"], **GIVEN["maxwell"]}
    both = {"base_rubber_law": "mullins", "top_rubber_law": "maxwell"}
    one = wall(values, **both)
    assert [law.name for law, _ in one.laws_at("base")] == ["mullins"]
    assert [law.name for law, _ in one.laws_at("top")] == ["maxwell"]
    slow = reference.run(one, asked(SHAKING, duration=0.3), 1e-5).samples[0].T
    fast = lanes.run(one, asked(SHAKING, samples=31), 2).samples[0].T
    assert np.max(np.abs(fast[:4] - slow[:4])) < 1e-3 * np.max(np.abs(slow[:2]))
    base_only = wall({**SHORT, "mullins.softening": 0.0, "mullins.softening_base": 0.3})
    assert base_only.laws["mullins.softening_base"][0] == 0.3
    assert base_only.laws["mullins.softening_top"][0] == 0.0


def test_refusals() -> None:
    with pytest.raises(InputError, match=r"rubber law of the base layer is mullins; give mullins.softening"):
        wall(SHORT, rubber_law="mullins")
    with pytest.raises(InputError, match=r"exponent is 1.5; give 1, 2, 3 or 4"):
        wall({**SHORT, "bouc_wen.post_yield_ratio": 0.5, "bouc_wen.exponent": 1.5})
