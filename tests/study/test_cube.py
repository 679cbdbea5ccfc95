"""The cube as others read it: CF attributes, coordinates, provenance in one place; export."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st

import models
from grids.plan import read_plan
from models.base import STATUS
from models.errors import InputError
from study import provenance
from study.derived import derived_coordinates
from study.export import export
from study.open import open_study
from study.provenance import attribute, sha256
from study.run import run
from tests.study.plans import plan_text, small_plan


@pytest.fixture(scope="module")
def cube(tmp_path_factory: pytest.TempPathFactory) -> xr.Dataset:
    return open_study(run(small_plan(), results=tmp_path_factory.mktemp("cube")).folder)


def test_every_variable_says_what_it_is(cube: xr.Dataset) -> None:
    assert cube.attrs["Conventions"] == "CF-1.11"
    for name in cube.variables:
        for required in ("units", "long_name", "comment"):
            assert cube[name].attrs.get(required), f"{name} has no {required}"
    assert cube["aspect_ratio"].dims == ("aspect_ratio",)
    assert cube["pga"].attrs["units"] == "m s-2" and cube["top_mass"].attrs["units"] == "kg"


def test_status_words_are_the_models(cube: xr.Dataset) -> None:
    assert cube["status"].attrs["flag_meanings"].split() == list(STATUS)
    np.testing.assert_array_equal(cube["status"].attrs["flag_values"], np.arange(len(STATUS)))


def test_derived_coordinates_lie_over_the_axes_they_depend_on(cube: xr.Dataset) -> None:
    assert cube["alpha"].dims == ("aspect_ratio", "top_mass")
    assert cube["motion"].dims == () and str(cube["motion"].values) == "ridgecrest_2019_clc"
    a, m = np.meshgrid(cube["aspect_ratio"], cube["top_mass"], indexing="ij")
    values = {"height": 1.8, "mass": 800.0, "aspect_ratio": a.ravel(), "top_mass": m.ravel()}
    expected = models.get("housner").derive(values)
    for name in ("alpha", "radius", "frequency_parameter", "onset_acceleration"):
        np.testing.assert_array_equal(cube[name].values.ravel(), expected[name])


def test_derived_coordinates_know_the_option_words() -> None:
    plan = read_plan(Path(__file__).parents[2] / "studies" / "rubber_laws.toml")
    model = models.get("interface")
    found = {c.name: c for c in derived_coordinates(plan, model)}
    compressed = found["static_compression_base"]
    assert compressed.dims == ("rubber_law", "layer_modulus")
    laws = plan.axes[0].values.tolist()
    alone = {k: v for k, v in plan.fixed.items() if "." not in k} | {"layer_modulus": plan.axes[1].values}
    linear = model.derive(alone)["static_compression_base"]
    np.testing.assert_allclose(compressed.values[laws.index("linear")], linear, rtol=1e-12)
    np.testing.assert_allclose(compressed.values[laws.index("maxwell")], linear, rtol=1e-12)
    assert np.all(compressed.values[laws.index("hardening")] < linear)
    assert np.all(compressed.values[laws.index("mullins")] > linear)


def test_provenance_stands_in_one_place(cube: xr.Dataset) -> None:
    found = cube.rocking.provenance
    assert found["plan"] == plan_text() and found["plan_sha256"] == sha256(plan_text())
    assert found["inputs"]["ridgecrest_2019_clc"]["fingerprint"]
    assert {"versions", "commit", "host", "started", "finished"} <= found.keys()
    values = {name: (entry["value"], entry["unit"], entry["source"]) for name, entry in found["values"].items()}
    assert values["height"] == (1.8, "m", "plan") and values["tail"] == (2.0, "s", "plan")
    assert values["gravity"] == (9.80665, "m s-2", "default"), "the values that the plan leaves to the model too"
    assert values["formulation"] == ("nonlinear", "1", "default") and values["integrator"] == ("lanes", "1", "default")
    assert not {"pga", "aspect_ratio", "top_mass"} & values.keys()
    assert "gravity = 9.80665 m s-2 (default)" in cube.attrs["fixed_values"]
    for name in cube.variables:
        assert found["host"] not in str(cube[name].attrs)


def test_records_as_an_axis(tmp_path: Path) -> None:
    motion = 'files = ["ridgecrest_2019_c*"]'
    plan = small_plan(motion=motion, pga="values = [0.3, 0.6], unit = 'g'")
    both = open_study(run(plan, results=tmp_path).folder)
    assert both["record_pga"].dims == ("motion",)
    assert [str(name) for name in both["motion"].values] == [motion.name for motion in plan.motions]
    alone = small_plan(pga="values = [0.3, 0.6], unit = 'g'", name="alone")
    one = open_study(run(alone, results=tmp_path).folder)
    at = both.sel(motion="ridgecrest_2019_clc")
    for name in one.data_vars:
        np.testing.assert_array_equal(at[name].values, one[name].values)


def test_export_keeps_every_digit(cube: xr.Dataset, tmp_path: Path) -> None:
    path = export(cube, tmp_path / "cells.csv", outputs=["peak_rotation"], at={"pga": "0.2 g"})
    with path.open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 21
    chosen = cube.sel(pga=2.0, method="nearest")
    peaks = [float(row["peak_rotation [rad]"]) for row in rows]
    np.testing.assert_array_equal(peaks, chosen["peak_rotation"].values.ravel())
    assert {float(row["top_mass [kg]"]) for row in rows} == set(cube["top_mass"].values)
    part = export(cube, tmp_path / "part.nc", at={"top_mass": 1000.0})
    with xr.open_dataset(part) as stored:
        np.testing.assert_array_equal(stored["impacts"], cube["impacts"].sel(top_mass=1000.0))
        assert stored.attrs["provenance"] == cube.attrs["provenance"]


def test_export_refuses_in_one_sentence(cube: xr.Dataset, tmp_path: Path) -> None:
    for out, outputs, words in (("a.xlsx", (), "end the name in"), ("a.csv", ("peak",), "no output")):
        with pytest.raises(InputError, match=words):
            export(cube, tmp_path / out, outputs=outputs)
    assert not list(tmp_path.iterdir())


JSON = st.recursive(
    st.none() | st.booleans() | st.integers(-(2**40), 2**40) | st.floats(allow_nan=False) | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=3), inner, max_size=3),
    max_leaves=6,
)


@given(value=JSON)
def test_any_value_becomes_an_attribute_that_netcdf_takes(value: Any) -> None:
    made = attribute(value)
    assert isinstance(made, str | int | float | np.ndarray) and not isinstance(made, bool)
    if isinstance(made, np.ndarray):
        assert made.dtype.kind in "if" and made.size


def test_an_answer_outside_git_has_no_commit(monkeypatch: pytest.MonkeyPatch) -> None:
    """None, which is null in the JSON of every answer: of recordings and of outcomes."""
    assert provenance.program()["commit"] == (provenance.commit() or None)
    monkeypatch.setattr(provenance, "commit", lambda: "")
    assert provenance.program()["commit"] is None
