"""Recordings without a rotation: gauges under the corners and an accelerometer on top tell the same block."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import butter, lfilter

import models
from diagnosis.answer.calibration import Calibration, calibrate
from diagnosis.data.noise import response_noise
from diagnosis.fit.prediction import Point, Predictor
from diagnosis.fit.setup import measure
from diagnosis.fit.unknowns import fixed_values
from diagnosis.search.candidates import reads
from grids.instruments import INSTRUMENTS
from grids.recordings.base import Recording
from models.errors import InputError
from models.kinematics import Place
from tests.diagnosis.made import SPECIMEN, TRUE, motion

PLACES = {
    "lvdt_left": Place("displacement", 1, -0.12, 0.0, "z"),
    "lvdt_right": Place("displacement", 1, 0.12, 0.0, "z"),
    "string": Place("displacement", 1, 0.0, 1.5, "x"),
    "top": Place("acceleration", 1, 0.0, 1.8, "across", "absolute"),
    "load": Place("force", 1, direction="x"),
    "inclino": Place("rotation"),
}
UNKNOWN = replace(SPECIMEN, calibrate={"restitution": (0.8, 1.0)})
SHARE = 1.0 - 1.5 * TRUE["width"] ** 2 / (TRUE["width"] ** 2 + TRUE["height"] ** 2)


def recorded(names: Sequence[str], noise: float = 0.01, seed: int = 3) -> Recording:
    shaking = motion(3)
    ran = models.get("housner").simulate(TRUE, shaking, duration=shaking.duration)
    rng = np.random.default_rng(seed)
    ground = shaking.horizontal, np.zeros_like(shaking.horizontal)
    channels = {"base_acceleration_x": shaking.horizontal + 0.003 * shaking.pga * rng.normal(size=ran.time.size)}
    for name in names:
        true = PLACES[name].read(ran.channels, shaking.time_step, ground) if name in PLACES else ran.channels[name]
        channels[name] = true + noise * np.max(np.abs(true)) * rng.normal(size=true.size)
    return Recording("run", shaking.time_step, ran.time, channels, places={n: PLACES[n] for n in names if n in PLACES})


BY_GAUGES = ("lvdt_left", "lvdt_right", "top")


@pytest.fixture(scope="module")
def by_gauges() -> Calibration:
    return calibrate(UNKNOWN, [recorded(BY_GAUGES)], profile=False)


def test_rotations_are_estimated_from_gauges_and_not_compared() -> None:
    rotation = recorded(("rotation_1",), 0.0).channels["rotation_1"]
    for names in (("lvdt_left", "lvdt_right"), ("string",)):
        measured = measure(UNKNOWN, [recorded(names, 1e-6)])
        assert measured.channels == names
        # at the nominal width, .2 % off
        error = measured.recordings[0].channels["rotation_1"] - rotation
        assert np.max(np.abs(error)) < 0.003 * np.max(np.abs(rotation))


def test_a_calibration_by_gauges_finds_the_block(by_gauges: Calibration) -> None:
    true = {"width": TRUE["width"], "height": TRUE["height"], "restitution": SHARE}
    again = calibrate(UNKNOWN, [recorded(BY_GAUGES, seed=4)], profile=False)
    off = [
        (c.parameters[name].estimate - value) / ((c.parameters[name].high95 - c.parameters[name].low95) / 3.92)
        for c in (by_gauges, again) for name, value in true.items()
    ]  # fmt: skip
    assert np.sqrt(np.mean(np.square(off))) < 1.6  # in deviations, over two draws of the noise
    assert by_gauges.misfit < 1.2 * by_gauges.noise_floor


def test_a_calibration_by_rotation_agrees_with_it(by_gauges: Calibration) -> None:
    rotation = calibrate(UNKNOWN, [recorded(("rotation_1",))], profile=False).parameters
    for name, one in by_gauges.parameters.items():
        assert one.low95 < rotation[name].high95
        assert rotation[name].low95 < one.high95


def test_instruments_act_on_a_rotation_by_its_place() -> None:
    measured = measure(UNKNOWN, [recorded(("inclino", "string"))])
    plain = {**fixed_values(UNKNOWN), "restitution": SHARE}
    true, read = Predictor(measured).predict(
        [Point(values, measured.states) for values in (plain, {**plain, "gain.gain": 0.05})]
    )
    k, other = (measured.channels.index(name) for name in ("inclino", "string"))
    np.testing.assert_allclose(read[:, k], 1.05 * true[:, k], rtol=1e-12)
    np.testing.assert_array_equal(read[:, other], true[:, other])
    assert reads(INSTRUMENTS["gain"], measured)
    assert not reads(INSTRUMENTS["gain"], measure(UNKNOWN, [recorded(("string",))]))


@pytest.mark.parametrize(("names", "said"), ((("lvdt_left",), "on both sides"), (("top",), "rotation_1 is missing")))
def test_channels_that_do_not_tell_the_rotation_are_refused(names: tuple[str, ...], said: str) -> None:
    with pytest.raises(InputError, match=said):
        measure(UNKNOWN, [recorded(names)])


def test_a_channel_on_a_body_that_the_model_lacks_is_refused() -> None:
    one = recorded(("rotation_1", "string"))
    other = replace(one, places={"string": replace(PLACES["string"], body=2)})
    with pytest.raises(InputError, match="body 2 and model housner has one body"):
        measure(UNKNOWN, [other])


def test_a_gauge_that_was_moved_under_its_name_is_refused_and_not_read_where_it_was() -> None:
    before, after = recorded(("rotation_1", "string")), recorded(("rotation_1",))
    low = replace(PLACES["string"], z=0.9)
    channels = {**after.channels, "string": 0.6 * before.channels["string"]}
    after = replace(after, name="after", channels=channels, places={"string": low})
    said = r"string is the .* at \(0, 1\.5\) m.*, in run, and .* at \(0, 0\.9\) m.*, in after"
    with pytest.raises(InputError, match=said):
        measure(UNKNOWN, [before, after])
    lower = {"string_low" if name == "string" else name: x for name, x in after.channels.items()}
    apart = replace(after, channels=lower, places={"string_low": low})
    assert measure(UNKNOWN, [before, apart]).channels == ("rotation_1",)


def test_what_a_channel_adds_is_the_width_of_the_intervals_without_it(by_gauges: Calibration) -> None:
    added = by_gauges.channels
    assert set(added) == {"lvdt_left", "lvdt_right", "top"}
    assert all(wider >= 1.0 - 1e-6 for each in added.values() for wider in each.values())
    # the accelerometer sees every impact: without it the restitution is far less certain
    assert added["top"]["restitution"] > 3.0


def test_a_load_cell_weighs_the_block() -> None:
    unknown = replace(SPECIMEN, calibrate={"mass": (0.5 * TRUE["mass"], 2.0 * TRUE["mass"])})
    off = []
    for seed in (0, 1, 3, 5):
        found = calibrate(unknown, [recorded(("rotation_1", "load"), seed=seed)], profile=False).parameters["mass"]
        # while the base moves a load cell is not still though the block is: its readings there are no noise
        assert found.high95 - found.low95 < 0.02 * TRUE["mass"]
        off.append((found.estimate - TRUE["mass"]) / ((found.high95 - found.low95) / 3.92))
    assert np.sqrt(np.mean(np.square(off))) < 1.6


def test_a_rotation_is_never_taken_for_its_mirror_image() -> None:
    # gauges just inside the corners: turned to either side both rise, one of them little
    true = recorded(("rotation_1",), 0.0).channels["rotation_1"]
    for seed in (5, 6):
        found = measure(UNKNOWN, [recorded(("lvdt_left", "lvdt_right"), seed=seed)]).recordings[0]
        assert np.max(np.abs(found.channels["rotation_1"] - true)) < 0.1 * np.max(np.abs(true))


def test_the_noise_of_an_accelerometer_does_not_hold_the_shaking() -> None:
    """Weak shaking before the strong one has a flat spectrum and a steady range, as what is still has."""
    rng, step, sigma = np.random.default_rng(5), 0.005, 0.01
    time = step * np.arange(2400)
    weak = lfilter(*butter(4, 14.0, fs=1.0 / step), rng.normal(size=time.size))
    base = weak * np.where(time < 5.0, 1.0, 8.0)
    channels = {"base_acceleration_x": base, "top": base + sigma * rng.normal(size=time.size)}
    assert response_noise(Recording("run", step, time, channels, places={"top": PLACES["top"]}), "top") < 5.0 * sigma
