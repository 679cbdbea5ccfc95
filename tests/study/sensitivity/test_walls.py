"""A small wall: Sobol indices of a study against brute force over the product of its distributions."""

from __future__ import annotations

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pytest
import xarray as xr
from scipy.stats import norm

from grids.plan import Plan, parse_plan
from models.errors import InputError
from study.figures import plot_indices, plot_interactions, plot_tornado
from study.open import open_study
from study.run import run
from study.sensitivity.analysis import analyse
from study.sensitivity.table import what_to_tune
from study.sets.cells import event_of

HEAD = """
[study]
name = "{name}"
model = "housner"
[motion]
pulse = {{ shape = "sine", amplitude = "1 g", frequency = "1.25 Hz", time_step = "0.005 s" }}
[parameters]
height = "2 m"
mass = 1000
[outputs]
names = ["overturned", "peak_rotation_ratio", "onset_time"]
[run]
tail = "2 s"
[axes]
"""
SAMPLE = """
sample.{kind} = {count}
sample.seed = 1
[axes.sample.parameters]
aspect_ratio = [0.15, 0.3]
restitution = {{ normal = [0.85, 0.05], truncated = [0.75, 0.95] }}
pga = {{ range = [0.25, 2.5], unit = "g", spacing = "log" }}
"""
CELLS = 20
COMPARED = 12
"""Indices held against brute force: all of them within their intervals at 95 %."""


def small_wall(kind: str, count: int) -> Plan:
    return parse_plan(HEAD.format(name=kind) + SAMPLE.format(kind=kind, count=count), Path.cwd())


def product() -> Plan:
    """The middle of 20 equally likely parts of each distribution."""
    share = (np.arange(CELLS) + 0.5) / CELLS
    low, high = norm.cdf([-2.0, 2.0])
    axes = {
        "aspect_ratio": 0.15 + 0.15 * share,
        "restitution": 0.85 + 0.05 * norm.ppf(low + (high - low) * share),
        "pga": 9.80665 * 0.25 * 10.0**share,
    }
    lines = [f"{name} = {{ values = {values.tolist()} }}" for name, values in axes.items()]
    return parse_plan(HEAD.format(name="product") + "\n".join(lines), Path.cwd())


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("sensitivity")


@pytest.fixture(scope="module")
def brute(home: Path) -> xr.Dataset:
    return open_study(run(product(), results=home, scheduler="synchronous").folder)


@pytest.fixture(scope="module")
def found(home: Path) -> xr.Dataset:
    plan = small_wall("saltelli", 1024)
    cube = open_study(run(plan, results=home, scheduler="synchronous").folder)
    return analyse(cube, plan, [event_of(cube, "peak_rotation_ratio", 0.2)], confidence=1 - 0.05 / COMPARED)


def exact(values: xr.DataArray) -> tuple[np.ndarray, np.ndarray]:
    dims = ("aspect_ratio", "restitution", "pga")
    whole = float(values.var())
    first = [float(values.mean([d for d in dims if d != name]).var()) / whole for name in dims]
    total = [float(values.var(name).mean()) / whole for name in dims]
    return np.array(first), np.array(total)


@pytest.mark.parametrize("output", ["overturned", "peak_rotation_ratio > 0.2"])
def test_indices_of_probability_against_brute_force(brute: xr.Dataset, found: xr.Dataset, output: str) -> None:
    """All 8000 cells of the product against 8192 points; the intervals are widened by what 20 parts leave open."""
    values = brute["overturned"] if output == "overturned" else (brute["peak_rotation_ratio"] > 0.2).astype(float)
    one = found.sel(output=output).isel(motions=0)
    for name, truth in zip(("first", "total"), exact(values), strict=True):
        assert np.all(one[f"{name}_low"].values - 0.02 <= truth), (name, truth)
        assert np.all(truth <= one[f"{name}_high"].values + 0.02), (name, truth)
    assert float(one["mean"]) == pytest.approx(float(values.mean()), abs=0.02)
    pga = values.mean(["aspect_ratio", "restitution"]).values
    assert float(one["at_low"][2]) == pytest.approx(pga[:4].mean(), abs=0.06)
    assert float(one["at_high"][2]) == pytest.approx(pga[-4:].mean(), abs=0.06)


def test_what_has_no_value_everywhere_is_left_out(found: xr.Dataset) -> None:
    assert found["output"].values.tolist() == ["overturned", "peak_rotation_ratio", "peak_rotation_ratio > 0.2"]


def test_table_and_figures(found: xr.Dataset) -> None:
    rows = what_to_tune(found, "overturned")
    totals = [float(row[1].split()[0]) for row in rows[1:]]
    assert rows[1][0] == "pga" and rows[1][-1] == "yes" and totals == sorted(totals, reverse=True)
    ax = plot_indices(found, "overturned")
    assert next(text.get_text() for text in ax.get_yticklabels()) == "PGA"
    plot_tornado(found, "overturned")
    plot_interactions(found, "overturned")
    plt.close("all")


def test_interactions_within_chance_are_left_grey(found: xr.Dataset) -> None:
    """Of all pairs at once: with many pairs some single interval always lies above zero."""
    one = found.sel(output=["overturned"]).isel(motions=[0])
    wide = one.assign(second_low=one["second"] - abs(one["second"]) / 1.1)
    narrow = one.assign(second_low=one["second"] - 1e-6)
    grey = [np.ma.masked_invalid(plot_interactions(x, "overturned").images[0].get_array()) for x in (wide, narrow)]
    assert grey[0].count() == 0 < grey[1].count()
    plt.close("all")


def test_screening_agrees_with_the_indices(home: Path, found: xr.Dataset) -> None:
    plan = small_wall("morris", 32)
    cube = open_study(run(plan, results=home, scheduler="synchronous").folder)
    screened = analyse(cube, plan)
    mu_star = screened.sel(output="overturned").isel(motions=0)["mu_star"].values
    total = found.sel(output="overturned").isel(motions=0)["total"].values
    assert np.argmin(mu_star) == np.argmin(total) == 1, "one sine hardly asks for the restitution"


def test_a_plan_without_a_design_is_refused(brute: xr.Dataset) -> None:
    with pytest.raises(InputError, match="one axis of kind saltelli or morris"):
        analyse(brute, product())
