"""What is compared of several recordings: channels, rates where they were recorded, what cannot be diagnosed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import models
from diagnosis.data.measured import left_out
from diagnosis.fit.setup import measure
from grids.recordings.base import Recording
from grids.specimen import Specimen
from models.errors import InputError
from tests.diagnosis.buildings import SPECIMEN as BUILDING
from tests.diagnosis.buildings import made as building
from tests.diagnosis.made import SPECIMEN, recording

RATE = 7.0
"""rad s-1; no rate of the block, so that it is seen where a start comes from."""


def with_rate(made: Recording) -> Recording:
    channels = {**made.channels, "rotation_rate_1": np.full(made.time.size, RATE)}
    return replace(made, channels=channels)


@pytest.mark.parametrize("rated", [0, 1])
def test_each_recording_starts_from_its_own_rate_or_from_the_slope_of_its_rotation(rated: int) -> None:
    plain = [recording("a", 1), recording("b", 2)]
    mixed = [with_rate(made) if k == rated else made for k, made in enumerate(plain)]
    without, found = measure(SPECIMEN, plain), measure(SPECIMEN, mixed)
    assert found.channels == ("rotation_1",)
    of_rated = found.recording_of == rated
    np.testing.assert_allclose(found.states[of_rated, 1], RATE)
    np.testing.assert_array_equal(found.states[~of_rated], without.states[~of_rated])
    assert 0 < of_rated.sum() < of_rated.size


def test_a_channel_of_one_recording_alone_is_left_out_and_told() -> None:
    plain, rated = recording("a", 1), with_rate(recording("b", 2))
    assert left_out([plain, rated]) == {"rotation_rate_1": ("a",)}
    assert left_out([rated]) == {} and left_out([plain, plain]) == {}


@pytest.mark.parametrize("channel", ["rotation_1", "rotation_rate_1"])
def test_a_sensor_that_is_dead_is_named(channel: str) -> None:
    alive = recording("a", 1)
    rate = np.gradient(alive.channels["rotation_1"], alive.time_step)
    whole = replace(alive, channels={**alive.channels, "rotation_rate_1": rate})
    dead = replace(whole, name="b", channels={**whole.channels, channel: np.zeros(whole.time.size)})
    with pytest.raises(InputError, match=rf"{channel} of b reads 0 throughout: a sensor that is dead"):
        measure(SPECIMEN, [whole, dead])


def test_a_dead_sensor_of_a_building_is_named() -> None:
    whole = building("small", 1.0, 1)
    drawn = {**whole.channels, "level_displacement_x": np.zeros_like(whole.channels["level_displacement_x"])}
    with pytest.raises(InputError, match=r"level_displacement_x_0 of dead reads 0 throughout: a sensor that is dead"):
        measure(BUILDING, [whole, replace(whole, name="dead", channels=drawn)])


def test_a_recording_that_never_moves_gives_no_reference_peak() -> None:
    moving = recording("a", 1)
    still = np.random.default_rng(5).normal(scale=1e-5, size=moving.time.size)
    resting = replace(moving, name="rest", channels={**moving.channels, "rotation_1": still})
    found = measure(SPECIMEN, [resting, moving])
    assert set(found.recording_of) == {1}
    assert found.reference_peak == measure(SPECIMEN, [moving]).reference_peak


def test_what_a_window_needs_is_named_with_the_recordings_that_lack_it() -> None:
    two = Specimen(title="two blocks", model="stacked", parameters={})
    with pytest.raises(InputError, match=r"rotation_2 is missing in a, b: model stacked"):
        measure(two, [recording("a", 1), recording("b", 2)])


@pytest.mark.parametrize("lacking", ["declaration", "states"])
def test_a_model_whose_motion_no_recording_holds_is_not_offered(lacking: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing declared, or latent states that are not carried."""
    model = models.get("interface_linear")
    left = None if lacking == "declaration" else replace(model.identification, carrying=False)
    monkeypatch.setattr(model, "identification", left)
    why = (
        "what they need to know of it" if lacking == "declaration" else "displacement_z_1, .* which no recording holds"
    )
    offered = "use model housner or stacked or interface or isolated"
    with pytest.raises(InputError, match=f"of model interface_linear are not offered yet: {why}.*; {offered}, or"):
        measure(Specimen(title="wall", model="interface_linear", parameters={}), [recording("a", 1)])
