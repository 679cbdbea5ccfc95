"""Every mechanism that acts on a wall between layers through its `Effects`: null, reference, rest, and physics."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest

from models.errors import InputError
from models.interface import resting
from models.interface.lanes import run as lanes
from models.interface.model import MODEL
from models.interface.reference import run as reference
from models.rubber import LAWS
from models.runs import Prescribed
from models.shaking import Shaking
from models.tables import KNOTS, SIDES, row
from tests.models.interface.walls import LONG, SHORT, undamped, wall
from tests.models.requests import asked

G = 9.81
TYPICAL = {
    "tilt": {"tilt": 0.01},
    "eccentricity": {"offset_top": 0.05},
    "contact_length": {"frozen": 0.5},
    "added_stiffness": {"couple_stiffness": 3e5, "gap": 0.004},
    "one_sided_stiffness": {"right_over_left": 1.4},
    "table_pitch": {"pitch_per_acceleration": 0.002, "low_pass_hz": 8.0},
    "viscous_damping": {"couple_damping": 2e4},
    "coulomb_damping": {"over_m_g_b": 0.05},
    "degradation": {"final_loss": 0.7, "cycles": 2.0},
    "interface_shear": {"shear_over_normal": 0.5},
    "bonded_layer": {"tearing_strain": 0.05},
    "wall_flexibility": {"flexural_stiffness_ratio": 5.0},
    "sliding": {"friction": 0.06},
    "table_force": {"reach_rotation_base": 0.01, "reach_rate_base": 0.1, "reach_rotation_top": 0.01}
    | {"reach_rate_top": 0.1, "reach_displacement": 0.03, "reach_velocity": 0.2, "reach_base": 4.0}
    | {
        row(term, side, knot): size * np.sin(2.0 * knot + len(term) + (side == "above")) * (knot > 0)
        for term, size in (
            ("rotation_base", 0.1), ("rate_base", 0.05), ("damping_base", 0.5), ("friction_base", 0.03),
            ("rotation_top", 0.05), ("rate_top", 0.05), ("damping_top", 0.5), ("friction_top", 0.03),
            ("displacement_block", 0.03), ("velocity_block", 0.03), ("push_block", 0.03),
        )
        for side in SIDES
        for knot in range(KNOTS)
    },
}  # fmt: skip
TIME = 0.02 * np.arange(31)
SHAKING = Shaking(0.02, 3.0 * np.sin(2 * np.pi * 2.0 * TIME))


def dotted(name: str, values: dict[str, float]) -> dict[str, float]:
    return {f"{name}.{parameter}": value for parameter, value in values.items()}


def typical(*names: str) -> dict[str, float]:
    return {key: value for name in names for key, value in dotted(name, TYPICAL[name]).items()}


def rotations(values: dict[str, float], shaking: Shaking = SHAKING, **more) -> np.ndarray:
    return lanes.run(wall({**SHORT, **values}), asked(shaking, samples=shaking.horizontal.size, **more)).samples[
        0, :, 0
    ]


def test_every_effect_of_the_catalogue_is_tested() -> None:
    assert set(MODEL.mechanisms) == {*TYPICAL, *LAWS, "vertical_acceleration", "pivot_inset"}


@pytest.mark.parametrize("name", TYPICAL)
def test_null_equals_base(name: str) -> None:
    base = lanes.run(wall(SHORT), asked(SHAKING, samples=31))
    ran = lanes.run(wall({**SHORT, **dotted(name, MODEL.mechanisms[name].nulls)}), asked(SHAKING, samples=31))
    size = np.max(np.abs(base.samples[0]), axis=0)
    np.testing.assert_array_less(np.max(np.abs(ran.samples[0, :, :8] - base.samples[0]), axis=0), 1e-11 * size)
    for output, expected in base.outputs.items():
        np.testing.assert_allclose(ran.outputs[output], expected, rtol=1e-9, err_msg=output)
    changed = rotations(typical(name))
    assert np.max(np.abs(changed - base.samples[0, :, 0])) > 3e-4 * size[0]


LATE = {"degradation": ({"degradation.final_loss": 0.9, "degradation.cycles": 0.2}, 3.5 * np.sin(8.0 * np.pi * TIME))}
"""What acts from the first closings on: size and a base motion under which it moves the wall within .6 s."""


@pytest.mark.parametrize("name", TYPICAL)
def test_kernel_equals_reference(name: str) -> None:
    values, motion = LATE.get(name, (typical(name), SHAKING.horizontal))
    one, shaking, duration = wall({**SHORT, **values}), Shaking(0.02, motion), 0.6 if name in LATE else 0.2
    slow = reference.run(one, asked(shaking, duration=duration), 1e-5)
    plain = lanes.run(wall(SHORT), asked(shaking, duration=duration), 8).samples[0][:, :2]
    acts = np.max(np.abs(slow.samples[0][:, :2] - plain), axis=0) / np.max(np.abs(plain), axis=0)
    assert acts.max() > 5e-3  # else nothing is compared
    for refinement, share in ((1, 3e-2), (8, 3e-3)):
        fast = lanes.run(one, asked(shaking, duration=duration), refinement)
        size = np.maximum(np.max(np.abs(slow.samples[0]), axis=0), 1e-9)
        apart = np.max(np.abs(fast.samples[0] - slow.samples[0]), axis=0) / size
        assert np.all(apart[:2] < share), apart
    outputs = ["peak_rotation_1", "peak_rotation_2", "minimum_contact_base"]
    if name not in LATE:  # closings leave a joint all but unloaded for an instant: a peak as high as steps are fine
        outputs.append("friction_demand")
    for output in outputs:
        assert fast.outputs[output][0] == pytest.approx(slow.outputs[output][0], rel=1e-2), output
    assert fast.outputs["dissipated_energy"][0] == pytest.approx(slow.outputs["dissipated_energy"][0], rel=3e-2)


@pytest.mark.parametrize("name", TYPICAL)
def test_a_wall_that_leans_stays_where_it_rests(name: str) -> None:
    values = {**SHORT, **typical("tilt", name)}
    run = lanes.run(wall(values), asked(Shaking.silence(0.3, 0.01), samples=31))
    places, still = run.samples[0], resting.at_rest(wall(values))[0]
    assert abs(still[0]) > 1e-4
    np.testing.assert_allclose(places[-1, :4], still[:4], rtol=0, atol=1e-9)
    assert run.outputs["status"][0] == 1 or "tilt" not in values


@pytest.mark.parametrize("name", TYPICAL)
def test_the_response_is_smooth_in_the_parameter(name: str) -> None:
    """Differences over steps of 1 and 3 per cent agree: no jump and no kink at a typical value."""
    first = MODEL.mechanisms[name].parameters[0].name

    def slope(step: float) -> np.ndarray:
        values = {**SHORT, **typical(name)}
        key = f"{name}.{first}"
        many = {**values, key: values[key] * np.array([1.0 - step, 1.0 + step])}
        both = lanes.run(wall(many), asked(SHAKING, np.ones(2), samples=31)).samples[:, :, 0]
        return (both[1] - both[0]) / (2.0 * step)

    small, large = slope(0.01), slope(0.03)
    assert np.max(np.abs(small - large)) < 0.1 * np.max(np.abs(small)) + 1e-9


@pytest.mark.parametrize(
    ("name", "one", "other"),
    [("eccentricity", 0.05, -0.05), ("one_sided_stiffness", 1.5, 1 / 1.5), ("tilt", 0.01, -0.01)],
)
def test_left_and_right_are_mirror_images(name: str, one: float, other: float) -> None:
    key = f"{name}.{MODEL.mechanisms[name].parameters[0].name}"
    mirrored = Shaking(0.02, -SHAKING.horizontal)
    first, second = rotations({key: one}), rotations({key: other}, mirrored)
    np.testing.assert_allclose(first, -second, rtol=0, atol=1e-10)
    assert np.max(np.abs(first - rotations({}))) > 1e-4


def test_couples_lose_the_energy_that_their_laws_say() -> None:
    """On an undamped layer: c times the integral of theta'^2, and the dry couple times the way."""
    free = Shaking.silence(1.0, 0.002)
    for name, law in (("viscous_damping", lambda c, w: c * w**2), ("coulomb_damping", lambda c, w: c * np.abs(w))):
        one = wall({**undamped(SHORT), **typical(name)})
        run = lanes.run(one, asked(free, samples=501, initial={"rotation_1": 2e-3, "rotation_2": 2e-3}), 2)
        size = one.effects.couple_damping[0] if name == "viscous_damping" else one.effects.dry_couple[0]
        lost = np.trapezoid(law(size, run.samples[0, :, 4]), dx=0.002)
        assert run.outputs["dissipated_energy"][0] == pytest.approx(lost, rel=2e-2)
        assert lost > 1.0


