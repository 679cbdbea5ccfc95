"""The regression that suspicions rest on, where a recording gives it nothing to go by."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from grids.recordings import Recording, read_recording
from grids.recordings.suspicions import fit_rocking, suspicions_of
from tests.grids import rocking_block
from tests.grids.rocking_block import BASE, ROTATION

STEP, COUNT = 0.01, 400
TIME = STEP * np.arange(COUNT)


def test_a_rotation_that_the_base_has_no_share_in_says_nothing_of_the_body() -> None:
    """Of a sine the rotation alone explains the acceleration: rounding is left to the base, or exactly 0."""
    rotation, base = 0.05 * np.sin(5.0 * TIME), 2.0 * np.sin(8.0 * TIME)
    for ahead in range(60):
        fit = fit_rocking(rotation[: COUNT - ahead], base[ahead:], STEP)
        assert fit is not None and abs(fit.p2) < 1e-12
        assert fit.p2 != 0.0 or (fit.significance, fit.alpha) == (0.0, np.inf)


@pytest.mark.parametrize(("moved", "suspected"), [(0.0, False), (0.002, False), (0.06, True)])
def test_a_zero_that_moves_between_the_rests_is_suspected(moved: float, suspected: bool) -> None:
    """Of 3 m s-2 with noise of .4 per cent; where the record ends in motion nothing is told."""
    rng, time = np.random.default_rng(1), 0.005 * np.arange(1600)
    shaken = (time > 2.0) & (time < 6.0)
    base = 3.0 * np.sin(9.0 * time) * shaken + moved * (time > 4.0) + 0.012 * rng.normal(size=time.size)

    def said(count: int) -> bool:
        channels = {"base_acceleration_x": base[:count], "rotation_1": 0.01 * base[:count]}
        found = suspicions_of(Recording("run", 0.005, time[:count], channels))
        return any("at rest before the shaking" in one for one in found)

    assert said(time.size) == suspected
    assert not said(1000)


@pytest.mark.parametrize(
    ("rotation", "step", "words"),
    [
        (ROTATION, rocking_block.STEP, None),
        (ROTATION + 0.01, rocking_block.STEP, None),  # what a model of the sensor takes care of
        (
            ROTATION + 0.3,
            rocking_block.STEP,
            "rests at +0.3 rad before the shaking and after it: is the sensor's zero wrong",
        ),
        (ROTATION - 0.3, rocking_block.STEP, "rests at -0.3 rad"),
        (
            1e-3 * ROTATION,
            rocking_block.STEP,
            "is the rotation in a larger unit than the one declared, or the clock too slow",
        ),
        (ROTATION, 10.0 * rocking_block.STEP, "or the clock too slow"),
        (ROTATION, 0.1 * rocking_block.STEP, "or the clock too fast"),
    ],
)
def test_a_zero_a_unit_or_a_clock_that_no_block_explains(rotation: np.ndarray, step: float, words: str | None) -> None:
    channels = {"base_acceleration_x": BASE, "rotation_1": rotation}
    said = suspicions_of(Recording("run", step, step * np.arange(BASE.size), channels))
    assert (said == ()) if words is None else (len(said) == 1 and words in said[0]), said


def test_a_body_that_is_let_go_or_comes_to_rest_elsewhere_is_no_wrong_zero() -> None:
    time = 0.005 * np.arange(1600)
    for start, end in ((0.1, 0.0), (0.0, 0.1), (0.1, 0.05), (0.1, -0.1)):
        channels = {"base_acceleration_x": 0.0 * time, "rotation_1": np.where(time < 4.0, start, end)}
        assert not any("zero wrong" in said for said in suspicions_of(Recording("run", 0.005, time, channels)))


@pytest.mark.parametrize(
    ("unit", "sign", "words"),
    [
        ("mm", 1, "displacement_1_x and rotation_1 are one column, 'r', in two units or signs: is it named twice"),
        ("m", -1, "displacement_1_x and rotation_1 are one column"),
        ("m", 1, "displacement_1_x holds the samples of rotation_1: is one column named twice"),
    ],
)
def test_one_column_named_twice(tmp_path: Path, unit: str, sign: int, words: str) -> None:
    rows = [f"{a:.5f},{r:.6f}" for a, r in zip(BASE, ROTATION, strict=True)]
    (tmp_path / "run.csv").write_text("\n".join(["a,r", *rows]))
    (tmp_path / "run.toml").write_text(
        f'time_step = "{rocking_block.STEP} s"\n[columns]\nbase_acceleration_x = {{ column = "a", unit = "m/s2" }}\n'
        'rotation_1 = { column = "r", unit = "rad" }\n'
        f'displacement_1_x = {{ column = "r", unit = "{unit}", sign = {sign} }}\n'
    )
    (said,) = read_recording(tmp_path / "run.csv").suspicions
    assert words in said
