"""Walls on layers that lock, where a step sized for the wall at rest throws an edge into the lock."""

from __future__ import annotations

import numpy as np
import pytest

from grids.motions import read_motion
from models.base import STATUS
from models.interface.lanes import run as lanes
from models.interface.layered import LayeredWall
from models.runs import Request
from tests.models.interface.walls import SHORT, wall


def stocky(lock: float, modulus: tuple[float, float], pga: tuple[float, float], end: float, n: int) -> tuple[
    LayeredWall, Request
]:  # fmt: skip
    """Random walls, lightly damped, from second 12 of the record to ``end``; moduli in Pa, PGA in g."""
    motion, rng = read_motion("ridgecrest_2019_clc"), np.random.default_rng(5)
    values = {
        **SHORT, "wall_length": rng.uniform(1.8, 2.2, n), "layer_modulus": rng.uniform(*modulus, n),
        "damping_ratio": 0.0167, "locking.lock_strain": lock,
    }  # fmt: skip
    many = wall(values)
    many = many.replace(vertical_factor=np.ones(n))
    return many, Request(motion.cut(12.0, end).shaking(), rng.uniform(*pga, n) * 9.81 / motion.pga, tail=1.0)


def test_a_wall_thrown_into_the_lock_is_taken_again_in_finer_steps() -> None:
    """Some of these stocky walls would overturn, or diverge, by the step alone; one far finer tells what they do."""
    many, request = stocky(0.7, (1e6, 1.3e6), (0.55, 0.8), 24.0, 512)
    thrown = np.flatnonzero(lanes.pressed(many, lanes._tables(many, request, 1)[0].result))
    assert thrown.size > 4
    some, asked = many.take(thrown), request.take(thrown)
    found, fine = (lanes.run(some, asked, refinement).outputs for refinement in (1, 16))
    assert not np.any(fine["overturned"])
    np.testing.assert_array_equal(found["status"], fine["status"])
    assert np.all(found["peak_strain_base"] < 1.1 * 0.7)
    # single peaks of walls that rock are sensitive to the step, as to everything else
    assert abs(np.median(found["peak_rotation"] / fine["peak_rotation"]) - 1.0) < 0.1


@pytest.mark.parametrize("lock", [0.2, 0.3])
def test_what_no_step_tells_of_a_wall_on_layers_that_lock_early_is_not_converged(lock: float) -> None:
    """Shaken so hard all overturn by the step alone; none does, nor is called so, and strains are those of fine steps.

    Layers are pressed beyond the lock strain in any step: on its tangent the law goes on.
    """
    many, request = stocky(lock, (1e6, 3e6), (0.8, 2.0), 20.0, 32)
    coarse = lanes._tables(many, request, 1)[0].result
    assert np.mean(lanes.outputs(many, coarse)["overturned"]) > 0.9
    run = lanes.run(many, request)
    rocks = run.outputs["status"] == STATUS.index("rocking")
    assert np.all(rocks | (run.outputs["status"] == STATUS.index("not_converged")))
    assert 0 < np.sum(~rocks) < 16
    fine = lanes.outputs(many, lanes._tables(many, request, 64)[0].result)
    assert not np.any(fine["overturned"])
    beyond = rocks & (fine["peak_strain"] > 1.15 * lock)
    assert beyond.sum() > 8
    apart = np.abs(run.outputs["peak_strain"] - fine["peak_strain"])[beyond] / lock
    assert np.median(apart) < 0.15
