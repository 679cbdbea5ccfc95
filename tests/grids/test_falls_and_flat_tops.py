"""Bodies that overturned are cut before their fall; sensors at the end of their range are suspected."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from grids.recordings import Recording, read_recording
from grids.recordings.flat_tops import flat_tops
from models.errors import InputError

STEP, GRAVITY = 0.005, 9.80665
P2, ALPHA = 6.0, 0.2
TIME = np.arange(0.0, 12.0, STEP)
SWINGS = TIME < 6.0
EARLIER = 0.08


def rocked(end: np.ndarray) -> np.ndarray:
    """Decaying swings up to ``EARLIER`` rad for 6 s, then ``end`` (the rotation over the rest)."""
    swings = EARLIER * np.exp(-0.3 * TIME) * np.sin(2 * np.pi * 1.1 * TIME)
    return np.concatenate([swings[SWINGS], end])


def fall(lying: float, side: float) -> np.ndarray:
    """theta'' = p^2 (theta - alpha) from beyond alpha, until the body lies."""
    late = TIME[~SWINGS] - TIME[~SWINGS][0]
    rising = np.minimum(1.1 * ALPHA * late / 0.4, ALPHA + 0.1 * ALPHA * np.cosh(np.sqrt(P2) * (late - 0.4)))
    rising[late > 0.4] = (ALPHA + 0.1 * ALPHA * np.cosh(np.sqrt(P2) * (late - 0.4)))[late > 0.4]
    return side * np.minimum(rising, lying)


def read(folder: Path, rotation: np.ndarray, *, base_only: bool = False, **more: np.ndarray) -> Recording:
    rng = np.random.default_rng(5)
    base = np.sin(2 * np.pi * 1.1 * TIME)
    channels = {"base_acceleration_x": (base, "m s-2"), "rotation_1": (rotation, "rad")}
    channels |= {name: (values, "rad") for name, values in more.items()}
    noisy = {
        name: ("time", values + rng.normal(0, 1e-4, TIME.size), {"units": unit})
        for name, (values, unit) in channels.items()
    }
    xr.Dataset(noisy, coords={"time": ("time", TIME, {"units": "s"})}).to_netcdf(folder / "test.nc")
    return read_recording(folder / "test.nc", base_only=base_only)


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize(
    ("lying", "words"), [(np.pi / 2, "overturned"), (1.4, "overturned"), (0.35, "fell against something")]
)
def test_an_overturned_record_ends_where_its_last_swing_leaves_the_known_range(
    side: float, lying: float, words: str, tmp_path: Path
) -> None:
    rotation = rocked(fall(lying, side))
    found = read(tmp_path, rotation)
    (note,) = [note for note in found.notes if "before the fall" in note]
    assert words in note and "rotation_1" in note
    assert np.max(np.abs(found.channels["rotation_1"])) < 1.02 * EARLIER
    assert 5.9 < found.time[-1] < 6.3
    assert all(values.shape == found.time.shape for values in found.channels.values())
    kept = read(tmp_path, rotation, base_only=True)
    assert kept.time.size == TIME.size and kept.notes == ()


def test_the_upper_body_alone_may_fall(tmp_path: Path) -> None:
    found = read(tmp_path, rocked(np.zeros(np.sum(~SWINGS))), rotation_2=rocked(fall(np.pi / 2, 1.0)))
    assert any(note.startswith("rotation_2 passes 60 deg") for note in found.notes)
    assert found.time[-1] < 6.3


ALIVE = {
    "comes back from a swing beyond alpha": rocked(0.5 * np.sin(np.pi * np.linspace(0, 1, np.sum(~SWINGS)))),
    "ends within a swing": rocked(0.3 * np.sin(np.pi / 2 * np.linspace(0, 1, np.sum(~SWINGS)) ** 8)),
    "leans a little for good": rocked(np.full(np.sum(~SWINGS), 0.02)),
    "a zero far off": 0.5 + rocked(np.zeros(np.sum(~SWINGS))),
}


@pytest.mark.parametrize("kind", ALIVE)
def test_what_is_no_fall_stays_whole(kind: str, tmp_path: Path) -> None:
    found = read(tmp_path, ALIVE[kind])
    assert found.time.size == TIME.size and not any("fall" in note for note in found.notes)


def test_degrees_declared_as_radians_are_no_fall(tmp_path: Path) -> None:
    found = read(tmp_path, np.degrees(rocked(fall(np.pi / 2, 1.0))))
    assert found.time.size == TIME.size and any("beyond lying flat" in words for words in found.suspicions)


def test_a_recording_that_is_nothing_but_a_fall_is_refused(tmp_path: Path) -> None:
    falling = np.minimum(ALPHA * np.cosh(np.sqrt(P2) * TIME), np.pi / 2)
    with pytest.raises(InputError, match=r"test\.nc: rotation_1 passes 60 deg .* leave the recording out"):
        read(tmp_path, falling)


def test_a_clipped_rotation_is_suspected_with_level_count_and_times(tmp_path: Path) -> None:
    rotation = rocked(np.zeros(np.sum(~SWINGS)))
    xr.Dataset(
        {
            "base_acceleration_x": ("time", np.sin(TIME), {"units": "m s-2"}),
            "rotation_1": ("time", np.maximum(rotation, -0.05), {"units": "rad"}),
        },
        coords={"time": ("time", TIME, {"units": "s"})},
    ).to_netcdf(tmp_path / "clip.nc")
    (found,) = [words for words in read_recording(tmp_path / "clip.nc").suspicions if "flat" in words]
    clipped = np.flatnonzero(rotation < -0.05)
    assert f"{clipped.size} samples at -0.05 rad" in found
    assert f"({TIME[clipped[0]]:.4g} to " in found and "rotation_1" in found


SMOOTH = 0.1 * np.sin(2 * np.pi * 1.3 * TIME + 0.4) * np.exp(-0.2 * TIME)


@pytest.mark.parametrize("limits", [(-0.05, 0.05), (-1.0, 0.05), (-0.03, 1.0)])
@pytest.mark.parametrize("quantum", [0.0, 1e-5, 1e-3])
def test_both_sides_of_a_clipped_channel_are_found_at_any_resolution(
    limits: tuple[float, float], quantum: float
) -> None:
    values = np.clip(SMOOTH, *limits)
    values = values if quantum == 0.0 else quantum * np.round(values / quantum)
    found = flat_tops(values)
    assert sorted(found) == pytest.approx([limit for limit in limits if abs(limit) < 1.0])


@pytest.mark.parametrize("quantum", [1e-5, 1e-4, 1e-3, 5e-3, 2e-2])
@pytest.mark.parametrize("noise", [0.0, 0.5, 2.0])
def test_the_rounded_tops_of_a_coarse_sensor_are_not_flat(quantum: float, noise: float) -> None:
    rng = np.random.default_rng(2)
    for phase in rng.uniform(0, 6.3, 20):
        signal = 0.1 * np.sin(2 * np.pi * 1.3 * TIME + phase) * np.exp(-0.2 * TIME)
        assert flat_tops(quantum * np.round(signal / quantum + rng.normal(0, noise, TIME.size))) == {}


def test_rest_and_a_channel_that_is_held_are_not_flat() -> None:
    one_sided = np.where(TIME < 3.0, 0.0, np.abs(SMOOTH))
    assert flat_tops(one_sided) == {}
    assert flat_tops(np.where((TIME > 4.0) & (TIME < 5.0), 0.0, one_sided)) == {}
    assert flat_tops(np.repeat(SMOOTH[::8], 8)) == {}
    assert flat_tops(np.zeros(50)) == {}
