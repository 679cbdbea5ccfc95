"""The compiled lanes: against the reference on random buildings and laws, order, nulls, independence of lanes."""

import numpy as np
import pytest

from models.errors import InputError
from models.isolated.declaration import MOST_LEVELS
from models.isolated.lanes import run as lanes
from models.isolated.reference import run as reference
from models.shaking import Shaking
from tests.models.isolated.buildings import BODY, HOUSE, LAWS, MODEL, NULLS, chain, random_building, two_tones
from tests.models.requests import asked, outputs_of
from tests.models.strategies import random_motion

NAMES = [q.name for q in MODEL.outputs]


@pytest.mark.parametrize("seed", [1, 2, 3, 5, 12])
def test_lanes_agree_with_the_reference_on_random_buildings(seed: int) -> None:
    """Of one and of several levels, with one law and with several: seeds that share three kernels."""
    rng = np.random.default_rng(seed)
    values, shaking = random_building(rng), random_motion(rng, duration=4.0, vertical=False)
    slow = reference.run(chain(values), asked(shaking, 3.0, duration=4.0), 1e-8)
    expected = outputs_of(slow)
    peak = expected["peak_bearing_displacement"]
    for refinement, share in ((1, 2e-3), (4, 1.5e-4)):
        fast = lanes.run(chain(values), asked(shaking, 3.0, samples=401), refinement)
        assert np.max(np.abs(fast.samples - slow.samples)[0, :, :MOST_LEVELS]) < share * peak
        for name in ("peak_bearing_displacement", "residual_displacement"):
            assert fast.outputs[name][0] == pytest.approx(expected[name], abs=share * peak), name
        for name in ("peak_level_acceleration", "dissipated_energy", "peak_drift"):
            assert fast.outputs[name][0] == pytest.approx(expected[name], rel=10 * share), name
        assert fast.outputs["status"][0] == expected["status"] == 2


@pytest.mark.parametrize("name", LAWS)
def test_the_step_rule_is_of_second_order(name: str) -> None:
    one, shaking = chain({**BODY, **LAWS[name]}), two_tones()
    found = [lanes.run(one, asked(shaking, samples=301), n).samples[0, :, 0] for n in (1, 2, 4, 64)]
    errors = [np.max(np.abs(f - found[-1])) for f in found[:-1]]
    # kinks and jumps fall on other places of the steps each time, so the ratios scatter about four
    assert errors[0] / errors[2] > 9.0
    assert errors[0] < 1e-3 * np.max(np.abs(found[-1]))


def test_the_linear_chain_has_no_error_of_the_step() -> None:
    one, shaking = chain(HOUSE), two_tones()
    coarse, fine = (lanes.run(one, asked(shaking, samples=301), n).samples for n in (1, 8))
    np.testing.assert_allclose(coarse, fine, rtol=0, atol=1e-11 * np.max(np.abs(fine)))


@pytest.mark.parametrize("name", NULLS)
def test_at_its_null_a_mechanism_changes_nothing(name: str) -> None:
    shaking = two_tones()
    null, plain = MODEL.simulate({**BODY, **NULLS[name]}, shaking), MODEL.simulate(BODY, shaking)
    for channel, expected in plain.channels.items():
        size = np.max(np.abs(expected))
        np.testing.assert_allclose(null.channels[channel], expected, rtol=0, atol=1e-11 * size, err_msg=channel)
    key = next(k for k, law in LAWS.items() if any(x.startswith(f"{name}.") for x in law))
    other = MODEL.simulate({**BODY, **LAWS[key]}, shaking).channels["bearing_displacement"]
    expected = plain.channels["bearing_displacement"]
    assert np.max(np.abs(other - expected)) > 1e-3 * np.max(np.abs(expected))


def test_every_mechanism_is_covered_here() -> None:
    assert set(MODEL.mechanisms) == set(NULLS) == {name.partition(".")[0] for law in LAWS.values() for name in law}
    assert [p.name for p in MODEL.mechanisms["degradation"].parameters] == ["final_loss", "cycles"]
    assert [p.name for p in MODEL.mechanisms["payne"].parameters] == ["softening", "strain"]
    for mechanism in MODEL.mechanisms.values():
        assert "{" not in mechanism.sentence.format(**mechanism.nulls)


@pytest.mark.parametrize("laws", [{}, LAWS["payne"]])
def test_a_lane_does_not_depend_on_the_others(laws: dict[str, float]) -> None:
    rng = np.random.default_rng(5)
    buildings = [{k: v for k, v in random_building(rng).items() if "." not in k} | laws for _ in range(37)]
    values = {name: np.array([one[name] for one in buildings]) for name in buildings[0]}
    shaking, scale = random_motion(rng, duration=3.0, vertical=False), rng.uniform(1.0, 5.0, 37)
    together = MODEL.evaluate(values, shaking, scale, outputs=NAMES, tail=2.0)
    for k in (0, 15, 16, 36):
        alone = MODEL.evaluate(buildings[k], shaking, scale[k : k + 1], outputs=NAMES, tail=2.0)
        for name in NAMES:
            np.testing.assert_array_equal(alone[name][0], together[name][k], err_msg=name)


