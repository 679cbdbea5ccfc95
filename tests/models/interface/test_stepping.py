"""Steps of a length that a caller chooses, in the place of the kernel's own rule."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

import models
from models.base import FloatArray
from models.errors import InputError
from models.model import Model
from models.runs import Prescribed
from models.shaking import Shaking
from tests.models.interface.carried import AHEAD, COUNT, MARKS, STEP, WALL
from tests.models.interface.walls import MODEL

OWN = MODEL.steps_a_sample(WALL, STEP)
SHAKING = Shaking(STEP, 1.5 * np.sin(15.0 * STEP * np.arange(COUNT)))


def run(model: Model) -> FloatArray:
    """Rotations (2, windows, samples) from a leaning state."""
    ran = model.trajectories(
        WALL, SHAKING, first=MARKS, samples=AHEAD, initial={"rotation_1": np.full(MARKS.size, 2e-3)}
    )
    return np.stack([ran["rotation_1"], ran["rotation_2"]])


def carried(model: Model) -> FloatArray:
    motion = {name: np.zeros((1, SHAKING.horizontal.size)) for name in ("rotation_1", "rotation_2")}
    return model.carry(WALL, SHAKING, Prescribed(motion, MARKS, np.zeros(1, np.int64)))["displacement_z_1"]


def test_the_length_of_the_own_rule_gives_what_the_own_rule_gives() -> None:
    assert OWN > 1
    chosen = MODEL.stepping(STEP / OWN)
    np.testing.assert_array_equal(run(chosen), run(MODEL))


def test_the_error_falls_with_the_square_of_the_step() -> None:
    coarse, fine = errors(run)
    assert 3.0 < coarse / fine < 5.5


def test_carried_states_come_nearer_too() -> None:
    """Less quickly: a motion that is prescribed at samples has kinks there."""
    coarse, fine = errors(carried)
    assert coarse / fine > 1.5


def errors(of: Callable[[Model], FloatArray]) -> tuple[float, float]:
    """Largest of the own rule's steps and of half as long ones."""
    exact = of(MODEL.stepping(STEP / (32 * OWN)))
    coarse, fine = (float(np.max(np.abs(of(MODEL.stepping(STEP / n)) - exact))) for n in (OWN, 2 * OWN))
    return coarse, fine


def test_the_model_itself_keeps_its_rule() -> None:
    assert MODEL.stepping(1e-4).step == 1e-4
    assert MODEL.step is None and MODEL.stepping(None) is MODEL
    assert MODEL.stepping(1e-4).stepping(None).step is None


def test_more_steps_where_the_layers_are_stiffer() -> None:
    """Three times as many for nine times the stiffness, to the next whole number."""
    stiffer = {**WALL, "base_stiffness": 9.0 * WALL["base_stiffness"], "top_stiffness": 9.0 * WALL["top_stiffness"]}
    assert 3 * (OWN - 1) < MODEL.steps_a_sample(stiffer, STEP) <= 3 * OWN


@pytest.mark.parametrize("name", ["interface_linear", "housner"])
def test_where_steps_are_not_chosen_a_length_is_refused(name: str) -> None:
    assert models.get(name).stepping(None) is models.get(name)
    with pytest.raises(InputError, match=f"the steps of model {name} are its own"):
        models.get(name).stepping(1e-4)


@pytest.mark.parametrize("step", [0.0, -1e-3, np.nan, np.inf])
def test_a_step_without_a_length_is_refused(step: float) -> None:
    with pytest.raises(InputError, match="give a positive length"):
        MODEL.stepping(step)
