"""The compiled lanes: against the reference on random walls, order of convergence, independence of lanes.

Rocking on rubber is sensitive too (a change of the motion by 1e-6 moves the peak by more than 1 % in one
of twelve walls of the study), so agreement is asked over a few seconds of motion.
"""

import numpy as np
import pytest

from models.interface import modes
from models.interface.lanes import run as lanes
from models.interface.observe import observe
from models.interface.reference import run as reference
from models.shaking import Shaking
from tests.models.interface.walls import MODEL, SHORT, block_on_strip, random_wall, stacked, undamped, wall
from tests.models.requests import asked
from tests.models.strategies import random_motion


def burst(rng: np.random.Generator) -> Shaking:
    """1.5 s of noise, both components."""
    return random_motion(rng, duration=1.5)


NAMED = ("peak_rotation_1", "peak_rotation_2", "uplift_duration_base", "onset_time", "friction_demand", "peak_strain")


@pytest.mark.parametrize(
    ("kinematics", "dashpot", "seed"), [("toe_held", "B", 1), ("toe_held", "A", 2), ("midpoint_held", "B", 3)]
)
def test_lanes_agree_with_the_reference_on_random_walls(kinematics: str, dashpot: str, seed: int) -> None:
    """Sixty-four walls with fine steps, of which the first that is calm and opens with the reference too."""
    rng = np.random.default_rng(seed)
    values, shaking = stacked([random_wall(rng) for _ in range(64)]), burst(rng)
    scale = 9.81 * values["aspect_ratio"] * rng.uniform(0.5, 1.2, 64)
    many = wall(values, kinematics=kinematics, dashpot=dashpot).replace(vertical_factor=1.0)
    own, fine, near = (
        lanes.run(many, asked(shaking, scale * more, samples=151), n)
        for n, more in ((1, 1.0), (8, 1.0), (8, 1.0 + 1e-5))
    )
    size = np.max(np.abs(fine.samples[:, :, :2]), axis=1)
    apart, error = (
        np.max(np.max(np.abs(run.samples - fine.samples)[:, :, :2], axis=1) / size, axis=1) for run in (near, own)
    )
    # a wall that amplifies a change of the motion by 1e-5 amplifies what the step leaves
    assert np.mean(error < 1e-2 + 100 * apart) > 0.85
    calm = apart < 1e-4
    assert np.median(error[calm]) < 2e-3
    k = int(np.flatnonzero(calm & (fine.outputs["minimum_contact_base"] < 0.7))[0])
    slow = reference.run(many.take([k]), asked(shaking, scale[k], duration=1.5), 1e-6)
    for ran, share in ((own, 1e-2), (fine, 1e-3)):
        assert np.max(np.abs(ran.samples[k] - slow.samples[0])[:, :2]) < share * np.max(size[k])
        outputs = {name: v[k] for name, v in ran.outputs.items()}
        for name in NAMED:
            assert outputs[name] == pytest.approx(slow.outputs[name], rel=share, abs=1e-4), name
        assert outputs["dissipated_energy"] == pytest.approx(slow.outputs["dissipated_energy"], rel=10 * share)


def test_events_and_peaks_are_told_alike_by_both_routes() -> None:
    time = 0.01 * np.arange(81)
    shaking = Shaking(0.01, 3.0 * np.sin(2 * np.pi * 2.5 * time))
    fast, slow = (MODEL.simulate(SHORT, shaking, integrator=name) for name in MODEL.integrators)
    assert [(e.kind, e.body) for e in fast.events] == [(e.kind, e.body) for e in slow.events]
    assert [e.kind for e in fast.events].count("onset") == 1
    np.testing.assert_allclose([e.time for e in fast.events], [e.time for e in slow.events], atol=2e-3)
    for history in (fast, slow):
        c = history.channels
        edge = np.max(c["compression_base"] + 0.36 * np.abs(np.sin(c["rotation_1"]))) / 0.01
        assert edge * (1 - 1e-12) <= history.outputs["peak_strain_base"] < 1.01 * edge
        assert history.outputs["peak_strain_base"] > history.outputs["peak_strain_top"] > 0.10970
        assert history.outputs["peak_strain"] == history.outputs["peak_strain_base"]


@pytest.mark.parametrize("joints", ["base", "top"])
def test_rubber_at_one_joint_only(joints: str) -> None:
    rng = np.random.default_rng(11)
    values, shaking = random_wall(rng), burst(rng)
    scale = 9.81 * values["aspect_ratio"]
    one = wall(values, joints=joints)
    slow = reference.run(one.replace(vertical_factor=1.0), asked(shaking, scale, duration=1.5), 1e-6)
    fast = MODEL.simulate(values, shaking, scale=scale, options={"joints": joints})
    expected = {k: v[0] for k, v in observe(one, slow.samples).items()}
    for name in ("rotation_1", "rotation_2", "compression_base", "compression_top"):
        np.testing.assert_allclose(
            fast.channels[name], expected[name], rtol=0, atol=4e-3 * np.max(np.abs(expected[name])) + 1e-15
        )
    bonded, other = ("top", "base") if joints == "base" else ("base", "top")
    assert fast.outputs[f"uplift_duration_{bonded}"] == 0.0
    assert fast.outputs[f"minimum_contact_{bonded}"] == 1.0
    assert np.isnan(fast.outputs[f"friction_demand_{bonded}"])
    assert np.isnan(fast.outputs[f"peak_strain_{bonded}"])
    assert fast.outputs[f"peak_strain_{other}"] == pytest.approx(slow.outputs[f"peak_strain_{other}"], rel=3e-3)
    assert fast.outputs[f"dissipated_energy_{other}"] > 0.0


