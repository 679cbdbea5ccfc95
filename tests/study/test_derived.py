"""Auxiliary coordinates: right at every cell whatever the axes are, and over no axis too many."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import models
import study.derived
from grids.plan import Plan, parse_plan
from study.derived import derived_coordinates
from study.labels import Coordinate
from study.open import open_study
from study.run import run

HEAD = """
[study]
name = "derived"
model = "{model}"
[motion]
pulse = {{ shape = "sine", amplitude = "0.3 g", frequency = "1.5 Hz" }}
[parameters]
{parameters}
[axes]
{axes}
[run]
tail = "1 s"
"""
BLOCK = 'height = "1.8 m"\nmass = 500'
WALL = "wall_thickness = 0.138\nwall_density = 900\ntop_length = 2\ntop_height = 0.6"
RUBBER = """layer_thickness = "10 mm"
damping_ratio = 0.05
hardening.beta2 = 20
maxwell = { arm_stiffness_ratio = 0.5, relaxation_time = 0.1 }
bouc_wen = { post_yield_ratio = 0.4, yield_compression = 0.002 }
permanent_set = { rate = 0.5, strain_limit = 1.5 }"""
BUILDING = (
    "total_mass = 3e5\nstorey_stiffness = 3e8\nstorey_damping = 1e6\nbearing_damping = 1e5\nrubber_thickness = 0.1"
)
SCALES = ("pga = { values = [1, 2] }", "time_scale = { values = [0.5, 1.0, 2.0] }")


def made(model: str, parameters: str, *axes: str) -> Plan:
    return parse_plan(HEAD.format(model=model, parameters=parameters, axes="\n".join(axes)), Path.cwd())


def values(name: str, low: float, high: float) -> st.SearchStrategy[str]:
    """Up to five numbers in any order."""
    chosen = st.lists(st.sampled_from(np.linspace(low, high, 5).tolist()), min_size=1, max_size=5, unique=True)
    return chosen.map(lambda found: f"{name} = {{ values = {found} }}")


def words(name: str, *known: str) -> st.SearchStrategy[str]:
    chosen = st.lists(st.sampled_from(known), min_size=1, unique=True)
    return chosen.map(lambda found: f"{name} = {{ values = {found} }}")


def cases(name: str, low: float, high: float) -> st.SearchStrategy[str]:
    """Cases that set one number to one of two values, so that any few of them may be alike."""
    chosen = st.lists(st.sampled_from([low, high]), min_size=4, max_size=7)
    rows = chosen.map(lambda found: ", ".join(f"{{ {name} = {v} }}" for v in found))
    return rows.map(lambda found: f"case_of_{name} = {{ cases = [{found}] }}")


AXES = {
    ("housner", BLOCK): (
        values("width", 0.2, 0.6) | cases("width", 0.2, 0.6),
        values("top_mass", 0, 1000),
        values('"pivot_inset.inset_over_half_width"', 0, 0.2),
        values("restitution", 0.7, 0.95) | cases("restitution", 0.7, 0.95),
        words("formulation", "linear", "nonlinear"),
    ),
    ("stacked", WALL): (
        values("wall_height", 1.6, 2.0),
        values("aspect_ratio", 0.3, 1.1) | cases("aspect_ratio", 0.3, 1.1),
        values("top_mass", 1000, 5000),
        values('"pivot_inset.inset_over_half_width_top"', 0, 0.2),
    ),
    ("interface", f"{WALL}\nwall_height = 1.8\n{RUBBER}"): (
        values("aspect_ratio", 0.6, 1.2) | cases("aspect_ratio", 0.6, 1.2),
        values("top_mass", 1000, 5000),
        values("layer_modulus", 8e6, 2e7),
        words("rubber_law", "as_given", "linear", "hardening", "maxwell", "bouc_wen", "mullins", "permanent_set"),
        words("joints", "both", "base", "top"),
        values('"mullins.softening"', 0.0, 0.4),
    ),
    ("isolated", BUILDING): (
        values("levels", 1, 5),
        values("bearing_stiffness", 1e6, 9e6) | cases("bearing_stiffness", 1e6, 9e6),
        words("rubber_law", "linear", "mullins"),
        values('"mullins.softening"', 0.0, 0.4),
    ),
}  # fmt: skip


@st.composite
def plans(draw: st.DrawFn) -> Plan:
    (model, parameters), pool = draw(st.sampled_from(list(AXES.items())))
    axes = [draw(axis) for axis in pool] + draw(st.lists(st.sampled_from(SCALES), unique=True))
    return made(model, parameters, *draw(st.permutations(axes)))


def whole(plan: Plan, coordinate: Coordinate) -> np.ndarray[Any, np.dtype[np.float64]]:
    """A coordinate at every cell of the cube."""
    shape = [axis.size if axis.name in coordinate.dims else 1 for axis in plan.axes]
    return np.broadcast_to(coordinate.values.reshape(shape), plan.grid.shape)


def at_cell(plan: Plan, flat: int) -> dict[str, float]:
    """What the model says of one cell."""
    model = models.get(plan.model)
    at = {name: column[0] for name, column in plan.grid.coordinates([flat]).items()}
    said = {name: word for name, word in at.items() if name in model.options}
    numbers = {**plan.fixed, **at}
    wall = {n: float(v) for n, v in numbers.items() if n not in (*said, "pga", "time_scale")}
    return {name: float(v[0]) for name, v in model.derive(wall, {**plan.options, **said}).items()}


@settings(deadline=None, max_examples=25)
@given(plan=plans(), pieces=st.sampled_from([1, 3, 20]), data=st.data())
def test_a_coordinate_is_what_the_model_says_of_every_cell(plan: Plan, pieces: int, data: st.DataObject) -> None:
    model = models.get(plan.model)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(study.derived, "MOST_AT_ONCE", max(1, plan.grid.size // pieces))
        found = {c.name: c for c in derived_coordinates(plan, model)}
    assert set(found) == {quantity.name for quantity in model.derived}
    some = data.draw(st.lists(st.integers(0, plan.grid.size - 1), min_size=1, max_size=8, unique=True))
    for flat in {0, plan.grid.size // 2, plan.grid.size - 1, *some}:
        for name, expected in at_cell(plan, flat).items():
            here = whole(plan, found[name]).ravel()[flat]
            np.testing.assert_allclose(here, expected, rtol=1e-9, atol=1e-12, err_msg=name)
    for coordinate in found.values():
        for k in range(coordinate.values.ndim):
            across = np.moveaxis(coordinate.values, k, 0)
            assert not np.array_equal(across, np.broadcast_to(across[:1], across.shape), equal_nan=True)


LENGTHS = "specimen = { cases = [ { wall_length = 0.72 }, { wall_length = 1.98 }, { wall_length = 0.72 }, "
LENGTHS += "{ wall_length = 1.98 }, { wall_length = 0.72 } ] }"


def test_cases_whose_ends_and_middle_are_alike() -> None:
    plan = made("stacked", f"{WALL}\nwall_height = 1.8\ntop_mass = 5000", LENGTHS, SCALES[0])
    found = {c.name: c for c in derived_coordinates(plan, models.get("stacked"))}
    alpha = found["alpha"]
    assert alpha.dims == ("specimen",)
    assert np.all(alpha.values[1::2] > 1.5 * alpha.values[0]) and np.all(alpha.values[::2] == alpha.values[0])


LAWS = ["linear", "hardening", "linear", "mullins", "linear"]


def test_a_law_between_others_and_the_parameter_that_it_alone_uses() -> None:
    laws = f"law = {{ cases = [{', '.join(f'{{ rubber_law = {word!r} }}' for word in LAWS)}] }}"
    softening = '"mullins.softening" = { values = [0.1, 0.3] }'
    parameters = f"{WALL}\nwall_height = 1.8\naspect_ratio = 0.8\ntop_mass = 3000\nlayer_modulus = 8e6\n{RUBBER}"
    plan = made("interface", parameters, laws, softening)
    (compressed,) = [
        c for c in derived_coordinates(plan, models.get("interface")) if c.name == "static_compression_base"
    ]
    assert compressed.dims == ("law", "mullins.softening")
    linear, hardening, _, softened, _ = compressed.values
    assert np.all(hardening < linear) and linear[0] < softened[0] < softened[1]
    np.testing.assert_array_equal(compressed.values[::2], linear[0])


@pytest.mark.parametrize("axis", ["pga = { values = [0.5, 4.0] }", "motion_scale = { values = [0.1, 1.5] }",
                                  "time_scale = { values = [0.5, 1.0, 2.0] }"])  # fmt: skip
def test_a_study_of_the_motion_alone_has_a_cube(axis: str, tmp_path: Path) -> None:
    plan = made("housner", f"{BLOCK}\nwidth = 0.4", axis)
    cube = open_study(run(plan, results=tmp_path, scheduler="synchronous").folder)
    assert cube["status"].dims == (axis.split()[0],)
    assert cube["alpha"].dims == () and float(cube["alpha"]) == pytest.approx(np.arctan(0.4 / 1.8))


def test_a_study_of_a_single_cell_has_a_cube(tmp_path: Path) -> None:
    cube = open_study(run(made("housner", f"{BLOCK}\nwidth = 0.4"), results=tmp_path).folder)
    assert cube["alpha"].dims == cube["peak_rotation"].dims == ()


def test_a_million_cells_take_a_moment() -> None:
    """Counted, not timed: each cell that the model can tell apart is derived once, the scales of the motion never."""
    plan = made("housner", BLOCK, "width = { linspace = [0.2, 0.6, 40] }", "top_mass = { linspace = [0, 999, 25] }",
                "pga = { linspace = [1, 9, 1000] }")  # fmt: skip
    calls: list[int] = []
    housner = models.get("housner")

    class Counted:
        def __getattr__(self, name: str) -> Any:
            return getattr(housner, name)

        def derive(self, values: dict[str, Any], options: dict[str, str]) -> Any:
            calls.append(len(values["width"]))
            return housner.derive(values, options)

    derived_coordinates(plan, Counted())  # type: ignore[arg-type]
    assert plan.grid.size == 10**6 and sum(calls) == 1000
