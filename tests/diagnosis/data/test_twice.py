"""The same data given twice, under two names or from files of two kinds."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diagnosis import calibrate, diagnose
from diagnosis.data.twice import same_samples
from grids.recordings import Recording
from models.errors import InputError
from tests.diagnosis.made import SPECIMEN, recording


def rounded(of: Recording) -> Recording:
    """As a CSV with six digits holds it, with its file."""
    channels = {name: np.array([float(f"{v:.6g}") for v in values]) for name, values in of.channels.items()}
    return replace(of, name="logged", channels=channels, source={"file": "logged.csv"})


def test_the_same_samples_are_refused_as_training_and_held_out() -> None:
    one, other = recording("a", 1), recording("b", 2)
    copy = rounded(one)
    with pytest.raises(InputError, match=r"a and logged \(logged.csv\) hold the same .* held out cannot be fitted too"):
        diagnose(SPECIMEN, [one, other], [copy])
    with pytest.raises(InputError, match="give them once"):
        diagnose(SPECIMEN, [one, copy], [other])
    for twice in ([one, copy], [one, one]):
        with pytest.raises(InputError, match="hold the same samples; give them once"):
            calibrate(SPECIMEN, twice)


def test_two_tests_under_one_motion_are_two() -> None:
    one = recording("a", 1)
    noise = 1e-3 * np.max(np.abs(one.channels["rotation_1"])) * np.random.default_rng(1).normal(size=one.time.size)
    again = {**one.channels, "rotation_1": one.channels["rotation_1"] + noise}
    assert not same_samples(one, replace(one, name="again", channels=again))
    assert same_samples(one, rounded(one)) and not same_samples(one, recording("b", 2))
