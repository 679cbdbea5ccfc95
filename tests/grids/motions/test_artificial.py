"""Artificial motions: the code's spectrum, how near they come to it, where they end, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest

from grids.motions import find, read_motion
from grids.motions.artificial import TOLERANCE, target_of
from grids.motions.eurocode8 import GROUNDS, ElasticSpectrum
from grids.motions.intensity import velocity_and_displacement
from grids.motions.matching import MATCHED
from grids.motions.spectrum import response_spectrum
from grids.plan import parse_plan
from models.errors import InputError

G = 9.80665
TABLE = {"spectrum": "EC8", "type": 1, "ground": "B", "pga": "0.2 g", "seed": 1}


def motion(**changes):
    return read_motion({"artificial": {**TABLE, **changes}})


@pytest.mark.parametrize(("kind", "ground"), [(kind, ground) for kind in GROUNDS for ground in GROUNDS[kind]])
def test_branches_of_the_spectrum_meet_and_have_the_slopes_of_the_code(kind, ground):
    spectrum = ElasticSpectrum(kind, ground, 1.0)
    at = GROUNDS[kind][ground]
    corners = np.array([at.rise_end, at.plateau_end, at.velocity_end])
    np.testing.assert_allclose(spectrum(corners * (1 - 1e-9)), spectrum(corners * (1 + 1e-9)), rtol=1e-8)
    assert spectrum(np.array([0.0]))[0] == 1.0
    np.testing.assert_allclose(spectrum(corners[:2]), 2.5)
    fall = np.array([at.plateau_end, at.velocity_end])
    np.testing.assert_allclose(spectrum(fall) * fall, 2.5 * at.plateau_end)  # constant velocity
    far = np.array([at.velocity_end, 4.0])
    np.testing.assert_allclose(spectrum(far) * far**2, 2.5 * at.plateau_end * at.velocity_end)  # displacement


def test_damping_correction_of_the_code():
    """eta = 1 at 5 %, sqrt(10/15) at 10 %, and never below .55 (reached at 28 %)."""
    eta = [ElasticSpectrum(1, "A", 1.0, damping).damping_correction for damping in (0.05, 0.10, 0.28, 0.4)]
    np.testing.assert_allclose(eta, [1.0, np.sqrt(2 / 3), 0.55, 0.55], rtol=1e-3)


@pytest.mark.parametrize(
    ("kind", "ground", "seed"),
    [(1, "A", 2), (1, "B", 3), (1, "C", 4), (1, "D", 5), (2, "A", 6), (2, "C", 7), (2, "D", 8), (2, "E", 9)],
)
def test_every_motion_reaches_the_spectrum(kind, ground, seed):
    """Within 10 % at every period of the range, on a grid finer than, and other than, the one it was made on."""
    made = motion(type=kind, ground=ground, seed=seed)
    periods = np.geomspace(*MATCHED, 211)
    reached = response_spectrum(made.horizontal, made.time_step, periods).pseudo_acceleration
    wanted = ElasticSpectrum(kind, ground, 0.2 * G)(periods)
    assert np.max(np.abs(reached / wanted - 1.0)) < TOLERANCE
    assert made.pga == pytest.approx(0.2 * G, rel=1e-12)


@pytest.mark.parametrize("changes", [{"step": "10 ms"}, {"duration": "14 s"}, {"damping": "3 %"}, {"damping": 0.15}])
def test_other_steps_durations_and_dampings(changes):
    made = motion(**changes)
    target = target_of(made)
    periods = np.geomspace(*MATCHED, 101)
    reached = response_spectrum(made.horizontal, made.time_step, periods, target.damping).pseudo_acceleration
    assert np.max(np.abs(reached / target(periods) - 1.0)) < TOLERANCE


def test_the_ground_stops_where_it_started():
    made = motion()
    velocity, displacement = velocity_and_displacement(made.horizontal, made.time_step, None)
    assert made.horizontal[0] == made.horizontal[-1] == 0.0
    assert abs(velocity[-1]) < 1e-6 * np.max(np.abs(velocity))
    assert abs(displacement[-1]) < 1e-4 * np.max(np.abs(displacement))


def test_strong_motion_lasts_half_of_the_duration():
    """Of the 20 s, 10 s are stationary: the power of their first and second half is alike."""
    power = np.mean([motion(seed=seed).horizontal ** 2 for seed in (1, 2, 3)], axis=0)
    first, second = power[600:1600].mean(), power[1600:2600].mean()
    assert 0.6 < first / second < 1.7
    assert power[-200:].mean() < 0.02 * power[600:2600].mean()


def test_one_seed_is_one_motion_bit_for_bit():
    from grids.motions import artificial

    first = motion()
    artificial._shape.cache_clear()
    again = motion()
    assert first.fingerprint == again.fingerprint
    assert motion(seed=2).fingerprint != first.fingerprint
    # another PGA or ground with the same corner periods: the same shape
    np.testing.assert_allclose(motion(pga="0.4 g", ground="E").horizontal, 2 * first.horizontal, rtol=1e-12)


def test_several_seeds_are_several_motions_of_a_plan():
    text = """
