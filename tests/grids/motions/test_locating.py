"""Which file a source of motion stands for: a pattern, a description beside a table."""

from __future__ import annotations

from pathlib import Path

import pytest

from grids.motions import find, read_motion
from models.errors import InputError


def test_a_pattern_that_names_nothing_stands_for_files_of_the_user(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("ROCKING_DATA", str(tmp_path / "data"))
    (tmp_path / "data").mkdir()
    (tmp_path / "plan").mkdir()
    for place in ("data/a.csv", "data/b.csv"):
        (tmp_path / place).touch()
    monkeypatch.chdir(tmp_path / "plan")
    assert len(find("[ab].csv", near=tmp_path / "data")) == len(find("../data/*.csv")) == 2
    for pattern in ("*.csv", "*.nc", "./*.nc", "././*.csv"):
        with pytest.raises(InputError, match="nothing matches beside the file that names it"):
            find(pattern)


def test_a_description_is_no_motion(tmp_path: Path) -> None:
    (tmp_path / "a.toml").touch()
    with pytest.raises(InputError, match=r"a\.toml: a TOML file holds no samples; name the table .* \(\.csv\)"):
        read_motion(str(tmp_path / "a.toml"))
