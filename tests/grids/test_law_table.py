"""A law in a table: what is written reads back, means the law it stands for, and what cannot be read is said."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import models
from grids.law_table import LAW_FILE, law_text, read_law
from grids.specimen import read_specimen
from grids.write_specimen import specimen_text
from models.errors import InputError
from models.mechanisms.table_force import MECHANISM, OF_WALL, ON_WALL, TABLES
from models.shaking import Shaking
from models.tables import KNOTS, SIDES, row
from rocking import simulate

BLOCK = {"width": 0.25, "height": 1.1, "mass": 120.0}
REACH = 0.08
LAW = MECHANISM.nulls | {"reach_rotation": REACH, "reach_rate": 1.0}
HEAD = """title = "t"
model = "housner"
[parameters]
width = 0.25
height = 1.1
mass = 120.0
[initial]
rotation_1 = 0.07
[mechanisms.table_force]
"""
OF_A_WALL = """title = "w"
model = "interface"
[parameters]
wall_length = 0.72
wall_height = 1.8
wall_mass = 161.0
wall_thickness = 0.138
top_mass = 5000.0
top_length = 0.72
top_height = 0.6
layer_thickness = 0.01
layer_modulus = 4.5e6
damping_ratio = 0.05
gravity = 9.81
[initial]
rotation_1 = 0.002
rotation_2 = 0.002
"""


def linear(term: str, slope: float, reach: float) -> dict[str, float]:
    """A table of ``slope`` times its variable."""
    signs = dict(zip(SIDES, (-1.0, 1.0), strict=True))
    at = np.linspace(0.0, reach, KNOTS)
    return LAW | {row(term, side, k): slope * signs[side] * at[k] for side in SIDES for k in range(KNOTS)}


def rocked(law: dict[str, float]) -> np.ndarray:
    quiet = Shaking(0.005, np.zeros(301))
    values = {**BLOCK, **{f"table_force.{name}": value for name, value in law.items()}}
    return (
        models.get("housner").simulate(values, quiet, initial={"rotation_1": 0.07}, duration=1.5).channels["rotation_1"]
    )


def test_a_table_of_the_rate_is_a_dashpot() -> None:
    quiet = Shaking(0.005, np.zeros(301))
    dashpot = models.get("housner").simulate(
        {**BLOCK, "viscous_damping.rate": 0.4}, quiet, initial={"rotation_1": 0.07}, duration=1.5
    )
    np.testing.assert_allclose(rocked(linear("rate", -0.4, 1.0)), dashpot.channels["rotation_1"], atol=1e-9)
    constant = LAW | {row("damping", side, k): -0.4 for side in SIDES for k in range(KNOTS)}
    np.testing.assert_allclose(rocked(constant), dashpot.channels["rotation_1"], atol=1e-9)


def test_a_table_at_impacts_is_a_factor_on_the_restitution() -> None:
    quiet = Shaking(0.005, np.zeros(301))
    worn = models.get("housner").simulate(
        {**BLOCK, "restitution.factor_on_housner": 0.9}, quiet, initial={"rotation_1": 0.07}, duration=1.5
    )
    law = LAW | {row("impact", side, k): -0.1 for side in SIDES for k in range(KNOTS)}
    np.testing.assert_allclose(rocked(law), worn.channels["rotation_1"], atol=1e-9)


def test_a_law_reads_back_and_every_command_takes_it(tmp_path: Path) -> None:
    law = linear("rotation", 0.7, REACH) | {row("impact", side, k): -0.02 * k for side in SIDES for k in range(KNOTS)}
    (tmp_path / LAW_FILE).write_text(law_text(law, TABLES))
    (tmp_path / "s.toml").write_text(HEAD + f'file = "{LAW_FILE}"\n')
    specimen = read_specimen(tmp_path / "s.toml")
    assert specimen.mechanisms["table_force"] == pytest.approx(law)
    (tmp_path / "again.toml").write_text(specimen_text(specimen))
    assert read_specimen(tmp_path / "again.toml") == specimen
    history = simulate(specimen, duration=1.5)
    np.testing.assert_allclose(history["rotation_1"][::5], rocked(law), atol=1e-7)


def test_a_law_of_a_wall_reads_back_and_is_simulated(tmp_path: Path) -> None:
    """A table of the wall's angular velocity is the dashpot that it stands for."""
    at, reach = np.linspace(0.0, 1.0, KNOTS), 0.5
    mass, half, couple = 5161.0, 0.36, 9000.0
    law = OF_WALL.nulls | {
        row("rate_base", side, k): sign * at[k] * reach * couple / (mass * 9.81 * half)
        for side, sign in zip(SIDES, (1.0, -1.0), strict=True)
        for k in range(KNOTS)
    }
    law["reach_rate_base"] = reach
    (tmp_path / LAW_FILE).write_text(law_text(law, ON_WALL))
    assert read_law(tmp_path / LAW_FILE, ON_WALL) == pytest.approx(law)
    with pytest.raises(InputError, match="rate_base"):
        read_law(tmp_path / LAW_FILE, TABLES)
    file = tmp_path / "s.toml"
    file.write_text(OF_A_WALL + f'[mechanisms.table_force]\nfile = "{LAW_FILE}"\n')
    specimen = read_specimen(file)
    found = simulate(specimen, duration=0.5)
    file.write_text(OF_A_WALL + f"[mechanisms.viscous_damping]\ncouple_damping = {couple}\n")
    dashpot = simulate(read_specimen(file), duration=0.5)
    np.testing.assert_allclose(found["rotation_1"], dashpot["rotation_1"], rtol=0, atol=2e-8)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("at,value\n", "the first line must be term,at,value"),
        ("term,at,value\nrotatoin,0,1\n", "rotation"),
        ("term,at,value\nrotation,0,many\n", "line 2: 'many' is no finite number"),
        ("term,at,value\nrotation,0.1,1\n", "give 12 rows"),
        ("term,at,value\nrotation\n", "1 columns"),
    ],
)
def test_what_is_wrong_with_a_table_is_said(tmp_path: Path, text: str, sentence: str) -> None:
    (tmp_path / "law.csv").write_text(text)
    with pytest.raises(InputError, match=sentence):
        read_law(tmp_path / "law.csv", TABLES)


def test_a_specimen_names_the_file_alone(tmp_path: Path) -> None:
    (tmp_path / "s.toml").write_text(HEAD + "rotation_above_1 = 0.1\n")
    with pytest.raises(InputError, match=r'give file = "law.csv"'):
        read_specimen(tmp_path / "s.toml")
    (tmp_path / "s.toml").write_text(HEAD + 'file = "nowhere.csv"\n')
    with pytest.raises(InputError, match="nowhere"):
        read_specimen(tmp_path / "s.toml")
