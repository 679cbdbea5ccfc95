"""Tables that are not what their description says: rows, keys, a folder in place of a file."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from grids.recordings import read_recording
from models.errors import InputError

TOML = """
time_step = "5 ms"
[columns]
base_acceleration_x = { column = "acc", unit = "m/s2" }
rotation_1 = { column = "inc", unit = "rad" }
"""
TIME = 0.005 * np.arange(400)
VALUES = [(f"{a:.5f}", f"{r:.6f}") for a, r in zip(np.sin(9.0 * TIME), 0.1 * np.sin(5.0 * TIME), strict=True)]


@pytest.mark.parametrize(
    "rows",
    [
        [",".join(cell.replace(".", ",") for cell in row) for row in VALUES],
        [f"{k},{a},{r}" for k, (a, r) in enumerate(VALUES)],
    ],
    ids=["decimal comma", "indices"],
)
def test_a_row_with_more_cells_than_the_header_is_refused(rows: list[str], written: Callable[[str, str], Path]) -> None:
    """A decimal comma where the comma delimits, or a column of indices without a name, shifts the columns."""
    written("test_4.toml", TOML)
    with pytest.raises(InputError, match=r"line 2 has \d cells, the header 2; state decimal = ',' and the delim"):
        read_recording(written("test_4.csv", "\n".join(["acc,inc", *rows])))


def test_a_comma_at_the_end_of_each_row_is_no_cell(written: Callable[[str, str], Path]) -> None:
    written("test_4.toml", TOML)
    table = "\n".join(["acc,inc", *(f"{a},{r}," for a, r in VALUES)])
    assert "rotation_1" in read_recording(written("test_4.csv", table)).channels


def test_a_misspelt_key_of_a_column_is_told_with_the_right_one(written: Callable[[str, str], Path]) -> None:
    written("test_4.toml", TOML.replace('column = "acc"', 'colum = "acc"'))
    with pytest.raises(InputError, match=r"base_acceleration_x colum is not known; did you mean 'column'"):
        read_recording(written("test_4.csv", "acc,inc\n0,0\n"))


def test_a_folder_is_no_recording(tmp_path: Path) -> None:
    (tmp_path / "shake.csv").mkdir()
    with pytest.raises(InputError, match=r"shake.csv is a folder; name a file in it"):
        read_recording(tmp_path / "shake.csv")