def test_a_dry_couple_holds_the_wall_up_to_its_size() -> None:
    weak, strong = (wall({**SHORT, "coulomb_damping.over_m_g_b": size}) for size in (0.02, 0.1))
    push = Shaking(0.01, np.full(101, -0.04 * G))
    moved = [np.max(np.abs(lanes.run(one, asked(push, samples=101)).samples[0, :, 0])) for one in (weak, strong)]
    plain = np.max(np.abs(lanes.run(wall(SHORT), asked(push, samples=101)).samples[0, :, 0]))
    assert moved[1] < 0.8 * moved[0] < 0.8 * plain


@pytest.mark.parametrize(
    ("values", "start", "push"),
    [
        ({"coulomb_damping.over_m_g_b": 0.01}, {"rotation_1": 0.01, "rotation_2": 0.01}, 0.0),
        ({"sliding.friction": 0.02}, {}, -2.0 * G),
    ],
)
def test_what_friction_cannot_hold_moves_from_the_start(
    values: dict[str, float], start: dict[str, float], push: float
) -> None:
    """A turned wall, and a base that is pushed from the first sample on."""
    shaking = Shaking(0.005, np.full(11, push))
    request = asked(shaking, duration=0.05, initial=start)
    slow = reference.run(wall({**SHORT, **values}), request, 1e-6).samples[0]
    fast = lanes.run(wall({**SHORT, **values}), request, 4).samples[0]
    for k, name in ((0, "rotation"), (8, "slip")):
        moved = np.ptp(slow[:, k])
        np.testing.assert_allclose(fast[:, k], slow[:, k], rtol=0.0, atol=1e-2 * moved + 1e-9, err_msg=name)
    assert np.ptp(slow[:, 8 if push else 0]) > 1e-4


