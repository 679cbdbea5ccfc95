"""Walls that cannot stand under their own weight, and runs that diverge: flags beside the others' answers."""

import numpy as np
import pytest

from models.base import STATUS
from models.errors import InputError
from models.interface import resting
from models.interface.lanes import rows as r
from models.interface.lanes import run as lanes
from models.interface.lanes.sense import diverged
from models.interface.layered import LayeredWall
from models.lanes.sense import impulse
from models.shaking import Shaking
from tests.models.interface.walls import MODEL, SHORT, wall
from tests.models.requests import asked

SHAKING = Shaking(0.01, 3.0 * np.sin(2 * np.pi * 2.5 * 0.01 * np.arange(61)))
NAMES = [quantity.name for quantity in MODEL.outputs]
UNABLE = {
    "tips": ({"top_length": 0.05}, "too soft to hold the wall upright"),
    "crushed": ({"base_layer_modulus": 4e5}, "base layer is compressed by 12.7 mm, more than its thickness of 10 mm"),
    "creeps": (
        {"permanent_set.rate": 1.0, "permanent_set.strain_limit": 0.05}, r"strain_limit is 0.05.*strain at rest, 0.113"
    ),
    "yields": (
        {"bouc_wen.post_yield_ratio": 0.0, "bouc_wen.yield_compression": 1e-4, "bouc_wen.exponent": 1.0},
        "base layer cannot carry its load at rest",
    ),
}  # fmt: skip
ABLE = {"permanent_set.strain_limit": 0.5, "bouc_wen.post_yield_ratio": 0.5, "bouc_wen.yield_compression": 2e-3}


@pytest.mark.parametrize("why", UNABLE)
def test_alone_it_is_refused_with_a_sentence(why: str) -> None:
    changes, sentence = UNABLE[why]
    values = {**SHORT, **changes}
    with pytest.raises(InputError, match=sentence):
        MODEL.simulate(values, SHAKING)
    assert MODEL.check(values)
    assert MODEL.check(SHORT) == []


def test_among_others_it_is_a_flag() -> None:
    """Every second wall: not_converged and without numbers; the others as if they ran alone."""
    widths, moduli = np.array([2.0, 0.05, 2.0, 2.0]), np.array([4.5e6, 4.5e6, 5e6, 4e5])
    values = {**SHORT, "top_length": widths, "base_layer_modulus": moduli, "top_layer_modulus": 4.5e6}
    assert MODEL.check(values) == []
    found = MODEL.evaluate(values, SHAKING, np.ones(4), outputs=NAMES, tail=1.0)
    assert found["status"].tolist() == [2, 5, 2, 5]
    kept = {**values, "top_length": widths[[0, 2]], "base_layer_modulus": moduli[[0, 2]]}
    alone = MODEL.evaluate(kept, SHAKING, np.ones(2), outputs=NAMES, tail=1.0)
    for name, value in found.items():
        np.testing.assert_array_equal(value[[0, 2]], alone[name], err_msg=name)
        if name != "status":
            assert np.all(np.isnan(value[[1, 3]]) if value.dtype.kind == "f" else value[[1, 3]] == -1), name
    traced = MODEL.trajectories(values, SHAKING, first=np.zeros(4, int), samples=20, initial={})
    assert np.isnan(traced["rotation_1"]).all(axis=1).tolist() == [False, True, False, True]


@pytest.mark.parametrize("why", ["creeps", "yields"])
def test_a_law_that_cannot_hold_one_wall_leaves_the_other(why: str) -> None:
    changes = {name: np.array([ABLE.get(name, value), value]) for name, value in UNABLE[why][0].items()}
    mixed = {**SHORT, **changes}
    assert MODEL.check(mixed) == []
    assert np.isnan(MODEL.derive(mixed)["frequency_1"]).tolist() == [False, why == "yields"]
    unable = np.any([lanes for lanes, _ in MODEL.cannot_stand(MODEL.build(mixed))], axis=0)
    assert unable.tolist() == [False, True]


def test_what_diverges_has_no_answer() -> None:
    """Results as no wall can have them, made from those of a wall that rocks."""
    one, request = wall(SHORT), asked(SHAKING, np.ones(5))
    many = one.take(np.zeros(5, int))
    table = np.zeros((5, r.N_RESULT))
    table[:, [r.R_OVER_1, r.R_OVER_2]] = np.nan
    table[:, [r.R_EDGE_B, r.R_EDGE_T]] = 0.01
    reach = float(one.mass[0]) * (0.5 * impulse(request)[0] ** 2 + 9.81)
    table[1, r.R_END_Z1], table[2, r.R_EDGE_T], table[3, r.R_LOST_B], table[4, r.R_END_2] = 1e3, np.inf, -reach, 0.1
    assert diverged(many, request, table).tolist() == [False, True, True, True, False]
    table[3, r.R_OVER_2] = 1.0
    assert not diverged(many, request, table)[3]
    assert STATUS[int(lanes.outputs(many, np.where(np.arange(r.N_RESULT) == r.R_FAILED, 1.0, table))["status"][0])] == (
        "not_converged"
    )


def test_where_equal_walls_stand_is_found_once() -> None:
    """Of lanes that follow one another alike, and of a later call with the same walls; for each what it is alone."""
    slopes = [0.001, 0.002, 0.004]
    many = {**SHORT, "tilt.tilt": np.repeat(slopes, 5)}
    found: list[int] = []

    def counted(one: LayeredWall) -> np.ndarray:
        found.append(one.size)
        return resting.at_rest(one)

    first, again = MODEL.build(many), MODEL.build(many)
    np.testing.assert_array_equal(first.once(counted), again.once(counted))
    assert found == [3]
    alone = [resting.at_rest(MODEL.build({**SHORT, "tilt.tilt": slope}))[0] for slope in slopes]
    np.testing.assert_array_equal(first.once(counted), np.repeat(alone, 5, axis=0))
    assert MODEL.build({**SHORT, "tilt.tilt": np.array([0.001, 0.002, 0.001])}).distinct[0].size == 3
