"""What is still in a recording: a wall on rubber only while its base is, a block while nothing starts a motion."""

from __future__ import annotations

import numpy as np
import pytest

import models
from diagnosis.errors.components import Component
from diagnosis.errors.likelihood import Piece
from diagnosis.errors.pieces import opened
from diagnosis.errors.stills import LONGEST_STILL, stills
from diagnosis.fit.setup import base_fit, measure
from diagnosis.fit.solver import fit
from grids.recordings.base import Recording
from models.shaking import Shaking
from tests.diagnosis.made import SPECIMEN, TIME_STEP, motion, recording
from tests.diagnosis.walls import TRUE, WALL, misfit

REST, SWAYS = 1.5, 3.0


def recorded(rest: float) -> Recording:
    """A wall that the table first moves slowly, so that it sways by some times the noise of its sensors."""
    strong, lead = motion(1, pga=3.0).horizontal, np.zeros(round(rest / TIME_STEP))
    slow = 0.15 * np.sin(2.0 * np.pi * 0.6 * TIME_STEP * np.arange(round(SWAYS / TIME_STEP)))
    base = Shaking(TIME_STEP, np.concatenate([lead, slow, strong]))
    ran, rng = models.get("interface").simulate(TRUE, base, duration=base.duration), np.random.default_rng(8)
    channels = {"base_acceleration_x": base.horizontal + 0.002 * rng.normal(size=base.horizontal.size)}
    for name in ("rotation_1", "rotation_2"):
        true = np.asarray(ran.channels[name])
        channels[name] = true + 0.01 * np.max(np.abs(true)) * rng.normal(size=true.size)
    return Recording("run", TIME_STEP, base.time, channels)


def quiet(rest: float) -> list[Piece]:
    measured = measure(WALL, [recorded(rest)])
    one = misfit(measured)
    found = fit(one, np.array([x.coordinate(TRUE[x.name]) for x in one.unknowns]), measured.states, 1)
    nothing = np.zeros((*measured.values.shape, 0))
    return stills(opened(found, nothing, nothing, nothing), [Component("white", 0)])


def correlation(values: np.ndarray) -> float:
    """Of a series with itself one sample later."""
    return float(np.corrcoef(values[1:], values[:-1])[0, 1])


def test_what_a_wall_on_rubber_sways_by_before_it_moves_beyond_the_noise_is_no_noise() -> None:
    swaying = recorded(0.0)
    for piece, channel in zip(quiet(0.0), ("rotation_1", "rotation_2"), strict=True):
        assert piece.time.max() > 0.8 * SWAYS
        assert abs(correlation(piece.residual)) < 0.2 and piece.residual.std() == pytest.approx(np.sqrt(0.5), rel=0.1)
        means = swaying.channels[channel][: 2 * piece.residual.size].reshape(-1, 2).mean(axis=1)
        assert correlation(means) > 0.7


def test_rest_before_it_is_part_of_it_but_no_more_than_is_needed() -> None:
    found = quiet(REST)
    assert len(found) == 2
    for piece in found:
        assert piece.time.max() > REST + 0.8 * SWAYS and piece.residual.size <= LONGEST_STILL


@pytest.mark.parametrize(("seed", "rests"), [(1, True), (13, False)])
def test_a_block_that_rocks_by_little_is_not_still(seed: int, rests: bool) -> None:
    """Under the second motion it lifts within a second and hardly rests after that: its stillest second is motion."""
    measured = measure(SPECIMEN, [recording("run", seed)])
    nothing = np.zeros((*measured.values.shape, 0))
    found = stills(opened(base_fit(SPECIMEN, measured), nothing, nothing, nothing), [Component("white", 0)])
    assert len(found) == rests and all(piece.residual.std() < 1.2 for piece in found)


def test_rest_after_noise_became_louder_is_weighed_by_its_level() -> None:
    """A block that is still at the end alone, four times as loud from the middle on: the noise there is of one unit."""
    moving, rest = recording("run", 13, noise=0.0), round(3.0 / TIME_STEP)
    rotation = moving.channels["rotation_1"] * np.linspace(1.0, 0.0, moving.time.size)
    rotation = np.concatenate([rotation, np.zeros(rest)])
    level = 2e-4 * np.where(np.arange(rotation.size) < rotation.size // 2, 1.0, 4.0)
    channels = {
        "base_acceleration_x": np.concatenate([moving.channels["base_acceleration_x"], np.zeros(rest)]),
        "rotation_1": rotation + level * np.random.default_rng(3).normal(size=rotation.size),
    }
    made = Recording("run", moving.time_step, TIME_STEP * np.arange(rotation.size), channels)
    measured = measure(SPECIMEN, [made])
    nothing = np.zeros((*measured.values.shape, 0))
    found = stills(opened(base_fit(SPECIMEN, measured), nothing, nothing, nothing), [Component("white", 0)])
    late = [piece for piece in found if piece.time.min() > 0.5 * made.time[-1]]
    assert late
    for piece in late:
        assert np.std(piece.residual) * np.sqrt(measured.strides[0]) == pytest.approx(1.0, rel=0.25)