def test_a_frozen_contact_is_that_of_the_published_equations() -> None:
    """Of `interface_linear` at small rotations, where the geometry hardly bends."""
    import models

    time = 0.01 * np.arange(101)
    shaking = Shaking(0.01, 1.6 * np.sin(2 * np.pi * 1.2 * time))
    linear = models.get("interface_linear").simulate(SHORT, shaking)
    options = {"kinematics": "midpoint_held", "dashpot": "A"}
    frozen, exact = (
        MODEL.simulate({**SHORT, "contact_length.frozen": share}, shaking, options=options) for share in (1.0, 0.0)
    )
    size = np.max(np.abs(linear.channels["rotation_1"]))
    assert linear.outputs["minimum_contact_base"] == 0.5
    apart = [np.max(np.abs(h.channels["rotation_1"] - linear.channels["rotation_1"])) for h in (frozen, exact)]
    assert apart[0] < 0.3 * apart[1] and apart[1] > 0.05 * size


def test_a_layer_that_does_not_tear_makes_the_wall_linear() -> None:
    values = {"bonded_layer.tearing_strain": 0.3}
    one, two = rotations(values, scale=0.15), rotations(values, scale=0.3)
    assert np.max(np.abs(two - 2.0 * one)) < 0.01 * np.max(np.abs(two))
    plain = rotations({}, scale=0.15), rotations({}, scale=0.3)
    assert np.max(np.abs(plain[1] - 2.0 * plain[0])) > 0.05 * np.max(np.abs(two))


