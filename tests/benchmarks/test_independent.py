"""MuJoCo and OpenSeesPy against this program in small; the tables are those of ``make independent``."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks import opensees
from benchmarks.independent import mujoco_blocks, rigid, strips
from benchmarks.independent.table import Row

mujoco = pytest.mark.skipif(not mujoco_blocks.available(), reason="mujoco (extra 'proof') is not installed")
fibres = pytest.mark.skipif(not opensees.available(), reason="openseespy (extra 'proof') is not installed")


def worst(rows: list[Row], *words: str) -> float:
    """Largest relative difference in the rows that hold all the words."""
    found = [abs(row.difference) for row in rows if all(word in f"{row.what}, {row.setting}" for word in words)]
    assert found, words
    return max(found)


@mujoco
def test_mujoco_rocks_a_block_as_the_closed_form_and_closer_with_a_finer_step() -> None:
    rows = rigid.free_rocking((4e-4, 2e-4))
    assert worst(rows, "quarter", "0.2 ms") < 2e-4
    assert worst(rows, "quarter", "0.2 ms") < 0.6 * worst(rows, "quarter", "0.4 ms")
    assert worst(rows, "velocity", "0.2 ms") < 1e-3


@mujoco
def test_mujoco_loses_at_an_impact_what_housner_says() -> None:
    assert worst(rigid.impacts(((1e-3, 1.0),))) < 5e-4


@mujoco
def test_mujoco_starts_the_patterns_of_two_blocks() -> None:
    rows = rigid.patterns(step=1e-4)
    still = [row for row in rows if row.ours == 0.0]
    assert len(still) == 5
    assert all(row.theirs == 0.0 for row in still)
    # semi-implicit Euler is ahead by step/duration
    assert worst([row for row in rows if row.ours != 0.0]) < 1.1 * 1e-4 / 0.15


@fibres
def test_fibres_tend_to_the_exact_strip() -> None:
    rows = strips.uplift_curve((10, 20, 40))
    assert worst(rows, "20 section") < 3e-3
    assert worst(rows, "40 section") < 0.3 * worst(rows, "20 section")


@fibres
@pytest.mark.parametrize("joint", ["one layer", "two layers"])
def test_natural_frequencies_tend_to_those_of_the_exact_strips(joint: str) -> None:
    rows = strips.frequencies((20, 80), ("section",))
    assert worst(rows, joint, "frequency 1", "80") < 2e-4
    assert worst(rows, joint, "frequency 1", "80") < 0.15 * worst(rows, joint, "frequency 1", "20")
    assert worst(rows, joint) < 2e-3


@fibres
def test_a_wall_on_springs_swings_as_on_the_strip() -> None:
    rows = strips.free_rocking((("springs", 20, 2e-3), ("springs", 40, 2e-3)), (0.3,))
    assert worst(rows, "quarter", "40") < 6e-4
    assert worst(rows, "quarter", "40") < 0.4 * worst(rows, "quarter", "20")
    assert worst(rows, "peak") < 3e-4


@fibres
def test_histories_under_a_record_agree() -> None:
    rows = strips.shaken((("section", 80, 4),), (0.1,), seconds=5.0)
    assert worst(rows, "peak", "80 section") < 2e-3
    assert worst(rows, "rms", "80 section") < 4e-3
    assert worst(rows, "rms", "lanes") < 5e-4


def test_a_row_is_relative_to_ours_and_absolute_at_zero() -> None:
    assert Row("a", "1", "", 2.0, 3.0).difference == 0.5
    assert Row("a", "1", "", 0.0, 3e-3).difference == 3e-3
    assert np.isclose(Row("a", "1", "", -2.0, -1.0).difference, 0.5)
