"""Figures show their data: what is drawn is what was given, thinned without losing extremes."""

from __future__ import annotations

import re
from functools import partial

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.patches import PathPatch

from diagnosis.answer.result import Screened
from diagnosis.report.figures import (
    plot_before_after,
    plot_fits,
    plot_missing_force,
    plot_parameters,
    plot_raster,
    plot_suspects,
)
from diagnosis.report.figures.curve import MOST_POINTS, thin
from diagnosis.report.figures.levels import BORDERS, DEPTHS, level_of
from diagnosis.report.figures.phase_plane import noise_of_trace
from diagnosis.report.figures.suspects import MOST
from diagnosis.report.svg import picture, relative
from tests.diagnosis.report.example import FORCE, SIGMA, diagnosis, specimen


@given(st.integers(10, 20_000), st.integers(0, 1000), st.booleans())
def test_thinned_curves_keep_extremes_order_and_gaps(size: int, seed: int, narrow: bool) -> None:
    rng = np.random.default_rng(seed)
    time, values = np.arange(float(size)), rng.normal(size=size)
    values[size // 3 : size // 2] = np.nan
    fewer, kept = thin(time, values, narrow)
    assert fewer.size <= MOST_POINTS[narrow] + 2
    assert np.all(np.diff(fewer) >= 0.0)
    assert np.nanmax(kept) == np.nanmax(values) and np.nanmin(kept) == np.nanmin(values)
    np.testing.assert_array_equal(kept, values[fewer.astype(int)])


def test_levels_part_at_their_borders() -> None:
    assert level_of(0.0) == 0 and level_of(1e9) == len(DEPTHS) - 1
    assert [int(level_of(border)) for border in BORDERS] == list(range(1, len(DEPTHS)))


def test_raster_draws_a_cell_for_every_window_before_and_after() -> None:
    found = diagnosis()
    for ax, strip in zip(plot_raster(found.windows, found.shows), found.windows, strict=True):
        drawn = sum(len(p.get_path().vertices) // 5 for p in ax.patches if isinstance(p, PathPatch))
        assert drawn == 2 * strip.start.size


def test_noise_is_read_from_windows() -> None:
    found = diagnosis()
    for trace in found.traces:
        assert noise_of_trace(trace, found.windows) == pytest.approx(SIGMA, rel=1e-6)


def test_suspects_are_in_order_and_the_found_one_bold() -> None:
    found = diagnosis()
    ax = plot_suspects(found.screen, found.null_band, evidence={"pivot_inset": 1480.0})
    names = [text.get_text() for text in ax.get_yticklabels()]
    assert names[:2] == ["pivot inset", "rounded corner"]
    bold = [text.get_text() for text in ax.get_yticklabels() if text.get_fontweight() == "bold"]
    assert bold == ["pivot inset"]


def test_what_was_found_and_its_rivals_are_among_the_suspects_however_weak_alone() -> None:
    strong = [Screened(f"other_{k}", "other", 100.0 - k, None, None) for k in range(20)]
    weak = [Screened(name, name, 1.0, None, None) for name in ("tilt", "delay", "clock")]
    ax = plot_suspects([*strong, *weak], 8.0, evidence={"tilt": 500.0, "other_3": 90.0}, rivals=("delay",))
    names = [text.get_text() for text in ax.get_yticklabels()]
    assert len(names) == MOST and names[-2:] == ["tilt", "delay"] and names[0] == "other 0"


def test_fits_draw_before_after_and_noise() -> None:
    found = diagnosis()
    ax = plot_fits(found.train, found.holdout)
    drawn = {round(float(line.get_xdata()[0]), 6) for line in ax.lines if len(line.get_xdata()) == 1}
    assert {18.7, 2.9, 2.7, 21.4, 3.1, 2.8} <= drawn


def test_before_after_has_a_panel_from_rest_only_where_there_is_one() -> None:
    train, test = diagnosis().traces[0], diagnosis().traces[-1]
    assert len(plot_before_after(train)) == 2 and len(plot_before_after(test)) == 3


def test_parameters_are_drawn_in_percent_of_nominal() -> None:
    ax = plot_parameters(diagnosis().base, specimen().parameters, specimen().tolerance)
    middle = {round(float(x), 4) for line in ax.lines for x in np.atleast_1d(line.get_xdata())}
    assert round(100 * (0.2501 / 0.25 - 1), 4) in middle


def test_numbers_and_depths_survive_the_way_to_the_page() -> None:
    force = picture(partial(plot_missing_force, FORCE), "force")
    ticks = [float(t.replace("−", "-")) for t in re.findall(r">(−?[\d.]+)</text>", force.wide)]
    assert max(t for t in ticks if t < 1.0) == pytest.approx(0.02, abs=0.0011)
    found = picture(partial(plot_raster, diagnosis().windows), "raster")
    drawn = {float(depth) for depth in re.findall(r"(?<!-)opacity: ([\d.]+)", found.wide)}
    assert drawn - {0.0} == set(DEPTHS) - {1.0}


def test_the_legend_stands_where_all_curves_are() -> None:
    """A force on the upper block has no curve of the nearest mechanism."""
    (term, *rest) = FORCE["terms"]
    first, second, *_ = plot_missing_force({**FORCE, "terms": [{**term, "nearest": None}, term, *rest]})
    assert first.get_legend() is None and second.get_legend() is not None
    assert "added stiffness" in [text.get_text() for text in second.get_legend().get_texts()]


points = st.lists(st.tuples(st.integers(-9999, 9999), st.integers(-9999, 9999)), min_size=2, max_size=30)


@given(points)
def test_steps_lead_where_the_points_were(chosen: list[tuple[int, int]]) -> None:
    path = "M " + "\nL ".join(f"{x / 10} {y / 10}" for x, y in chosen)
    short = relative(path)
    head, _, rest = short.removeprefix("M").partition("l")
    at, steps = _numbers(head), _numbers(rest).reshape(-1, 2)
    reached = np.vstack([at, at + np.cumsum(steps, axis=0)])
    np.testing.assert_allclose(reached, np.array(chosen) / 10, atol=1e-6)


def _numbers(text: str) -> np.ndarray:
    return np.array([float(v) for v in text.replace("-", " -").split()])