def test_rest_ends_a_run_and_changes_little() -> None:
    shaking = two_tones()
    values = {**HOUSE, "bearing_damping": 1e6}
    short, long = (lanes.run(chain(values), asked(shaking, tail=tail)) for tail in (60.0, 90.0))
    assert short.steps == long.steps
    ((rested,),) = short.events
    assert 3.0 < rested.time < 60.0
    slow = reference.run(chain(values), asked(shaking, tail=60.0), 1e-8)
    assert slow.events[0][0].kind == rested.kind == "rest"
    assert slow.events[0][0].time == pytest.approx(rested.time, abs=0.1)
    still = MODEL.evaluate(values, Shaking.silence(1.0, 0.01), np.ones(1), outputs=NAMES, tail=1.0)
    assert still["status"][0] == 1 and still["peak_level_acceleration"][0] == 0.0


def test_trajectories_start_at_their_own_samples() -> None:
    values, shaking = {**BODY, **LAWS["maxwell"], **LAWS["mullins"]}, two_tones()
    state = {"bearing_displacement": np.array([0.05, -0.02]), "bearing_velocity": np.array([0.1, 0.3])}
    found = MODEL.trajectories(values, shaking, first=np.array([0, 120]), samples=100, initial=state)
    cut = Shaking(shaking.time_step, shaking.horizontal[120:])
    alone = MODEL.simulate(values, cut, initial={k: float(v[1]) for k, v in state.items()}, duration=0.99)
    np.testing.assert_allclose(found["bearing_displacement"][1], alone.channels["bearing_displacement"], atol=1e-13)
    assert found["level_acceleration_x"].shape == (2, 1, 100)
    assert found["bearing_displacement"][0, 0] == 0.05
    slow = MODEL.simulate(values, cut, initial={"bearing_displacement": -0.02, "bearing_velocity": 0.3}, duration=0.99,
                          integrator="reference")  # fmt: skip
    np.testing.assert_allclose(
        slow.channels["bearing_displacement"], alone.channels["bearing_displacement"], atol=2e-4 * 0.05
    )


@pytest.mark.parametrize(
    ("law", "start"),
    [("payne", {"bearing_displacement": 0.08}), ("degradation", {"bearing_velocity": 0.5})],
)
def test_free_motion_from_a_state_agrees_with_the_reference(law: str, start: dict[str, float]) -> None:
    """Reversals and crossings count from the first one on, whatever the rate or the displacement is zero at first."""
    fast, slow = (
        MODEL.simulate({**BODY, **LAWS[law]}, Shaking.silence(4.0, 0.01), initial=start, integrator=integrator)
        for integrator in MODEL.integrators
    )
    wanted = slow.channels["bearing_displacement"]
    atol = 1e-3 * np.max(np.abs(wanted))
    np.testing.assert_allclose(fast.channels["bearing_displacement"], wanted, rtol=0.0, atol=atol)


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"levels": 2.5}, "levels is 2.5: give a whole number from 1 to 12"),
        ({"level_mass_2": 1e4}, "level_mass_2 and total_mass are both given"),
        ({"levels": 3.0}, "levels is 3 and storey_stiffness is missing"),
        ({"bouc_wen.post_yield_ratio": 0.5, "bouc_wen.exponent": 1.5}, "exponent is 1.5; give 1, 2, 3 or 4"),
    ],
)
def test_refusals(changes: dict[str, float], sentence: str) -> None:
    values = {**BODY, **changes}
    assert any(sentence in said for said in MODEL.check(values))
    with pytest.raises(InputError):
        MODEL.simulate(values, two_tones())


def test_laws_that_miss_something_are_refused() -> None:
    thin = {k: v for k, v in BODY.items() if k != "rubber_thickness"}
    with pytest.raises(InputError, match="payne is a law of the strain and needs rubber_thickness"):
        MODEL.simulate({**thin, **LAWS["payne"]}, two_tones())
    with pytest.raises(InputError, match="rubber law of the bearings is mullins; give its parameters"):
        MODEL.simulate(BODY, two_tones(), options={"rubber_law": "mullins"})
    masses = {k: v for k, v in HOUSE.items() if k != "total_mass"} | {"level_mass_1": 1e4}
    with pytest.raises(InputError, match="levels is 6 and level_mass_2 is missing"):
        MODEL.simulate(masses, two_tones())
    bare = {k: v for k, v in BODY.items() if k != "total_mass"} | {"levels": 3.0}
    (said,) = MODEL.check(bare)
    for name in ("level_mass_1", "storey_stiffness", "storey_damping"):
        assert f"levels is 3 and {name} is missing" in said
