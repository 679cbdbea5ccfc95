"""Maps against brute force on cubes of random outcomes; selections; figures that can be drawn."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import matplotlib
import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.contour import ContourSet

import study.accessor  # noqa: F401
from grids.samples import MEANING
from models.errors import InputError
from study.figures import plot_onset_map, plot_output_map, plot_overturning_map, plot_slices, save_figure
from study.figures.style import geometric, positions
from study.maps import default_axes
from study.selection import complete, position
from study.status import OVERTURNED, ROCKING, UNKNOWN
from tests.study.cubes import known_cube

matplotlib.use("agg")


@pytest.fixture(params=range(5))
def cube(request: pytest.FixtureRequest) -> xr.Dataset:
    return known_cube(np.random.default_rng(request.param))


def brute_force(cube: xr.Dataset, flags: tuple[int, ...]) -> np.ndarray:
    """Smallest PGA by going up in PGA, cell by cell: stop at the first hit, or at the first unknown."""
    found = np.full((cube.sizes["top_mass"], cube.sizes["aspect_ratio"]), np.nan)
    for i in range(cube.sizes["aspect_ratio"]):
        for j in range(cube.sizes["top_mass"]):
            for k in np.argsort(cube["pga"].values):
                status = int(cube["status"].values[i, j, k])
                if status in UNKNOWN:
                    break
                if status in flags:
                    found[j, i] = cube["pga"].values[k]
                    break
    return found


def test_smallest_intensity_equals_brute_force(cube: xr.Dataset) -> None:
    overturning = cube.rocking.overturning_map(x="aspect_ratio", y="top_mass")
    onset = cube.rocking.onset_map(x="aspect_ratio", y="top_mass")
    assert overturning.dims == onset.dims == ("top_mass", "aspect_ratio")
    np.testing.assert_array_equal(overturning.values, brute_force(cube, (OVERTURNED,)))
    np.testing.assert_array_equal(onset.values, brute_force(cube, (ROCKING, OVERTURNED)))
    assert overturning.attrs["units"] == "m s-2"


def test_yes_or_no_over_the_intensity_equals_the_flags(cube: xr.Dataset) -> None:
    drawn = cube.rocking.overturning_map(x="aspect_ratio", y="pga", top_mass=2000.0)
    status = cube["status"].values[:, 2, :].T
    np.testing.assert_array_equal(drawn.values == 1.0, status == OVERTURNED)
    np.testing.assert_array_equal(np.isnan(drawn.values), np.isin(status, UNKNOWN))


def of_samples(count: int = 9) -> xr.Dataset:
    cubes = [known_cube(np.random.default_rng(seed)) for seed in range(count)]
    pga = cubes[0]["pga"]  # the same grid for all
    found = xr.concat([one.assign_coords(pga=pga) for one in cubes], "sample")
    return found.assign_coords(sample=("sample", np.arange(count), {"units": "1", "comment": MEANING}))


def test_a_map_over_samples_is_their_share(tmp_path: Path) -> None:
    cube = of_samples()
    assert default_axes(cube, None, None) == ("aspect_ratio", "top_mass")
    drawn = cube.rocking.overturning_map(x="aspect_ratio", y="pga", top_mass=2000.0)
    status = cube["status"].values[:, :, 2, :]
    known = ~np.isin(status, UNKNOWN)
    np.testing.assert_allclose(drawn.values.T, ((status == OVERTURNED) & known).sum(axis=0) / known.sum(axis=0))
    assert drawn.name == "overturned_share" and drawn.attrs["selection"].endswith("9 samples")
    for plot in (plot_overturning_map, plot_onset_map):
        path = save_figure(partial(plot, cube, "aspect_ratio", "pga"), tmp_path / "share.png")
        assert path.stat().st_size > 1e4
    with pytest.raises(InputError, match="'sample' holds 9 equally likely walls"):
        cube.rocking.output_map("peak_rotation", "aspect_ratio", "pga")
    assert cube.rocking.output_map("peak_rotation", "aspect_ratio", "pga", sample=0).dims == ("pga", "aspect_ratio")


def test_maps_over_samples_of_records_or_of_nothing_known_have_no_lines() -> None:
    cube = of_samples().isel(top_mass=0)
    named = cube.assign_coords(aspect_ratio=("aspect_ratio", list("abcd"), {"units": "1", "axis_of_study": "true"}))
    empty = cube.assign(status=cube["status"] * 0)
    for k, (one, lines) in enumerate(((cube, True), (named, False), (empty, False))):
        fig, ax = plt.subplots()
        plot_overturning_map(one, "aspect_ratio", "pga", ax=ax)
        assert any(isinstance(c, ContourSet) for c in ax.collections) == lines, k
        plt.close(fig)


def test_the_smallest_intensity_over_samples_is_that_of_half_of_them() -> None:
    cube = of_samples()
    found = cube.rocking.overturning_map(x="aspect_ratio", y="top_mass").values
    for i, j in np.ndindex(cube.sizes["aspect_ratio"], cube.sizes["top_mass"]):
        expected = np.nan
        for k in np.argsort(cube["pga"].values):
            status = cube["status"].values[:, i, j, k]
            least, unknown = (status == OVERTURNED).sum(), np.isin(status, UNKNOWN).sum()
            if least >= 4.5:
                expected = cube["pga"].values[k]
            if least + unknown >= 4.5:
                break
        np.testing.assert_equal(found[j, i], expected)


def test_onset_never_lies_above_overturning(cube: xr.Dataset) -> None:
    overturning = cube.rocking.overturning_map(x="top_mass", y="aspect_ratio").values
    onset = cube.rocking.onset_map(x="top_mass", y="aspect_ratio").values
    both = np.isfinite(overturning)
    assert np.all(onset[both] <= overturning[both])


def test_slices_are_the_cube(cube: xr.Dataset) -> None:
    curve = cube.rocking.slices("peak_rotation", x="pga", aspect_ratio=0.1, top_mass="4 t")
    np.testing.assert_array_equal(curve.values, cube["peak_rotation"].values[0, -1])
    assert cube.rocking.slices("peak_rotation", x="pga", aspect_ratio=0.1).dims == ("top_mass", "pga")


@pytest.mark.parametrize(
    ("ask", "words"),
    [
        (lambda c: c.rocking.onset_map(x="aspect_ration", y="pga"), "did you mean 'aspect_ratio'"),
        (lambda c: c.rocking.onset_map(x="pga", y="pga"), "choose two axes"),
        (
            lambda c: c.rocking.overturning_map(x="aspect_ratio", y="top_mass", pga="0.3"),
            "pga=0.3 has no unit.*'0.3 g'",
        ),
        (lambda c: c.rocking.onset_map(x="pga", y="aspect_ratio", top_mass="2 m"), "'kg' is needed"),
        (lambda c: c.rocking.onset_map(x="pga", y="top_mass", pga=1.0), "leave it out"),
        (lambda c: c.rocking.onset_map(x="pga", y="top_mass", aspect_ratio="wide"), "give a number"),
        (lambda c: c.rocking.slices("peak_rotaton", x="pga"), "did you mean 'peak_rotation'"),
        (lambda c: c.rocking.slices("peak_rotation", x="pga", top_mass=1900.0), "1900 kg.*1000 kg and 2000 kg"),
        (lambda c: c.rocking.slices("peak_rotation", x="top_mass", pga="30 g"), "from 0.102 g to 0.6118 g"),
        (lambda c: c.rocking.output_map("peak_rotation", x="pga", y="top_mass", aspect_ratio=0.15), "0.1 and 0.2"),
    ],
)
def test_a_wrong_question_gets_one_sentence(cube: xr.Dataset, ask: object, words: str) -> None:
    with pytest.raises(InputError, match=words) as caught:
        ask(cube)  # type: ignore[operator]
    assert "\n" not in str(caught.value)


def test_default_axes_leave_the_intensity_to_be_searched(cube: xr.Dataset) -> None:
    assert default_axes(cube, None, None) == ("aspect_ratio", "top_mass")
    assert default_axes(cube, "pga", None) == ("pga", "aspect_ratio")


def test_an_axis_left_open_takes_its_middle_value_and_says_so(cube: xr.Dataset) -> None:
    drawn = cube.rocking.overturning_map()
    xr.testing.assert_identical(drawn, cube.rocking.overturning_map(x="aspect_ratio", y="top_mass"))
    drawn = cube.rocking.onset_map(x="aspect_ratio", y="pga")
    xr.testing.assert_identical(drawn, cube.rocking.onset_map(x="aspect_ratio", y="pga", top_mass=2000.0))
    assert drawn.attrs["selection"] == "top mass 2000 kg"
    curves = cube.rocking.slices("peak_rotation", x="pga")
    assert curves.dims == ("aspect_ratio", "pga") and curves.attrs["selection"] == "top mass 2000 kg"


def test_the_nearest_value_lies_at_most_a_step_of_the_grid_away(cube: xr.Dataset) -> None:
    def shown(pga: float) -> str:
        drawn = cube.rocking.overturning_map(x="aspect_ratio", y="top_mass", pga=pga, nearest=True)
        return str(drawn.attrs["selection"])

    before, last = np.sort(cube["pga"].values)[-2:]
    assert shown(last + 0.9 * (last - before)) == f"PGA {last / 9.80665:.4g} g"
    with pytest.raises(InputError, match=r"not on the grid, nor near its end at .* give a value of the grid"):
        shown(last + 1.1 * (last - before))
    with pytest.raises(InputError, match=r"not on the grid, nor near its end at"):
        shown(-1.1 * last)


def test_a_short_last_step_leaves_the_nearest_value_as_near() -> None:
    """Of a grid that a refinement has cut finely at its end its largest step counts."""
    uneven = xr.Dataset(coords={"pga": ("pga", [1.0, 2.0, 2.0001], {"units": "m s-2"})})
    assert position(uneven, "pga", 2.001, nearest=True) == 2 and position(uneven, "pga", 0.5, nearest=True) == 0
    with pytest.raises(InputError, match="nor near its end"):
        position(uneven, "pga", 3.1, nearest=True)


def test_a_value_is_one_of_the_grid_or_the_nearest_if_asked_for(cube: xr.Dataset) -> None:
    pga = float(cube["pga"].values[3])
    by_number = cube.rocking.overturning_map(x="aspect_ratio", y="top_mass", pga=pga)
    text = f"{pga / 9.80665:.4g} g"  # as figures and messages print it
    xr.testing.assert_identical(by_number, cube.rocking.overturning_map(x="aspect_ratio", y="top_mass", pga=text))
    assert by_number.attrs["selection"] == f"PGA {text}"
    with pytest.raises(InputError, match="not on the grid"):
        cube.rocking.overturning_map(x="aspect_ratio", y="top_mass", pga=1.01 * pga)
    near = cube.rocking.overturning_map(x="aspect_ratio", y="top_mass", pga=1.01 * pga, nearest=True)
    xr.testing.assert_identical(near, by_number)
    for nearest in (False, True):  # infinity is as far from every value
        for far in (np.inf, "-inf g"):
            with pytest.raises(InputError, match=r"pga = -?inf g is not on the grid: it goes from"):
                cube.rocking.overturning_map(x="aspect_ratio", y="top_mass", pga=far, nearest=nearest)


def test_axes_by_equal_factors_are_logarithmic_and_in_engineers_units(tmp_path: Path) -> None:
    modulus = np.geomspace(1e6, 2e7, 13)
    pga = np.linspace(0.5, 5.0, 4)
    status = np.where(modulus[:, None, None] * pga > 6e6, ROCKING, 1) * np.ones((13, 3, 4), int)
    cube = xr.Dataset(
        {"status": (("layer_modulus", "case", "pga"), status)},
        {"layer_modulus": modulus, "case": np.arange(3.0), "pga": pga},
    )
    for name, unit in (("layer_modulus", "Pa"), ("case", "1"), ("pga", "m s-2")):
        cube[name].attrs.update(units=unit, axis_of_study="true")
    seen = []
    save_figure(lambda: seen.append(plot_onset_map(cube, "case", "layer_modulus")) or seen[0], tmp_path / "onset.png")
    ax = seen[0]
    assert ax.get_yscale() == "log" and ax.get_xscale() == "linear"
    assert ax.get_ylabel() == "layer modulus [MPa]"
    low, high = ax.get_ylim()
    factor = 20 ** (1 / 24)
    np.testing.assert_allclose([low, high], [1 / factor, 20 * factor], rtol=1e-12)
    assert ax.figure.axes[1].get_yticklabels()[0].get_text() == "≤ 0.051"


@pytest.mark.parametrize(
    ("points", "by_factors"),
    [
        ([0.0315, 0.04, 0.05, 0.063, 0.08, 0.1, 0.125, 0.16], True),
        ([2.0, 2.5, 3.15, 4.0, 5.0, 6.3, 8.0, 10.0], True),
        ([0.3, 0.4, 0.5, 0.6], False),
        ([0.0167, 0.03, 0.0544, 0.08, 0.1], False),
        ([1.0, 1.01, 1.02], False),
    ],
)
def test_preferred_numbers_grow_by_equal_factors(points: list[float], by_factors: bool) -> None:
    assert geometric(np.array(points)) == by_factors


def test_figures_are_written_with_units_on_their_axes(cube: xr.Dataset, tmp_path: Path) -> None:
    seen = []

    def draw(make: object) -> object:
        seen.append(make())  # type: ignore[operator]
        return seen[-1]

    for k, make in enumerate(
        [
            lambda: plot_overturning_map(cube, "aspect_ratio", "top_mass"),
            lambda: plot_onset_map(cube, "aspect_ratio", "pga", {"top_mass": 0.0}),
            lambda: plot_slices(cube, "peak_rotation", "pga", {"top_mass": 0.0}),
            lambda: plot_slices(cube, "peak_rotation", "pga", {"top_mass": 0.0, "aspect_ratio": 0.2}),
        ]
    ):
        path = save_figure(lambda make=make: draw(make), tmp_path / f"{k}.png")  # type: ignore[misc]
        assert path.stat().st_size > 5000
    assert seen[0].get_ylabel() == "top mass [kg]"
    assert seen[1].get_ylabel() == seen[2].get_xlabel() == "PGA [g]"
    assert "top mass 0 kg" in seen[1].get_title().replace("\u00a0", " ")
    # an overturned cell has a gap in the curve and a cross on the border, never a point of pi/2
    assert seen[2].get_ylim()[1] < 1.0
    with pytest.raises(InputError, match="end the name in"):
        save_figure(lambda: plot_onset_map(cube, "aspect_ratio", "top_mass"), tmp_path / "map.xyz")
    assert not matplotlib.pyplot.get_fignums()


def drawn_patches(ax: Axes) -> dict[str, tuple[float, float, float, float]]:
    """Colours of the legend by their words."""
    legend = ax.get_legend()
    assert legend is not None
    return {
        text.get_text(): patch.get_facecolor() for text, patch in zip(legend.texts, legend.get_patches(), strict=True)
    }


def test_a_map_of_an_output_shows_overturned_and_unknown_cells_as_what_they_are(tmp_path: Path) -> None:
    cube = xr.Dataset(
        {
            "status": (("aspect_ratio", "pga"), np.array([[1, 2, 3], [4, 5, 6]], np.int8)),
            "peak_rotation": (("aspect_ratio", "pga"), [[0.0, 0.02, np.pi / 2], [np.nan, np.nan, np.nan]]),
        },
        {"aspect_ratio": [0.1, 0.2], "pga": [1.0, 2.0, 3.0]},
    )
    seen: list[Axes] = []

    def draw() -> Axes:
        seen.append(plot_output_map(cube, "peak_rotation"))
        return seen[-1]

    save_figure(draw, tmp_path / "map.png")
    legend = drawn_patches(seen[0])
    assert set(legend) == {"overturned", "outside the model", "not converged", "failed"}
    assert len(set(legend.values())) == 4
    values = seen[0].collections[0].get_array()
    assert values is not None
    # the colours span what stands, not pi/2
    assert float(np.ma.max(values)) == 0.02 and int(np.ma.count(values)) == 2
    curves = plot_slices(cube, "peak_rotation", "pga")
    assert {"overturned", "outside the model", "not converged"} <= {t.get_text() for t in curves.get_legend().texts}
    matplotlib.pyplot.close("all")


def test_a_smallest_intensity_hidden_by_an_unknown_cell_is_not_painted_as_standing() -> None:
    status = np.array([[[1, 1], [5, 3]], [[2, 3], [1, 3]]], np.int8)
    cube = xr.Dataset(
        {"status": (("aspect_ratio", "top_mass", "pga"), status)},
        {"aspect_ratio": [0.1, 0.2], "top_mass": [0.0, 1.0], "pga": [1.0, 2.0]},
    )
    for name, unit in (("aspect_ratio", "1"), ("top_mass", "kg"), ("pga", "m s-2")):
        cube[name].attrs["units"] = unit
    found = cube.rocking.overturning_map()
    np.testing.assert_array_equal(found["unknown"].values, [[False, False], [True, False]])
    np.testing.assert_array_equal(found.values, [[np.nan, 2.0], [np.nan, 2.0]])
    legend = drawn_patches(plot_overturning_map(cube))
    assert set(legend) == {"does not overturn up to 0.204 g", "unknown"}
    matplotlib.pyplot.close("all")


def test_an_axis_of_many_motions_shows_their_names() -> None:
    names = [f"record {k}" for k in range(12)]
    cube = xr.Dataset(
        {
            "status": (("motion", "pga"), np.full((12, 3), ROCKING, np.int8)),
            "peak_rotation": (("motion", "pga"), np.arange(36.0).reshape(12, 3)),
        },
        {"motion": names, "pga": ("pga", [1.0, 2.0, 3.0], {"units": "m s-2"})},
    )
    curves = plot_slices(cube, "peak_rotation", "pga")
    assert [text.get_text() for text in curves.figure.axes[1].get_yticklabels()] == names
    for drawn in (plot_output_map(cube, "peak_rotation"), plot_overturning_map(cube)):
        assert [text.get_text() for text in drawn.get_xticklabels()] == names
    matplotlib.pyplot.close("all")


def test_a_value_without_end_is_a_point_of_its_axis() -> None:
    """An effect that inf switches off: no scale has a place for it, so the points lie side by side."""
    cube = known_cube(np.random.default_rng(1), (3, 5, 6)).assign_coords(aspect_ratio=[0.2, 0.5, np.inf])
    cube["aspect_ratio"].attrs |= {"units": "1", "axis_of_study": "true"}
    points, words = positions(cube["aspect_ratio"])
    assert points.tolist() == [0.0, 1.0, 2.0] and words == ["0.2", "0.5", "inf"]
    assert position(cube, "aspect_ratio", "inf") == 2 and position(cube, "aspect_ratio", 0.5) == 1
    plot_overturning_map(cube, x="aspect_ratio", y="pga", at={"top_mass": float(cube["top_mass"][0])})
    plt.close("all")


def test_what_is_selected_is_no_axis_of_a_map_and_the_middle_is_that_of_the_values() -> None:
    cube = known_cube(np.random.default_rng(2))
    assert default_axes(cube, None, None, {"aspect_ratio": 0.1}) == ("top_mass", "pga")
    values = np.sort(cube["pga"].values)  # in the cube they are not sorted
    assert complete(cube, {}, ("aspect_ratio", "top_mass"))["pga"] == values[values.size // 2]
