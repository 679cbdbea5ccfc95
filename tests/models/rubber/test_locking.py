"""Walls on layers that lock, where a step sized for the wall at rest throws an edge into the lock."""

from __future__ import annotations

import numpy as np

from grids.motions import read_motion
from models.interface.lanes import run as lanes
from models.runs import Request
from tests.models.interface.walls import SHORT, wall

LOCK = 0.7


def test_a_wall_thrown_into_the_lock_is_taken_again_in_finer_steps() -> None:
    """Some of these stocky walls would overturn, or diverge, by the step alone; one far finer tells what they do."""
    motion, n = read_motion("ridgecrest_2019_clc"), 512
    rng = np.random.default_rng(5)
    values = {
        **SHORT, "wall_length": rng.uniform(1.8, 2.2, n), "layer_modulus": rng.uniform(1e6, 1.3e6, n),
        "damping_ratio": 0.0167, "locking.lock_strain": LOCK,
    }  # fmt: skip
    many = wall(values)
    many = many.replace(vertical_factor=np.ones(n))
    request = Request(motion.cut(12.0, 24.0).shaking(), rng.uniform(0.55, 0.8, n) * 9.81 / motion.pga, tail=1.0)
    thrown = np.flatnonzero(lanes.pressed(many, lanes._pitched(many, request, 1)[0].result))
    assert thrown.size > 4
    some, asked = many.take(thrown), request.take(thrown)
    found, fine = (lanes.run(some, asked, refinement).outputs for refinement in (1, 16))
    assert not np.any(fine["overturned"])
    np.testing.assert_array_equal(found["status"], fine["status"])
    assert np.all(found["peak_strain_base"] < 1.1 * LOCK)
    # single peaks of walls that rock are sensitive to the step, as to everything else
    assert abs(np.median(found["peak_rotation"] / fine["peak_rotation"]) - 1.0) < 0.1