[study]
name = "x"
model = "housner"
[motion]
artificial = { spectrum = "EC8", type = 1, ground = "B", pga = "0.2 g", seed = [1, 2] }
[parameters]
height = "2 m"
width = "0.4 m"
mass = 1000
"""
    plan = parse_plan(text, None)
    assert [axis.name for axis in plan.axes] == ["motion"]
    assert [m.fingerprint for m in plan.motions] == [motion(seed=seed).fingerprint for seed in (1, 2)]
    with pytest.raises(InputError, match=r"\[motion\] pulse and \[motion\] artificial both name motions"):
        parse_plan(text.replace("[param", 'pulse = { shape = "sine" }\n[param'), None)


def test_the_same_words_are_a_source_of_their_own():
    text = 'artificial = { spectrum = "EC8", type = 1, ground = "B", pga = "0.2 g", seed = [1, 2] }'
    assert [read_motion(source).fingerprint for source in find(text)] == [
        motion(seed=seed).fingerprint for seed in (1, 2)
    ]
    pulse = read_motion('pulse = { shape = "sine", amplitude = 1.0, frequency = "2 Hz" }')
    assert pulse.pga == pytest.approx(1.0)
    with pytest.raises(InputError, match="not valid TOML"):
        read_motion("artificial = { spectrum = EC8 }")


def test_the_target_follows_the_scale_and_ends_with_other_changes():
    made = motion()
    assert target_of(made.scaled(2.0)).pga == pytest.approx(2 * made.pga)
    assert target_of(made.time_scaled(2.0)) is None and target_of(made.cut(0.0, 10.0)) is None


@pytest.mark.parametrize(
    ("changes", "facts"),
    [
        ({"spectrum": "EC9"}, ("spectrum", "EC9", "EC8")),
        ({"type": 3}, ("type is 3", "1", "2")),
        ({"ground": "F"}, ("ground", "'F'", "A, B, C, D, E")),
        ({"ground": "S1"}, ("'S1'", "study of their own")),
        ({"grund": "B"}, ("grund", "did you mean 'ground'?")),
        ({"pga": "-0.2 g"}, ("pga", "-0.2 g", "positive")),
        ({"pga": "0.2 m"}, ("pga", "0.2 m")),
        ({"damping": "50 %"}, ("damping", "50 %", "0.03 to 0.3")),
        ({"duration": "5 s"}, ("duration", "5 s", "12 to 60 s")),
        ({"step": "20 ms"}, ("step", "20 ms", "0.002 to 0.01 s")),
        ({"step": "7 ms"}, ("step 0.007 s", "divide", "20 s")),
        ({"seed": -1}, ("seed is -1", "whole number")),
        ({"seed": [1, 2]}, ("seed is [1, 2]", "one whole number")),
        ({"seed": 1.5}, ("seed", "1.5")),
    ],
)
def test_bad_tables_are_one_sentence(changes, facts):
    with pytest.raises(InputError) as caught:
        motion(**changes)
    sentence = str(caught.value)
    assert all(fact in sentence for fact in facts), sentence
    assert "\n" not in sentence and len(sentence) < 250


@pytest.mark.parametrize(("seeds", "facts"), [([], "empty"), ([1, 2, 1], "seed 1 is given twice")])
def test_bad_lists_of_seeds(seeds, facts):
    with pytest.raises(InputError, match=facts):
        find({"artificial": {**TABLE, "seed": seeds}})


@pytest.mark.parametrize(
    ("options", "facts"), [({"component": "north"}, "no component"), ({"vertical": True}, "no ver")]
)
def test_there_is_one_component(options, facts):
    with pytest.raises(InputError, match=facts):
        read_motion({"artificial": TABLE}, **options)
