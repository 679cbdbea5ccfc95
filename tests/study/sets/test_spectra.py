"""Overturning acceleration spectra of pulses against the closed forms of the linear block."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pytest
import xarray as xr
from scipy.optimize import brentq

from grids.plan import parse_plan
from models.errors import InputError
from study.figures import plot_overturning_spectrum, plot_rocking_spectrum
from study.open import open_study
from study.run import run
from study.sets.spectra import overturning_spectrum, rocking_spectrum, three_curves

PULSE = """
[study]
name = "{shape}"
model = "housner"
[motion]
pulse = {{ shape = "{shape}", amplitude = "1 g", frequency = "2 Hz" }}
[parameters]
aspect_ratio = 0.2
mass = 1000
restitution = 0.9
[options]
formulation = "linear"
[axes]
height = {{ geomspace = [0.8, 12, 5] }}
pga = {{ geomspace = [0.15, 3.0, 120], unit = "g" }}
[outputs]
names = ["overturned", "peak_rotation_ratio"]
"""


def half_sine(w: float) -> Callable[[float], float]:
    """w sin(psi) - cos(psi) = exp(-(pi - psi)/w), psi = asin(1/A), A in alpha g."""

    def residual(a: float) -> float:
        psi = np.arcsin(1 / a)
        return float(w * np.sin(psi) - np.cos(psi) - np.exp(-(np.pi - psi) / w))

    return residual


def full_sine(w: float) -> Callable[[float], float]:
    """cos(psi) - w sin(psi) = exp(-(2 pi - psi)/w), without impact (Zhang and Makris 2001)."""

    def residual(a: float) -> float:
        psi = np.arcsin(1 / a)
        return float(np.cos(psi) - w * np.sin(psi) - np.exp(-(2 * np.pi - psi) / w))

    return residual


@pytest.fixture(scope="module")
def cubes(tmp_path_factory: pytest.TempPathFactory) -> dict[str, xr.Dataset]:
    home = tmp_path_factory.mktemp("pulses")
    plans = [parse_plan(PULSE.format(shape=shape), Path.cwd()) for shape in ("half_sine", "sine")]
    return {plan.name: open_study(run(plan, results=home, scheduler="synchronous").folder) for plan in plans}


def closed(equation: Callable[[float], Callable[[float], float]], cube: xr.Dataset) -> np.ndarray:
    """PGA over onset acceleration at each p; the linear block's unit is alpha g."""
    unit = (cube["alpha"] * 9.80665 / cube["onset_acceleration"]).values
    ratios = [brentq(equation(4.0 * np.pi / p), 1 + 1e-9, 60.0) for p in cube["frequency_parameter"].values]
    return np.asarray(ratios * unit)


def test_half_sine(cubes: dict[str, xr.Dataset]) -> None:
    """At every p the closed form lies in the step of the grid that ends in the smallest ratio that overturns."""
    found = overturning_spectrum(cubes["half_sine"])
    exact, step = closed(half_sine, cubes["half_sine"]), 20.0 ** (1 / 119)
    smallest = found["smallest"].values[0]
    assert np.all((exact <= smallest * (1 + 1e-4)) & (smallest <= exact * step * (1 + 1e-4)))
    assert (found["overturns"].isel(motion=0) == (found["onset_ratio"] >= smallest[:, None])).all()


def test_full_sine(cubes: dict[str, xr.Dataset]) -> None:
    """Without impact it overturns from the closed form on, at every p; after one impact already below, with a gap."""
    cube = cubes["sine"]
    found = overturning_spectrum(cube)
    exact = closed(full_sine, cube)[:, None]
    overturns, ratio = found["overturns"].values[0] == 1.0, found["onset_ratio"].values
    assert overturns[ratio >= exact * (1 + 1e-4)].all()
    assert (found["smallest"].values[0] < 0.8 * exact[:, 0]).any(), "after one impact"
    island = overturns & (ratio < exact)
    gap = ~overturns & (ratio < exact) & (np.cumsum(island, axis=1) > 0)
    assert gap.any(), "a safe band between both ways of overturning (Zhang and Makris 2001)"


def test_rocking_spectrum_is_the_cube_in_another_order(cubes: dict[str, xr.Dataset]) -> None:
    cube = cubes["half_sine"]
    pga = float(cube["pga"][30])
    found = rocking_spectrum(cube, {"pga": pga})
    row = found["peak_rotation_ratio"].values[0]
    stands = cube["overturned"].sel(pga=pga).values == 0
    np.testing.assert_array_equal(row[stands], cube["peak_rotation_ratio"].sel(pga=pga).values[stands])
    assert np.isinf(row[~stands]).all()
    np.testing.assert_allclose(found["period_parameter"] * found["frequency_parameter"], 2 * np.pi)


def test_three_curves_are_the_limits_of_short_pulses() -> None:
    """A half-sine so short that gravity has no time overturns from 1/(p t_I) on, t_I = PGV/PGA = 2/omega."""
    p = xr.DataArray(np.array([1e-3, 1e-2]), dims="p")
    omega = 4 * np.pi
    curves = three_curves(p, xr.DataArray(2 / omega), xr.DataArray(1.0))
    exact = [brentq(half_sine(omega / value), 1 + 1e-9, 1e6) for value in p.values]
    np.testing.assert_allclose(curves["without impact"], exact, rtol=3e-3)
    assert (curves["no rocking"] == 1.0).all()


def test_figures_and_refusals(cubes: dict[str, xr.Dataset]) -> None:
    cube = cubes["half_sine"]
    ax = plot_overturning_spectrum(overturning_spectrum(cube))
    assert ax.get_xlabel() == "p [s⁻¹]" and ax.get_xscale() == "log"
    plot_rocking_spectrum(rocking_spectrum(cube, {"pga": float(cube["pga"][30])}))
    plt.close("all")
    with pytest.raises(InputError, match="axis pga"):
        overturning_spectrum(cube.isel(pga=3))
    with pytest.raises(InputError, match="along one axis"):
        overturning_spectrum(cube.isel(height=[2]))


def test_curves_of_a_stretched_motion_are_those_of_the_motion_as_it_shook(cubes: dict[str, xr.Dataset]) -> None:
    plain, slow = (overturning_spectrum(cubes["sine"].assign_coords(time_scale=scale)) for scale in (1.0, 2.0))
    for time in ("t_impulse", "t_moment"):
        np.testing.assert_allclose(slow[time], 2.0 * plain[time])


def test_a_motion_that_cases_set_is_refused(cubes: dict[str, xr.Dataset]) -> None:
    with pytest.raises(InputError, match="changes along 'height'"):
        overturning_spectrum(cubes["sine"].assign_coords(motion=("height", ["a", "a", "b", "b", "b"])))
