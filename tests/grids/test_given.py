"""Recordings and motions of arrays, as calls from Python bring them: what no reader would let pass is one sentence."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from grids.given import recordings_of, specimen_of
from grids.motions import Motion, read_motion
from grids.plan import read_plan
from grids.recordings import Recording, read_recording
from grids.specimen import read_specimen
from models.errors import InputError
from models.kinematics import Place

N, STEP = 200, 0.01
TIME = STEP * np.arange(N)
BASE, ROTATION = np.sin(6.0 * TIME), 0.01 * np.sin(3.0 * TIME)
SOUND = Recording(
    "run",
    STEP,
    TIME,
    {
        "base_acceleration_x": BASE,
        "rotation_1": ROTATION,
        "gauge": 0.1 * ROTATION,
        "level_displacement_x": np.ones((2, N)),
    },
    ("0", "1"),
    places={"gauge": Place("displacement")},
)


def test_a_sound_recording_stays_as_it_is_and_lists_become_arrays() -> None:
    (found,) = recordings_of(SOUND)
    assert all(found.channels[name] is values for name, values in SOUND.channels.items())
    listed = replace(SOUND, time=TIME.tolist(), channels={**SOUND.channels, "rotation_1": ROTATION.tolist()})  # type: ignore[arg-type]
    (found,) = recordings_of([listed])
    np.testing.assert_array_equal(found.channels["rotation_1"], ROTATION)


def channel(name: str, values: Any) -> Recording:
    return replace(SOUND, channels={**SOUND.channels, name: values})


@pytest.mark.parametrize(
    ("recording", "said"),
    [
        (channel("base_acceleration_x", np.where(TIME > 1.0, np.nan, BASE)), "base_acceleration_x holds values that"),
        (channel("rotation_1", np.full(N, np.inf)), "rotation_1 holds values that are not finite: cut them off"),
        (channel("rotation_1", ROTATION[:-1]), r"rotation_1 has shape \(199,\): give \(200,\) samples"),
        (channel("level_displacement_x", np.ones((3, N))), r"shape \(3, 200\): give \(2, 200\) levels and samples"),
        (channel("rotation_1", 1j * ROTATION), "rotation_1 is complex numbers: give an array of real"),
        (channel("rotation_1", ["a"] * N), "rotation_1 is a list of no real numbers"),
        (channel("rotation_1", [[1.0], [1.0, 2.0]]), "rotation_1 is a list of no real numbers"),
        (channel("rotaton_1", ROTATION), "'rotaton_1' is no standard channel .*did you mean 'rotation_1'"),
        (replace(SOUND, time=TIME[::-1]), "time is not 0, time_step, 2 time_step"),
        (replace(SOUND, time=np.r_[0.0, TIME[:-1]]), "time is not 0, time_step"),
        (replace(SOUND, time=TIME + 1.0), "time is not 0, time_step"),
        (replace(SOUND, time_step=0.0), "time_step is 0.0: give a positive number"),
        (replace(SOUND, time_step="0.01 s"), "time_step is '0.01 s'"),
        (replace(SOUND, channels={"rotation_1": ROTATION}), "channels lack base_acceleration_x"),
    ],
)
def test_a_recording_that_is_none(recording: Recording, said: str) -> None:
    with pytest.raises(InputError, match=f"^recording run: .*{said}"):
        recordings_of(recording)


def test_what_is_neither_a_file_nor_what_was_read() -> None:
    motion = Motion("m", STEP, BASE)
    for given in (None, motion, [motion], [None], 3, BASE, {"a": SOUND}, xr.Dataset({"a": ("x", BASE)})):
        with pytest.raises(InputError, match=r"recording is of type \w+: give what read_recording returns"):
            recordings_of(given)  # type: ignore[arg-type]
    for given in (None, {"title": "wall"}, motion):
        with pytest.raises(InputError, match=r"specimen is of type \w+: give what read_specimen returns"):
            specimen_of(given)  # type: ignore[arg-type]


def test_numbers_of_numpy_are_numbers() -> None:
    """As an npz file holds them: of any kind, or an array without dimensions."""
    for step in (np.array(STEP), np.float32(0.25), 1):
        motion = Motion("m", step, BASE)  # type: ignore[arg-type]
        assert isinstance(motion.time_step, float) and motion.time_step == step
    (found,) = recordings_of(replace(SOUND, time_step=np.array(STEP)))  # type: ignore[arg-type]
    assert isinstance(found.time_step, float) and found.time_step == STEP
    for no_number in (np.array(True), np.array([STEP]), np.array("0.01"), 1j, 10**400):
        with pytest.raises(InputError, match="time_step is"):
            Motion("m", no_number, BASE)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("values", "step", "said"),
    [
        (1j * BASE, STEP, "horizontal is complex numbers"),
        (["a", "b"], STEP, "horizontal is a list of no real numbers"),
        (BASE, "0.01 s", "time_step is '0.01 s': give a positive number, in s"),
        (BASE, True, "time_step is True"),
        (BASE, None, "time_step is None"),
    ],
)
def test_a_motion_that_is_none(values: Any, step: Any, said: str) -> None:
    with pytest.raises(InputError, match=f"motion m: {said}"):
        Motion("m", step, values)


def test_reading_what_is_no_name() -> None:
    for given in (BASE, (TIME, BASE), None):
        with pytest.raises(InputError, match=r"motion is of type \w+: .*rocking\.Motion\(name, "):
            read_motion(given)  # type: ignore[arg-type]
    with pytest.raises(InputError, match=r"component is 1: give the name"):
        read_motion("ridgecrest_2019_clc", component=1)  # type: ignore[arg-type]
    for read, what in ((read_recording, "recording"), (read_specimen, "specimen"), (read_plan, "plan")):
        with pytest.raises(InputError, match=f"{what} is of type int: give the name of its file"):
            read(5)  # type: ignore[operator]
    for path in ("x" * 300 + ".nc", Path("x" * 300 + ".csv")):
        with pytest.raises(InputError, match="does not exist"):
            read_recording(path)
    with pytest.raises(InputError, match="is not beside the file that names it"):
        read_motion("x" * 300 + ".nc")
