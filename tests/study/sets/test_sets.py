"""Cubes of a set of motions: fragility, incremental curves, measures, against capacities that are known."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
import pytest
import xarray as xr

from grids.motions import make_pulse, read_motion
from grids.motions.measures import MEASURES, measures_of
from grids.samples import MEANING
from models.errors import InputError
from study.figures.cloud import plot_cloud
from study.sets.cells import event_of, intensity
from study.sets.fragility import fragility
from study.sets.incremental import incremental
from study.sets.sorting import area_under_curve, sorting
from study.status import NOT_CONVERGED, OVERTURNED, REST
from tests.study.sets.simulated import DISPERSION, LEVELS, MEDIAN, capacities, cube_of

CAPACITY = capacities(np.random.default_rng(5), 60)
CUBE = cube_of(CAPACITY)


@pytest.mark.parametrize(("scale", "stretch"), [(1.7, 1.0), (1.0, 1.5)])
def test_measures_grow_as_they_say(scale: float, stretch: float) -> None:
    """A scaled or stretched motion has the measures that follow from the record's. PGD is left out of the stretched
    record: its high-pass does not stretch with it; the pulse has none."""
    pulse = make_pulse({"shape": "sine", "amplitude": "2 m/s^2", "frequency": "2 Hz", "lead": "0.1 s", "rest": "1 s"})
    motions = [pulse] if stretch != 1.0 else [pulse, read_motion("ridgecrest_2019_clc")]
    for motion in motions:
        before, after = measures_of(motion), measures_of(motion.scaled(scale).time_scaled(stretch))
        for measure in MEASURES:
            if stretch == 1.0 or measure.stretch is not None:
                factor = scale**measure.power * stretch ** (measure.stretch or 0.0)
                assert after[measure.name] == pytest.approx(factor * before[measure.name], rel=1e-6), measure.name


def test_intensity_of_a_cell_is_that_of_its_scaled_motion() -> None:
    np.testing.assert_allclose(intensity(CUBE, "pga"), np.broadcast_to(LEVELS, (60, 12)))
    np.testing.assert_allclose(intensity(CUBE, "pgv"), LEVELS / CAPACITY[:, None])
    assert (intensity(CUBE, "duration") == CUBE["record_duration"]).all()
    with pytest.raises(InputError, match="does not hold record_arias"):
        intensity(CUBE, "arias")


def test_fragility_finds_the_capacities() -> None:
    found = fragility(CUBE, event_of(CUBE))
    assert found["median_low"] < MEDIAN < found["median_high"]
    assert found["dispersion_low"] < DISPERSION < found["dispersion_high"]
    np.testing.assert_allclose(found["share"], [(level >= CAPACITY).mean() for level in LEVELS])
    np.testing.assert_allclose(found["strength"], LEVELS)
    assert (found["share_low"] <= found["share"]).all() and (found["share"] <= found["share_high"]).all()
    half = fragility(CUBE, event_of(CUBE, "peak_rotation", 0.05))
    assert half["median"] == pytest.approx(float(found["median"]) / 2, rel=0.1)
    sharp = fragility(CUBE, event_of(CUBE), "pgv")
    assert "one threshold" in str(sharp["why"].values), "PGV decides alone here"


def test_fragility_over_samples_holds_what_is_not_known_of_the_wall() -> None:
    """Walls whose capacities are those of the first times a factor: medians scale with it, dispersions do not."""
    factors = np.exp(0.2 * np.linspace(-1.0, 1.0, 21))
    levels = np.geomspace(0.6, 12.0, 40)
    cube = xr.concat(
        [cube_of(CAPACITY * factor, levels) for factor in factors], "sample", coords="minimal", compat="override"
    )
    cube = cube.assign_coords(sample=("sample", np.arange(21), {"units": "1", "comment": MEANING}))
    found, each = fragility(cube, event_of(cube)), fragility(cube, event_of(cube), over="sample")
    assert found.attrs["samples"] == 21 and each.attrs["samples"] == 0
    one = fragility(cube.isel(sample=10), event_of(cube))
    assert found["median"] == pytest.approx(float(one["median"]), rel=0.01)
    for end, factor in (("_low", np.exp(-0.19)), ("_high", np.exp(0.19))):
        assert found[f"median{end}"] == pytest.approx(factor * float(one["median"]), rel=0.02)
    assert found["dispersion_high"] - found["dispersion_low"] < 0.1 * found["dispersion"]
    np.testing.assert_allclose(found["probability"], each["probability"].mean("sample"))
    low, middle, high = (found[f"probability{end}"] for end in ("_low", "", "_high"))
    assert (low <= middle).all() and (middle <= high).all()
    assert found["share"][7] == pytest.approx(np.mean([levels[7] >= CAPACITY * factor for factor in factors]))
    chosen = fragility(cube, event_of(cube), at={"sample": 3})
    assert chosen.attrs["samples"] == 0 and chosen["median"] == pytest.approx(float(each["median"][3]))
    with pytest.raises(InputError, match="'sample' holds 21 equally likely walls"):
        incremental(cube, "peak_rotation")


def test_samples_that_never_or_always_fall_count_in_a_fragility() -> None:
    cubes = [cube_of(CAPACITY * factor) for factor in (1e-3, 1.0, 1e3, 1e3, 1e3)]
    cube = xr.concat(cubes, "sample", coords="minimal", compat="override")
    cube = cube.assign_coords(sample=("sample", np.arange(5), {"units": "1", "comment": MEANING}))
    found = fragility(cube, event_of(cube))
    for end in (0, -1):
        share = found["probability"].sel(level=LEVELS[end], method="nearest")
        assert share == pytest.approx(float(found["share"][end]), abs=0.02)
    assert np.isinf(found["median"]) and found["median_low"] == 0.0
    assert "3 of 5 samples: it never happens" in str(found["why"].values)


def test_a_design_called_sample_holds_no_equally_likely_walls() -> None:
    cube = xr.concat([CUBE, cube_of(2.0 * CAPACITY)], "sample", coords="minimal", compat="override")
    cube = cube.assign_coords(sample=("sample", [0, 1], {"units": "1", "comment": "point of the design"}))
    found = fragility(cube, event_of(cube))
    assert found.attrs["samples"] == 0
    assert found["median"] == pytest.approx(float(fragility(cube_of(2.0 * CAPACITY), event_of(cube))["median"]))


def test_unanswered_cells_are_left_out() -> None:
    cube = CUBE.copy(deep=True)
    cube["status"][:30, 4] = NOT_CONVERGED
    found = fragility(cube, event_of(cube))
    assert found["unknown"] == 30 and found["cells"] == 690
    assert found["share"][4] == pytest.approx((CAPACITY[30:] <= LEVELS[4]).mean())


def test_quantiles_of_incremental_curves() -> None:
    """Of rotations .1 pga/capacity, infinite from the capacity on, the quantiles are known at every level."""
    found = incremental(CUBE, "peak_rotation")
    ratio = LEVELS / np.sort(CAPACITY)[::-1][:, None]
    for k, quantile in enumerate(found["quantile"].values):
        exact = np.where(ratio >= 1.0, np.inf, 0.1 * ratio)[int(np.ceil(quantile * 60)) - 1]
        np.testing.assert_allclose(found["quantile_curves"][k], exact)
    np.testing.assert_allclose(found["overturned_share"], [(level >= CAPACITY).mean() for level in LEVELS])
    by_velocity = incremental(CUBE, "peak_rotation", "pgv")
    finite = by_velocity["quantile_curves"].where(np.isfinite(by_velocity["quantile_curves"]))
    assert (finite.max("quantile") - finite.min("quantile")).max() < 0.005, "over PGV all motions are one curve"
    with pytest.raises(InputError, match="does not grow"):
        incremental(CUBE, "peak_rotation", "duration")


def test_the_measure_that_decides_sorts_best() -> None:
    found = sorting(CUBE, event_of(CUBE), measures=("pga", "pgv", "duration"))
    assert found["measure"].values.tolist()[:2] == ["pgv", "pga"] and found["area"][0] == 1.0
    last = found.sel(measure="duration")
    assert last["area_low"] < 0.5 < last["area_high"]
    with pytest.raises(InputError, match="nothing to sort"):
        sorting(CUBE.isel(pga=[0]), event_of(CUBE))


def test_area_is_the_chance_that_a_pair_is_sorted() -> None:
    random = np.random.default_rng(7)
    x, y = random.integers(0, 9, 60).astype(float), random.integers(0, 2, 60).astype(float)
    ones, zeros = x[y == 1.0][:, None], x[y == 0.0]
    assert area_under_curve(x, y) == pytest.approx(np.mean((ones > zeros) + 0.5 * (ones == zeros)))


def test_bad_events_are_refused() -> None:
    for words, cure in (
        (("peak_rotaton", 0.1), "did you mean"),
        (("peak_rotation", None), "needs the threshold"),
        (("overturned", 0.5), "yes or no"),
    ):
        with pytest.raises(InputError, match=cure):
            event_of(CUBE, *words)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="no axis 'motion'"):
        fragility(CUBE.isel(motion=0), event_of(CUBE))


def test_curves_begin_where_something_shakes() -> None:
    levels = np.array([0.0, 1.0, 2.0, 4.0])
    cube = cube_of(np.array([2.5, 3.0, 3.5]), levels)
    for measure in ("pga", "pgv"):
        found = incremental(cube, "peak_rotation", measure)
        assert found["pga"].values.tolist() == [1.0, 2.0, 4.0]
        assert np.all(np.isfinite(found["quantile_curves"].values[:, 0]))
    with pytest.raises(InputError, match="two values of pga above zero"):
        incremental(cube.isel(pga=[0, 1]), "peak_rotation", "pga")


def test_a_misspelt_output_of_a_cloud_is_a_sentence() -> None:
    with pytest.raises(InputError, match="'peak_rotatoin' is no output of this cube: did you mean 'peak_rotation'"):
        plot_cloud(cube_of(np.array([2.5, 3.0])), "peak_rotatoin")


def test_a_cloud_counts_what_stands_though_it_cannot_draw_it() -> None:
    cube = cube_of(np.array([2.5, 3.0]))
    still = cube.assign(peak_rotation=cube["peak_rotation"].where(cube["status"] != REST, 0.0))
    assert (still["status"] == REST).any()
    texts = [text.get_text() for text in plot_cloud(still, "peak_rotation").get_legend().texts]
    plt.close("all")
    standing, rest = int((still["status"] != OVERTURNED).sum()), int((still["status"] == REST).sum())
    assert f"stands ({standing}, {rest} of them at zero: not drawn)" in texts