def test_the_step_rule_is_of_second_order_in_full_contact() -> None:
    one = wall(SHORT)
    shaking = Shaking(0.01, 0.3 * np.sin(2 * np.pi * 1.2 * 0.01 * np.arange(101)))
    found = [lanes.run(one, asked(shaking, samples=101), n).samples[0, :, :2] for n in (1, 2, 4, 32)]
    errors = [np.max(np.abs(f - found[-1])) for f in found[:-1]]
    assert 3.0 < errors[0] / errors[1] < 6.0
    assert 3.0 < errors[1] / errors[2] < 6.0


def test_a_stiff_axial_mode_sets_no_bound_on_the_step() -> None:
    # E = 20 MPa and 10 %: an explicit fourth-order step would have to stay below .11 ms
    one = wall({**SHORT, "layer_modulus": 2e7, "damping_ratio": 0.10})
    shaking = Shaking(0.005, 1.9 * np.sin(2 * np.pi * 1.2 * 0.005 * np.arange(401)))
    step = 0.005 / int(lanes.substeps(one, modes.at_rest(one).squares, 0.005)[0])
    assert step > 5 * 0.11e-3
    coarse = lanes.run(one, asked(shaking, samples=401)).samples[0]
    fine = lanes.run(one, asked(shaking, samples=401), 16).samples[0]
    assert np.max(np.abs(coarse - fine)[:, :2]) < 2e-3 * np.max(np.abs(fine[:, :2]))


def test_energy_of_free_rocking_hardly_decays_without_dashpots() -> None:
    one = wall(undamped(block_on_strip(1e8)), joints="base")
    found = lanes.run(one, asked(Shaking.silence(2.0, 0.01), initial={"rotation_1": 0.1}), 4).outputs
    assert abs(found["dissipated_energy"][0]) < 2e-2 * 1000.0 * 9.81 * 0.02


def test_a_lane_does_not_depend_on_the_others() -> None:
    rng = np.random.default_rng(5)
    walls = [random_wall(rng) for _ in range(37)]
    values = stacked(walls)
    shaking, names = burst(rng), [q.name for q in MODEL.outputs]
    scale = rng.uniform(1.0, 9.0, 37)
    together = MODEL.evaluate(values, shaking, scale, outputs=names, tail=2.0)
    for k in (0, 15, 16, 36):
        alone = MODEL.evaluate(walls[k], shaking, scale[k : k + 1], outputs=names, tail=2.0)
        for name in names:
            np.testing.assert_array_equal(alone[name][0], together[name][k], err_msg=name)


def test_a_neighbour_that_overturns_changes_nothing() -> None:
    """Even when it falls in the very step in which this lane comes to a sample of the record."""
    time = 0.01 * np.arange(201)
    shaking = Shaking(0.01, np.sin(2 * np.pi * time / 1.5) + 0.2 * np.sin(2 * np.pi * 7.0 * time))
    one = wall(SHORT)
    scale = np.linspace(1.5, 3.5, 48)
    many = one.take(np.zeros(48, int))
    together = lanes.run(many, asked(shaking, scale, tail=4.0)).outputs
    fell = np.isfinite(together["overturning_time"])
    assert 8 < fell.sum() < 40
    for k in range(48):
        for name, value in lanes.run(one, asked(shaking, scale[k], tail=4.0)).outputs.items():
            np.testing.assert_array_equal(value[0], together[name][k], err_msg=name)


def test_an_overturned_wall_and_one_that_comes_to_rest() -> None:
    time = 0.01 * np.arange(301)
    shaking = Shaking(0.01, np.sin(2 * np.pi * time / 3.0))
    found = MODEL.evaluate(SHORT, shaking, np.array([9.0, 0.01]), outputs=[q.name for q in MODEL.outputs], tail=60.0)
    assert found["overturned"].tolist() == [True, False]
    assert found["peak_rotation"][0] == np.pi / 2
    assert 1.0 < found["overturning_time"][0] < 4.0
    assert found["uplift_duration_base"][0] < found["overturning_time"][0]
    assert found["status"].tolist() == [3, 1]
    assert np.isnan(found["onset_time"][1])
    history = MODEL.simulate(SHORT, shaking, scale=9.0, tail=2.0)
    assert abs(history.channels["rotation_1"][-1]) == np.pi / 2
    assert [e.kind for e in history.events][:2] == ["onset", "uplift"]


def test_at_rest_ends_the_run_early_and_changes_nothing() -> None:
    time = 0.01 * np.arange(101)
    shaking = Shaking(0.01, 1.5 * np.sin(2 * np.pi * time))
    one = wall(SHORT)
    short, long = (lanes.run(one, asked(shaking, tail=tail)) for tail in (60.0, 90.0))
    assert short.steps == long.steps
    assert lanes.run(one, asked(shaking, tail=60.0, samples=1)).steps > short.steps


def test_vertical_shaking_alone_turns_nothing() -> None:
    # rotations of the size of rounding must not upset the strips' quotients
    time = 0.01 * np.arange(101)
    shaking = Shaking(0.01, 1e-12 * np.sin(2 * np.pi * 3.0 * time), 4.0 * np.sin(2 * np.pi * 5.0 * time))
    one = wall(SHORT).replace(vertical_factor=1.0)
    fast = lanes.run(one, asked(shaking, samples=101), 4).samples[0].T
    slow = reference.run(one, asked(shaking, duration=1.0), 1e-7).samples[0].T
    assert np.max(np.abs(fast[:2])) < 1e-11
    assert np.max(np.abs(fast[2:4] - slow[2:4])) < 1e-3 * np.max(np.abs(slow[2:4]))
