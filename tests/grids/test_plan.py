"""What a plan file says is what the plan holds."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from grids.changes import compare, describe
from grids.motions import read_motion
from grids.motions.write import write_motion
from grids.plan import Plan, parse_plan, read_plan
from models.errors import InputError
from tests.grids.fakes import FakeWall

Write = Callable[[str, str], Path]

PULSE = "[motion]\npulse = { shape = 'half_sine', amplitude = '0.5 g', duration = '0.5 s' }\n"


def plan(axes: str = "", parameters: str = "width = 0.3\nheight = 1.8\nmass = 500", more: str = "") -> str:
    return f"[study]\nname = 'try'\nmodel = 'housner'\n{PULSE}[parameters]\n{parameters}\n[axes]\n{axes}\n{more}"


def read(text: str, folder: Path = Path()) -> Plan:
    return parse_plan(text, folder)


def test_a_whole_plan() -> None:
    found = read(
        plan(
            """
            aspect_ratio = { linspace = [0.1, 0.3, 5] }
            top_mass = { geomspace = [1, 4, 3], unit = "t" }
            pga = { values = [0.1, "2 m/s2"], unit = "g" }
            formulation = { values = ["linear", "nonlinear"] }
            restitution.factor_on_housner = { linspace = [0.8, 1.0, 3] }
            """,
            'height = "180 cm"\nmass = "0.5 t"\n"pivot_inset.inset_over_half_width" = "5 %"',
            "[run]\ntail = '20 s'\n[outputs]\nnames = ['overturned', 'status']",
        )
    )
    assert found.grid.dims == (
        "aspect_ratio",
        "top_mass",
        "pga",
        "formulation",
        "restitution.factor_on_housner",
    )
    assert found.grid.shape == (5, 3, 2, 2, 3)
    assert found.fixed == {"height": 1.8, "mass": 500.0, "pivot_inset.inset_over_half_width": 0.05}
    assert np.allclose(found.axes[1].values, [1000, 2000, 4000])
    assert np.allclose(found.axes[2].values, [0.980665, 2.0])
    assert (found.tail, found.outputs, found.integrator) == (20.0, ("overturned", "status"), "lanes")
    assert found.grid.apart == {"formulation"}


def test_outputs_that_need_histories_are_computed_only_where_they_are_named() -> None:
    assert "peak_velocity" not in read(plan()).outputs
    assert read(plan(more="[outputs]\nnames = ['peak_velocity']")).outputs == ("peak_velocity",)


def test_a_name_of_parameter_and_mechanism_is_told_apart_by_its_table() -> None:
    absolute = read(plan("restitution = { linspace = [0.5, 0.9, 5] }"))
    factor = read(plan("restitution.factor_on_housner = { linspace = [0.5, 0.9, 5] }"))
    quoted = read(plan('"restitution.factor_on_housner" = { linspace = [0.5, 0.9, 5] }'))
    assert absolute.grid.dims == ("restitution",)
    assert factor.grid.dims == quoted.grid.dims == ("restitution.factor_on_housner",)


def test_without_tables_the_defaults_hold() -> None:
    found = read(plan())
    assert found.grid.size == 1
    assert (found.tail, found.block_seconds) == (10.0, 5.0)
    assert "peak_rotation" in found.outputs


def test_a_point_shared_by_two_grids_is_one_number() -> None:
    coarse = read(plan("pga = { linspace = [0.05, 0.77, 37], unit = 'g' }")).axes[0].values
    fine = read(plan("pga = { linspace = [0.05, 0.77, 73], unit = 'g' }")).axes[0].values
    listed = [round(0.05 + 0.02 * i, 2) for i in range(37)]
    by_hand = read(plan(f"pga = {{ values = {listed}, unit = 'g' }}")).axes[0].values
    assert set(coarse) <= set(fine)
    assert np.array_equal(coarse, by_hand)


@pytest.mark.parametrize("kind", ["latin_hypercube", "sobol"])
def test_samples_fill_their_box(kind: str) -> None:
    axes = (
        f"s = {{ {kind} = 64, seed = 3, parameters = {{ mass = ['0.1 t', '1 t'], "
        "width = { range = [1, 100], unit = 'cm', spacing = 'log' } } }"
    )
    found = read(plan(axes, "height = 2"))
    mass, width = found.axes[0].sets["mass"], found.axes[0].sets["width"]
    # one point in each of 64 slices, for Latin hypercubes and for Sobol points alike
    assert np.array_equal(np.sort(((mass - 100) / 900 * 64).astype(int)), np.arange(64))
    assert np.array_equal(np.sort((np.log(width / 0.01) / np.log(100) * 64).astype(int)), np.arange(64))
    assert np.array_equal(read(plan(axes, "height = 2")).axes[0].sets["mass"], mass)


def test_doubling_a_sobol_sample_keeps_its_points() -> None:
    axes = "s = {{ sobol = {}, seed = 3, parameters = {{ mass = [100, 1000] }} }}"
    old, new = (read(plan(axes.format(n), "width = 0.3\nheight = 2")) for n in (32, 64))
    changes = compare(describe(old), describe(new))
    assert not changes.differences and changes.added
    reseeded = read(plan(axes.format(64).replace("seed = 3", "seed = 4"), "width = 0.3\nheight = 2"))
    assert compare(describe(old), describe(reseeded)).differences


def test_cases_inline_and_from_a_table(written: Write, tmp_path: Path) -> None:
    written("walls.csv", "label, width [cm], mass, formulation\nA, 30, 500, linear\nB, 25, 600, nonlinear\n")
    inline = (
        "case = { cases = [ { label = 'A', width = '30 cm', mass = 500, formulation = 'linear' }, "
        "{ label = 'B', width = 0.25, mass = '0.6 t', formulation = 'nonlinear' } ] }"
    )
    for axes in (inline, "case = { cases = 'walls.csv' }"):
        (axis,) = read(plan(axes, "height = 1.8"), tmp_path).axes
        assert list(axis.values) == ["A", "B"]
        assert np.allclose(axis.sets["width"], [0.3, 0.25]) and np.allclose(axis.sets["mass"], [500, 600])
        assert list(axis.sets["formulation"]) == ["linear", "nonlinear"]


def test_several_records_make_an_axis_and_cases_may_name_them() -> None:
    records = "['ridgecrest_2019_clc', 'ridgecrest_2019_ccc']"
    first = read(plan("pga = { values = [1, 2] }").replace(PULSE, f"[motion]\nfiles = {records}\n"))
    assert first.grid.dims == ("motion", "pga")
    placed = read(plan(f"pga = {{ values = [1, 2] }}\nmotion = {{ values = {records} }}").replace(PULSE, ""))
    assert placed.grid.dims == ("pga", "motion")
    for found in (first, placed):
        names = [motion.name for motion in found.motions]
        assert names == next(axis for axis in found.axes if axis.name == "motion").values.tolist()
        assert found.grid.apart == {"motion"}
    rows = "[{ motion = 'ridgecrest_2019_ccc', pga = '0.2 g' }, { motion = 'ridgecrest_2019_ccc', pga = 1 }]"
    cases = read(plan(f"case = {{ cases = {rows} }}").replace(PULSE, ""))
    assert [motion.name for motion in cases.motions] == [cases.axes[0].sets["motion"][0]]


def test_a_specimen_gives_the_fixed_values(written: Write) -> None:
    written(
        "wall.toml",
        "title = 'w'\nmodel = 'housner'\n[parameters]\nwidth = 0.3\nheight = 1.8\nmass = 500\n"
        "[options]\nformulation = 'linear'\n[mechanisms.pivot_inset]\ninset_over_half_width = 0.1\n"
        "[mechanisms.gain]\ngain = 0.05",
    )
    text = plan("aspect_ratio = { linspace = [0.1, 0.2, 3] }", "mass = '0.6 t'")
    path = written("p.toml", text.replace("model = 'housner'", "specimen = 'wall.toml'"))
    found = read_plan(path)
    assert found.fixed == {"height": 1.8, "mass": 600.0, "pivot_inset.inset_over_half_width": 0.1}
    assert found.options == {"formulation": "linear"}
    assert any("gain" in note for note in found.notes)


def test_a_null_outside_the_range_is_allowed(fake_wall: FakeWall) -> None:
    text = plan("slip.friction = { values = [0.2, inf] }", "width = .3\nheight = 1.8\nmass = 5\ncover = 0.0")
    text = text.replace(".3\n", "0.3\n").replace("'housner'", "'fake_wall'")
    assert read(text).axes[0].values.tolist() == [0.2, np.inf]


def test_adding_values_extends_and_anything_else_is_listed() -> None:
    def described(
        axes: str, parameters: str = "width = 0.3\nheight = 1.8\nmass = 500", more: str = ""
    ) -> dict[str, object]:
        return describe(read(plan(axes, parameters, more)))

    old = described("pga = { values = [1, 3] }")
    grown = compare(old, described("pga = { values = [1, 2, 3] }"))
    assert not grown.differences and "2.0 m s-2" in grown.added[0]
    assert not compare(old, described("pga = { values = [1, 3] }", more="[run]\nblock_seconds = 9")).differences
    for new, words in [
        (described("pga = { values = [1, 2] }"), ("axis pga lost", "3.0 m s-2")),
        (
            described("pga = { values = [1, 3] }", "width = 0.4\nheight = 1.8\nmass = 500"),
            ("width", "0.3", "0.4"),
        ),
        (described("motion_scale = { values = [1, 3] }"), ("axis pga is no longer there",)),
        (described("pga = { values = [1, 3] }", more="[run]\ntail = 5"), ("tail: 10 s before, 5 s now",)),
        (
            described("pga = { values = [1, 3] }", more="[outputs]\nnames = ['status']"),
            ("peak_rotation", "left out"),
        ),
        (described("pga = { values = [1, 3] }", more="[options]\nformulation = 'linear'"), ("formulation",)),
        (
            described("pga = { values = [1, 3] }\nmass = { values = [500] }", "width = 0.3\nheight = 1.8"),
            ("axis mass is new",),
        ),
        (describe(read(plan("pga = { values = [1, 3] }").replace("0.5 s", "0.6 s"))), ("motion",)),
    ]:
        changes = compare(old, new)
        assert changes.differences
        assert all(any(word in sentence for sentence in changes.differences) for word in words), changes


def test_one_motion_under_two_names_is_refused(tmp_path: Path) -> None:
    """Statistics over motions would count it twice."""
    made = read_motion("ridgecrest_2019_clc")
    for name in ("one", "other"):
        write_motion(replace(made, name=name), tmp_path / f"{name}.nc")
    with pytest.raises(InputError, match="are the same motion, sample for sample"):
        read(plan("pga = { values = [1, 2] }").replace(PULSE, '[motion]\nfiles = ["one.nc", "other.nc"]\n'), tmp_path)
