"""The oscillator that the base drives: exact for straight lines, its limits, and the same by both integrators."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from grids.law_table import LAW_FILE, law_text
from grids.specimen import Specimen, read_specimen
from grids.write_specimen import specimen_text
from models.base import FloatArray
from models.errors import InputError
from models.mechanisms.table_force import TABLES
from models.oscillator import acceleration, felt
from models.piecewise import begun_at
from models.pitch import pitch
from models.runs import Request
from models.shaking import Shaking
from tests.models.mechanisms.cases import HOUSNER, WALL, by_lanes, by_reference, pulse

STEP = 0.01


def base() -> FloatArray:
    return np.concatenate([[0.0], np.cumsum(np.random.default_rng(3).normal(size=300)) * 0.3])


def test_it_is_that_of_the_differential_equation() -> None:
    a, omega, zeta = base(), 2.0 * np.pi * 3.0, 0.05
    time = STEP * np.arange(a.size)

    def slope(t: float, y: FloatArray) -> list[float]:
        return [y[1], -(omega**2) * y[0] - 2.0 * zeta * omega * y[1] - float(np.interp(t, time, a))]

    y = np.zeros(2)
    expected = [0.0]
    for start in time[:-1]:  # from corner to corner of the straight lines
        y = solve_ivp(slope, (start, start + STEP), y, rtol=1e-10, atol=1e-13).y[:, -1]
        expected.append(-(omega**2) * y[0] - 2.0 * zeta * omega * y[1])
    np.testing.assert_allclose(acceleration(a, STEP, 3.0, zeta), expected, atol=1e-6 * np.abs(expected).max())


def test_a_stiff_one_moves_with_the_base_and_a_soft_one_stays_behind() -> None:
    a = np.sin(2.0 * np.pi * 1.0 * STEP * np.arange(600))
    stiff, soft = acceleration(a, STEP, 40.0, 0.05), acceleration(a, STEP, 0.02, 0.05)
    assert np.max(np.abs(stiff[100:] - a[100:])) < 2e-3
    assert np.max(np.abs(soft)) < 0.02


def test_without_gains_the_motion_is_the_same_object() -> None:
    shaking = Shaking(STEP, base())
    assert felt(shaking, 0.0, 0.0, 2.0, 0.05) is shaking
    both = felt(shaking, 0.3, -0.2, 2.0, 0.05).horizontal
    total = acceleration(shaking.horizontal, STEP, 2.0, 0.05)
    np.testing.assert_allclose(both, shaking.horizontal + 0.3 * (total - shaking.horizontal) - 0.2 * total)


def test_a_motion_that_was_cut_goes_on_as_it_was_felt_and_so_does_the_pitch_of_the_table_under_it() -> None:
    whole, first = Shaking(STEP, base()), 120
    cut = begun_at(whole, first)
    alone, after = felt(whole, 0.3, -0.2, 2.0, 0.05), felt(cut, 0.3, -0.2, 2.0, 0.05)
    np.testing.assert_allclose(after.horizontal, alone.horizontal[first:], atol=1e-12)
    for once, later in zip(pitch(alone, 3.0), pitch(after, 3.0), strict=True):
        np.testing.assert_allclose(later, once[first:], atol=1e-10 * np.abs(once).max())


@pytest.mark.parametrize("gain", ["motion", "force"])
def test_lanes_and_reference_agree_under_it(gain: str) -> None:
    values = {
        **WALL, f"table_force.oscillator_{gain}": 0.2, "table_force.oscillator_frequency": 2.5,
        "table_force.oscillator_damping": 0.04,
    }  # fmt: skip
    shaking = pulse(4.0, 0.5, rest=1.6)
    fast, slow = by_lanes(values, shaking, {}), by_reference(values, shaking, {})
    plain = by_lanes(WALL, shaking, {})
    peak = float(slow.outputs["peak_rotation"])
    np.testing.assert_allclose(fast.rotation, slow.rotation, rtol=0.0, atol=2e-7 * peak)
    assert abs(peak / float(plain.outputs["peak_rotation"]) - 1.0) > 0.05


def test_lanes_with_and_without_one_run_together() -> None:
    shaking, with_it = pulse(4.0, 0.5), {"table_force.oscillator_motion": 0.2}
    gains = np.array([0.0, 0.2, 0.0])
    block = HOUSNER.build({k: np.full(3, v) for k, v in WALL.items()} | {"table_force.oscillator_motion": gains})
    together = HOUSNER.run("lanes", block, Request(shaking, np.ones(3), tail=2.0)).outputs["peak_rotation"]
    alone = [by_lanes({**WALL, **more}, shaking, {}).outputs["peak_rotation"] for more in ({}, with_it)]
    np.testing.assert_allclose(together, np.ravel([alone[0], alone[1], alone[0]]), rtol=1e-6)


def test_it_stands_in_a_specimen_beside_its_law(tmp_path: Path) -> None:
    law = {"oscillator_motion": 0.14, "oscillator_force": 0.0, "oscillator_frequency": 4.3, "oscillator_damping": 0.05}
    values = HOUSNER.mechanisms["table_force"].nulls | law
    specimen = Specimen("a block", "housner", dict(WALL), mechanisms={"table_force": values})
    (tmp_path / LAW_FILE).write_text(law_text(values, TABLES), encoding="utf-8")
    (tmp_path / "block.toml").write_text(specimen_text(specimen), encoding="utf-8")
    found = read_specimen(tmp_path / "block.toml").mechanisms["table_force"]
    assert {name: found[name] for name in law} == law
    wrong = specimen_text(specimen).replace("oscillator_force", "oscillator_push")
    (tmp_path / "block.toml").write_text(wrong, encoding="utf-8")
    with pytest.raises(InputError, match=r"oscillator_push.*oscillator_motion, oscillator_force"):
        read_specimen(tmp_path / "block.toml")