def test_closings_wear_the_base_and_the_memory_can_be_handed_on() -> None:
    """A worn wall is one with a softer base layer, with as much of its dashpot."""
    loss, n, cycles = 0.4, 6.0, 3.0
    worn = 1.0 - loss * (1.0 - np.exp(-n / cycles))
    gentle = Shaking(0.01, 0.5 * np.sin(2 * np.pi * 2.0 * 0.01 * np.arange(61)))
    soft = wall(SHORT)
    soft = soft.replace(base_stiffness=worn * soft.base_stiffness)
    rest = dict(
        zip(
            ("rotation_1", "rotation_2", "displacement_z_1", "displacement_z_2"), resting.at_rest(soft)[0], strict=False
        )
    )
    tired = wall({**SHORT, "degradation.final_loss": loss, "degradation.cycles": cycles})
    found = lanes.run(tired, asked(gentle, samples=61, initial={**rest, "closings": n})).samples[0, :, 0]
    expected = lanes.run(soft, asked(gentle, samples=61)).samples[0, :, 0]
    np.testing.assert_allclose(found, expected, rtol=0, atol=2e-3 * np.max(np.abs(expected)))


def test_slip_at_rest_is_the_load_over_the_stiffness_along_the_joint() -> None:
    tilt, ratio = 0.01, 0.4
    one = wall({**LONG, "tilt.tilt": tilt, "interface_shear.shear_over_normal": ratio})
    still = resting.at_rest(one)[0]
    load = one.mass[0] * G * np.sin(tilt)
    assert still[4] == pytest.approx(load / (ratio * 2.0 * one.base_half_width[0] * one.base_stiffness[0]), rel=1e-6)
    assert 0.0 < still[5] < still[4]


def test_a_stiff_joint_along_is_the_plain_wall_however_stiff() -> None:
    plain = rotations({})
    apart = [
        np.max(np.abs(rotations({"interface_shear.shear_over_normal": ratio}) - plain)) for ratio in (20.0, 1e3, 1e6)
    ]
    assert apart[1] < 0.2 * apart[0] and apart[2] < 0.01 * apart[0] < 0.01 * np.max(np.abs(plain))


def test_a_stiff_wall_is_the_plain_wall_however_stiff() -> None:
    plain, key = rotations({}), "wall_flexibility.flexural_stiffness_ratio"
    apart = [np.max(np.abs(rotations({key: ratio}) - plain)) for ratio in (10.0, 100.0, 1e5)]
    assert apart[1] < 0.3 * apart[0] and apart[2] < 0.01 * apart[0]


def test_a_long_wall_slides_as_a_particle_does() -> None:
    """Constant acceleration a for T, then none: slip a' T^2/2 + (a' T)^2/(2 mu g), a' = a - mu g."""
    mu, a, duration = 0.1, 2.0, 0.4
    values = {**LONG, "wall_length": 6.0, "top_length": 6.0, "layer_modulus": 5e7, "sliding.friction": mu}
    run = lanes.run(wall(values), asked(Shaking(0.01, np.full(41, a)), duration=2.0, tail=2.0))
    surplus = a - mu * G
    slip = surplus * duration**2 / 2 + (surplus * duration) ** 2 / (2 * mu * G)
    assert run.samples[0, -1, 8] == pytest.approx(-slip, rel=1e-2)
    assert abs(run.samples[0, -1, 12]) < 1e-12
    assert run.outputs["friction_demand_base"][0] <= mu * 1.05


def test_friction_over_the_demand_changes_nothing() -> None:
    demand = lanes.run(wall(SHORT), asked(SHAKING, samples=31)).outputs["friction_demand_base"][0]
    np.testing.assert_allclose(rotations({"sliding.friction": 1.5 * demand}), rotations({}), rtol=0, atol=1e-9)


