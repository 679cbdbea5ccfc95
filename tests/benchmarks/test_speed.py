"""The speed benchmarks in small: what they time is what a study runs."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import numpy as np
import pytest

from benchmarks import speed
from benchmarks.two_blocks.__main__ import strongest, timed_lanes
from benchmarks.two_blocks.cases import cases
from grids.motions import read_motion
from grids.plan import read_plan
from models.rubber import LAWS


def test_every_model_and_law_has_a_case_and_a_plan_that_reads(tmp_path: Path) -> None:
    found = cases()
    names = [case.name for case in found]
    laws = [f"interface.{law}" for law in ("linear", *LAWS)]
    assert names == ["stacked", *laws, "interface_linear", "isolated"]
    for case in found:
        path = tmp_path / f"{case.name}.toml"
        path.write_text(f'[study]\nname = "{case.name}"\n{case.plan}')
        plan = read_plan(path)
        assert plan.model == case.model
        assert case.numbers.items() <= plan.fixed.items()


@pytest.mark.parametrize("name", ["interface.linear", "stacked"])
def test_steps_are_those_of_the_lanes_and_the_same_for_the_same_walls(name: str) -> None:
    case = next(case for case in cases() if case.name == name)
    window = strongest(read_motion("ridgecrest_2019_clc").shaking())
    timed = partial(timed_lanes, case, window, 0.0)
    first, again = timed(16), timed(16)
    assert first.steps == again.steps > 16 * (window.horizontal.size - 1) // 2
    assert first.processor > 0.0 and first.wall > 0.0


def test_growth_is_the_exponent() -> None:
    def timed(n: int) -> speed.Took:
        return speed.Took(0.0, 3e-3 * n**1.2, n)

    assert speed.growth(timed, (10, 20, 40)) == pytest.approx(1.2)
    assert speed.rate(timed, 32)[0] == pytest.approx(32 / (3e-3 * 32**1.2))
    assert speed.fitting(timed, 3e-3 * 64**1.2 * 5, 64) == 5 * 64


def test_the_strongest_part_holds_the_peak() -> None:
    shaking = read_motion("ridgecrest_2019_clc").shaking()
    part = strongest(shaking)
    assert part.pga == shaking.pga
    assert part.vertical is not None and np.shape(part.vertical) == np.shape(part.horizontal)
