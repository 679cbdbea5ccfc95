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


@pytest.mark.parametrize(
    ("stated", "mark", "cure"), [(",", ";", ";"), (",", "\t", r"\\t"), (";", ",", ","), ("\t", " ", " ")]
)
def test_another_delimiter_is_told(stated: str, mark: str, cure: str, written: Callable[[str, str], Path]) -> None:
    written("test_4.toml", TOML.replace("[columns]", f"delimiter = '{stated}'\n[columns]"))
    with pytest.raises(InputError, match=f'line 201 is one cell by the delimiter .*; state delimiter = "{cure}"'):
        read_recording(written("test_4.csv", "\n".join([f"acc{mark}inc", *(mark.join(row) for row in VALUES)])))


def test_a_line_below_the_table_says_nothing_of_its_delimiter(written: Callable[[str, str], Path]) -> None:
    written("test_4.toml", TOML)
    with pytest.raises(InputError, match=r"line 402.*(column|not a number)"):
        read_recording(written("test_4.csv", "\n".join(["acc,inc", *map(",".join, VALUES), "end of record"])))


def test_a_turned_sign_is_no_channel(written: Callable[[str, str], Path]) -> None:
    written(
        "test_4.toml",
        TOML.replace("base_acceleration_x", "rotation_2")
        .replace("m/s2", "rad")
        .replace('"rad" }', '"rad", sign = -1 }'),
    )
    with pytest.raises(InputError, match=r"no base_acceleration_x \(found: rotation_2, rotation_1\)"):
        read_recording(written("test_4.csv", "\n".join(["acc,inc", *map(",".join, VALUES)])))


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


def test_an_empty_cell_between_white_space_is_told_from_the_next_one(written: Callable[[str, str], Path]) -> None:
    """A row that lacks a cell would give its rotation to the base."""
    written("test_4.toml", TOML.replace("[columns]", 'delimiter = " "\n[columns]'))
    rows = [f"{a} {r} 0.5" for a, r in VALUES]
    rows[7] = f"{VALUES[7][1]} 0.5"
    with pytest.raises(InputError, match=r"line 9 has 2 cells, line 1 3; write nan where nothing was measured"):
        read_recording(written("test_4.csv", "\n".join(["acc inc x", *rows])))
    rows[7] = f"{VALUES[7][0]} {VALUES[7][1]} nan"
    assert read_recording(written("test_4.csv", "\n".join(["acc inc x", *rows]))).time.size == len(VALUES)


def test_a_row_of_units_is_named_as_one(written: Callable[[str, str], Path]) -> None:
    written("test_4.toml", TOML)
    rows = [f"{a},{r}" for a, r in VALUES]
    with pytest.raises(InputError, match=r"line 2 holds no number \(m/s2, rad\); .* skip = 2 with header = false"):
        read_recording(written("test_4.csv", "\n".join(["acc,inc", "m/s2,rad", *rows])))
    by_number = (
        TOML.replace('"acc"', "1").replace('"inc"', "2").replace("[columns]", "skip = 2\nheader = false\n[columns]")
    )
    written("test_4.toml", by_number)
    table = "\n".join(["acc,inc", "m/s2,rad", *rows])
    assert read_recording(written("test_4.csv", table)).time.size == len(VALUES)


def test_a_sampling_rate_that_changes_is_told_from_lost_samples(written: Callable[[str, str], Path]) -> None:
    written("test_4.toml", TOML.replace('time_step = "5 ms"', 'time = { column = "t", unit = "s" }'))

    def read(times: np.ndarray) -> None:
        rows = [f"{t:.6f},{a},{r}" for t, (a, r) in zip(times, VALUES, strict=True)]
        read_recording(written("test_4.csv", "\n".join(["t,acc,inc", *rows])))

    for change, first, second in ((250, 0.005, 0.01), (100, 0.005, 0.01), (250, 0.01, 0.005), (100, 0.01, 0.005)):
        steps = np.where(np.arange(len(VALUES)) < change, first, second)
        at = f"{change * first:.6g} s"
        with pytest.raises(InputError, match=rf"the step changes from {first} s to {second} s at {at}: split"):
            read(np.cumsum(steps))
    steps = np.where(np.arange(len(VALUES)) == 250, 0.015, 0.005)
    with pytest.raises(InputError, match=r"about 2 sample\(s\) are missing"):
        read(np.cumsum(steps))


@pytest.mark.parametrize(("unit", "factor"), [("1e-3 g", 9.80665e-3), ("gal", 0.01), ("GAL", 0.01), ("cm/s2", 0.01)])
def test_a_recording_knows_the_units_that_a_motion_knows(
    unit: str, factor: float, written: Callable[[str, str], Path]
) -> None:
    written("test_4.toml", TOML.replace("m/s2", unit))
    found = read_recording(written("test_4.csv", "\n".join(["acc,inc", *(f"{a},{r}" for a, r in VALUES)])))
    assert found.channels["base_acceleration_x"][3] == pytest.approx(factor * float(VALUES[3][0]))