@pytest.mark.slow
def test_slips_and_closings_are_carried_along_the_rotations() -> None:
    """By the kernel that carries what no sensor holds, from rest, against the run that made the rotations."""
    values = {**SHORT, **typical("interface_shear", "degradation")}
    shaking = Shaking(0.005, np.interp(0.005 * np.arange(121), TIME, SHAKING.horizontal))
    run = lanes.run(wall(values), asked(shaking, samples=121))
    states = run.samples[0].T
    motion = {name: states[k][None] for k, name in ((0, "rotation_1"), (1, "rotation_2"))}
    motion |= {name: states[k][None] for k, name in ((4, "rotation_rate_1"), (5, "rotation_rate_2"))}
    marks = np.array([40, 80, 119])
    found = MODEL.carry(values, shaking, Prescribed(motion, marks, np.zeros(1, np.int64)))
    for name, column in (("displacement_x_1", 8), ("displacement_x_2", 9), ("displacement_z_1", 2)):
        size = np.max(np.abs(states[column]))
        np.testing.assert_allclose(found[name][0], states[column][marks], rtol=0, atol=0.02 * size, err_msg=name)
    assert found["closings"][0, -1] == run.outputs["impacts_base"][0] > 0


def test_sliding_and_shear_of_the_base_do_not_act_together() -> None:
    (sentence,) = MODEL.check({**SHORT, **typical("sliding", "interface_shear")})
    assert "sliding" in sentence and "interface_shear" in sentence
    top_only = {"interface_shear.shear_over_normal_top": 0.5}
    assert not MODEL.check({**SHORT, **typical("sliding"), **top_only})
    with pytest.raises(InputError, match="sliding"):
        MODEL.simulate({**SHORT, **typical("sliding", "interface_shear")}, SHAKING)


def test_a_wall_that_leans_too_far_cannot_stand() -> None:
    (sentence,) = MODEL.check({**SHORT, "tilt.tilt": 0.5})
    assert "tips it over" in sentence


def test_a_lane_with_effects_does_not_depend_on_the_others() -> None:
    size = np.linspace(0.3, 1.7, 19)
    many = {
        key: value * size for key, value in typical("one_sided_stiffness", "coulomb_damping", "interface_shear").items()
    }
    values, names = {**SHORT, **many}, ["peak_rotation_1", "dissipated_energy", "friction_demand", "status"]
    together = MODEL.evaluate(values, SHAKING, 0.5 + size, outputs=names, tail=1.0)
    for k in (0, 15, 18):
        alone = {key: value[k] if np.ndim(value) else value for key, value in values.items()}
        found = MODEL.evaluate(alone, SHAKING, 0.5 + size[k : k + 1], outputs=names, tail=1.0)
        for name in names:
            np.testing.assert_array_equal(found[name][0], together[name][k], err_msg=name)


@pytest.mark.parametrize(("integrator", "ratio", "duration"), [("lanes", 1e4, 0.15), ("reference", 1e3, 0.06)])
def test_a_bending_wall_that_is_turned_starts_straight(integrator: str, ratio: float, duration: float) -> None:
    """Nearly stiff, it rocks as the plain wall from the same state; a kink at the start would ring."""
    start, quiet = {"rotation_1": 0.01, "rotation_2": 0.01}, Shaking.silence(duration, 0.005)
    run = partial(MODEL.simulate, shaking=quiet, initial=start, integrator=integrator)
    plain = run(SHORT).channels["rotation_1"]
    bending = run({**SHORT, "wall_flexibility.flexural_stiffness_ratio": ratio}).channels["rotation_1"]
    np.testing.assert_allclose(bending, plain, atol=0.02 * float(np.max(np.abs(plain))))


def test_a_couple_that_takes_more_than_the_layers_give_tips_the_wall() -> None:
    tipping = MODEL.build({**SHORT, "added_stiffness.couple_stiffness": -1e9}, size=1)
    assert MODEL.refused(tipping)


def test_a_frozen_contact_goes_with_linear_rubber_only() -> None:
    with pytest.raises(InputError, match="contact_length mixes"):
        MODEL.build({**SHORT, **typical("contact_length"), "hardening.beta2": 20.0})


def test_effects_of_the_base_need_rubber_there() -> None:
    with pytest.raises(InputError, match="sliding acts on the rubber of the base"):
        MODEL.build({**SHORT, "sliding.friction": 0.1}, {"joints": "top"})
