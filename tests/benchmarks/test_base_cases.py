"""Cases of wrong base models, by seed: how many of what, and that what is taken for one body is not one."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import numpy as np
import pytest

from benchmarks.diagnosis import bases
from benchmarks.diagnosis.files import write_case
from grids.recordings import read_recording
from grids.specimen import read_specimen


def test_every_group_is_asked_for_and_names_a_rung_of_the_model_it_is_taken_for() -> None:
    asked = bases.designs(7)
    assert Counter(design.names[0] for design in asked) == bases.COUNTS
    assert {design.names[0] for design in asked if design.kind == "single"} == set(bases.WRONG)


@pytest.mark.parametrize("group", bases.COUNTS)
def test_a_case_is_read_as_it_was_made(group: str, tmp_path: Path) -> None:
    design = next(one for one in bases.designs(7) if one.names == (group,))
    case = bases.make(design, 7)
    folder, key = tmp_path / design.label, tmp_path / "key.json"
    write_case(case, folder, key)
    specimen = read_specimen(folder / "specimen.toml")
    assert specimen.model == case.key["base"]
    assert (specimen.model != case.key["model"]) == (group in bases.WRONG)
    for name in ("train_1", "train_2", "test_1"):
        read = read_recording(folder / f"{name}.nc")
        one = read.channels["rotation_1"]
        if group == "stack_as_block" and "rotation_2" in read.channels:
            apart = np.max(np.abs(read.channels["rotation_2"] - one))
            assert apart > 0.1 * np.max(np.abs(one))
        if group == "block" and "rotation_2" in read.channels:
            assert np.std(read.channels["rotation_2"] - one) < 0.02 * np.max(np.abs(one))
