"""Tables of outcomes: what is read, and one sentence for whatever is wrong."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from grids.recordings.outcomes import read_outcomes
from models.errors import InputError

TABLE = "test,motion,fell\n1,a,0\n12,a,yes\n3,b,No\n"
DESCRIPTION = """table = "tests.csv"
run = "test"
motion = "shaking.npz:run_{test:0>3}"
overturned = "fell"
group = "motion"
[statement]
time_step = "0.01 s"
unit = "cm/s2"
"""


def written(folder: Path, table: str = TABLE, description: str = DESCRIPTION) -> Path:
    (folder / "tests.csv").write_text(table)
    (folder / "runs.toml").write_text(description)
    arrays = {f"run_{k:03d}": np.full(20, float(k)) for k in (1, 3, 12)}
    np.savez(folder / "shaking.npz", **arrays)  # type: ignore[arg-type]
    return folder / "runs.toml"


def test_runs_motions_groups_and_outcomes_belong_together(tmp_path: Path) -> None:
    found = read_outcomes(written(tmp_path))
    assert found.runs == ("1", "12", "3")
    assert found.groups == ("a", "a", "b")
    assert found.overturned is not None and found.overturned.tolist() == [False, True, False]
    np.testing.assert_allclose([motion.pga for motion in found.motions], [0.01, 0.12, 0.03])
    assert found.motions[0].time_step == 0.01


def test_cells_may_be_parted_by_another_delimiter(tmp_path: Path) -> None:
    path = written(tmp_path, TABLE.replace(",", ";"), 'delimiter = ";"\n' + DESCRIPTION)
    assert read_outcomes(path).runs == ("1", "12", "3")


def test_outcomes_may_be_unknown_and_every_run_its_own_group(tmp_path: Path) -> None:
    plain = DESCRIPTION.replace('overturned = "fell"\n', "").replace('group = "motion"\n', "")
    found = read_outcomes(written(tmp_path, description=plain))
    assert found.overturned is None
    assert found.groups == found.runs


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('"fell"', '"fall"', "did you mean 'fell'"),
        ('"motion"\n', '"motions"\n', "did you mean 'motion'"),
        ("{test:0>3}", "{tst}", "which is no column"),
        ("{test:0>3}", "{test.__class__}", "which is no column"),
        ("{test:0>3}", "{test:0>999999999}", "is no layout"),
        ("{test:0>3}", "{test", "is no template"),
        ("{test:0>3}", "{test}", "run '1'"),
        ("{test:0>3}", "001", "no column in braces"),
        ("tests.csv", "test.csv", "does not exist"),
        ("[statement]", "[statements]", "statements"),
        ('time_step = "0.01 s"', "", "what is stated of shaking.npz: time_step is missing"),
    ],
)
def test_a_slip_in_the_description_is_named(tmp_path: Path, old: str, new: str, said: str) -> None:
    with pytest.raises(InputError, match=said.replace(".", r"\.")):
        read_outcomes(written(tmp_path, description=DESCRIPTION.replace(old, new)))


@pytest.mark.parametrize(
    ("table", "said"),
    [
        ("test,motion,fell\n1,a,0\n1,b,1\n", "stands there twice"),
        ("test,motion,fell\n1,a,maybe\n", "'maybe'"),
        ("test,motion,fell\n1,a\n", "line 2 has not as many cells"),
        ("test,motion,fell\n1,a,0,7\n", "line 2 has not as many cells"),
        ("test,motion,fell\n", "no line below its header"),
        ("", "no line below its header"),
        ('test,motion,fell\n1,"a,0\n', "is no table"),
        ("test,motion,fell\n,a,0\n", "line 2 has an empty cell in column 'test'"),
        ("test,motion,fell\n1,a,0\n12, ,1\n", "line 3 has an empty cell in column 'motion'"),
        ("test,motion,fell\n\n\n1,a\n", "line 4 has not as many cells"),
        ("test,motion,fell\n\n1,a,0\n12, ,1\n", "line 4 has an empty cell in column 'motion'"),
        ("test;motion;fell\n1;a;0\n", 'state delimiter = ";"'),
        ("test\tmotion\tfell\n1\ta\t0\n", r'state delimiter = "\\t"'),
        ("test,motion,fell,fell\n1,a,0,1\n", "two columns are called 'fell'; rename one"),
        (",test,motion,fell\n0,1,a,0\n", r"column 1 has no name.*index"),
    ],
)
def test_a_slip_in_the_table_is_named(tmp_path: Path, table: str, said: str) -> None:
    with pytest.raises(InputError, match=said):
        read_outcomes(written(tmp_path, table=table))


def test_an_empty_cell_in_the_name_of_a_motion_is_no_motion(tmp_path: Path) -> None:
    plain = DESCRIPTION.replace("{test:0>3}", "{number:0>3}")
    with pytest.raises(InputError, match="run '12' has an empty cell in column 'number'"):
        read_outcomes(written(tmp_path, "test,motion,fell,number\n1,a,0,1\n12,a,1,\n", plain))


def test_a_statement_names_the_columns_of_a_table(tmp_path: Path) -> None:
    """A CSV needs more than a unit: columns, whether it has a header, lines to be skipped."""
    stated = DESCRIPTION.replace("shaking.npz:run_{test:0>3}", "run_{test}.csv").partition("[statement]")[0]
    stated += '[statement]\ntime_step = "0.01 s"\nheader = false\n'
    stated += '[statement.columns]\nacceleration_x = { column = 1, unit = "cm/s2" }\n'
    path = written(tmp_path, description=stated)
    for run in ("1", "12", "3"):
        (tmp_path / f"run_{run}.csv").write_text("\n".join([f"{run}.0"] * 20))
    np.testing.assert_allclose([motion.pga for motion in read_outcomes(path).motions], [0.01, 0.12, 0.03])
