"""What the pages on the rubber studies are made with: tables as files, and the uplift that a spectrum predicts."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial
from pathlib import Path

import numpy as np
import xarray as xr

from grids.motions.spectrum import response_spectrum
from grids.plan import read_plan
from study.status import OVERTURNED, ROCKING
from study.wording import GRAVITY

HERE = Path(__file__).parent
FIGURES, TABLES, STUDIES = HERE / "_static", HERE / "tables", HERE.parent / "studies"
HEAVY = {"top_mass": 5000.0, "damping_ratio": 0.0544}
"""The paper's mass and the damping ratio of its short wall."""
SHORT = {**HEAVY, "aspect_ratio": 0.4}
MODERATE = {"pga": 0.315 * GRAVITY}
SHAPE = ("aspect_ratio", "top_mass", "layer_modulus", "damping_ratio")


def table(head: Iterable[str], rows: Iterable[Iterable[object]]) -> str:
    lines = [list(head), *([str(cell) for cell in row] for row in rows)]
    lines.insert(1, ["---"] * len(lines[0]))
    return "\n".join(f"| {' | '.join(line)} |" for line in lines) + "\n"


def write(name: str, text: str) -> None:
    TABLES.mkdir(exist_ok=True)
    (TABLES / f"{name}.md").write_text(text)


def rigid_onset(cube: xr.Dataset) -> xr.DataArray:
    """g b/h_c, the acceleration at which the rigid wall begins to rock, h_c the height of its mass centre."""
    fixed = read_plan(STUDIES / "rubber_interface.toml").fixed
    height, top = fixed["wall_height"], cube["top_mass"]
    length = cube["aspect_ratio"] * height
    wall = fixed["wall_density"] * fixed["wall_thickness"] * length * height
    centre = (wall * height / 2 + top * (height + fixed["layer_thickness"] + fixed["top_height"] / 2)) / (wall + top)
    return GRAVITY * length / 2 / centre


def predicted_onset(cube: xr.Dataset) -> xr.DataArray:
    """PGA at which the first mode of the record's spectrum reaches the moment that lifts the base, W b/3.

    S_a(f_1, xi) = g b/(3 h_c), a third of `rigid_onset`.
    """
    (motion,) = read_plan(STUDIES / "rubber_interface.toml").motions
    periods = np.geomspace(0.02, 3.0, 150)
    shares = []
    for xi in cube["damping_ratio"].values:
        spectrum = response_spectrum(motion.horizontal, motion.time_step, periods, float(xi))
        shares.append(
            xr.apply_ufunc(partial(np.interp, xp=periods, fp=spectrum.pseudo_acceleration), 1 / cube["frequency_1"])
        )
    response = xr.concat(shares, "damping_ratio").assign_coords(damping_ratio=cube["damping_ratio"])
    return rigid_onset(cube) / 3 / (response / motion.pga)


def found_onset(cube: xr.Dataset) -> xr.DataArray:
    """Smallest PGA of the grid that lifts a joint; nan where it is the grid's first (the true one may lie below)."""
    lifts = cube["status"].isin((ROCKING, OVERTURNED))
    first = lifts.argmax("pga")
    return cube["pga"].isel(pga=first).where(lifts.any("pga") & (first > 0)).drop_vars("pga")


def spectrum_numbers(cube: xr.Dataset) -> list[str]:
    """Walls that lift above the lowest PGA, correlation with what the spectrum predicts, quantiles of their ratio."""
    found, predicted = found_onset(cube).transpose(*SHAPE), predicted_onset(cube).transpose(*SHAPE)
    both = np.isfinite(found.values)
    ratio = found.values[both] / predicted.values[both]
    correlation = np.corrcoef(np.log(found.values[both]), np.log(predicted.values[both]))[0, 1]
    quantiles = [f"{q:.2f}" for q in np.quantile(ratio, [0.05, 0.5, 0.95])]
    return [str(int(both.sum())), f"{correlation:.3f}", *quantiles]


def first_overturning(cube: xr.Dataset) -> xr.DataArray:
    """Smallest PGA of the grid that overturns a wall, in g; infinite where none does."""
    over = cube["status"] == OVERTURNED
    first = cube["pga"].isel(pga=over.argmax("pga")).drop_vars("pga") / GRAVITY
    return first.where(over.any("pga"), np.inf)


def median_over(values: xr.DataArray, kept: str, aspect: float) -> list[str]:
    """Median of the walls of one aspect ratio at each value of the axis ``kept``, those beyond the grid among them."""
    walls = values.sel(aspect_ratio=aspect, method="nearest").transpose(kept, ...)
    # of an even number the lower of the two in the middle, for the upper one may be infinite
    middle = np.quantile(walls.values.reshape(walls.sizes[kept], -1), 0.5, axis=1, method="lower")
    return [f"{v:.3g}" if np.isfinite(v) else "more" for v in middle]


def standing_again(cube: xr.Dataset) -> tuple[int, int]:
    """Walls that overturn at some PGA, and those of them that stand again at a higher one."""
    over = cube["status"] == OVERTURNED
    above = (over.cumsum("pga") > 0) & ~over
    return int(over.any("pga").sum()), int(above.any("pga").sum())
