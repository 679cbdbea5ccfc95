"""Recordings: what is read, refused and suspected, on signals whose truth is known."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from grids.data_folder import data_folder
from grids.motions import read_motion
from grids.recordings import read_recording
from models.errors import InputError
from tests.grids.rocking_block import BASE, COUNT, GRAVITY, ROTATION, STEP, TIME


def dataset(**changes: Any) -> Any:
    """A sound recording as an xarray Dataset, with ``name = (values, unit)`` replaced."""
    import xarray

    held: dict[str, tuple[Any, str | None]] = {
        "base_acceleration_x": (BASE, "m s-2"),
        "rotation_1": (ROTATION, "rad"),
        "time": (TIME, "s"),
        **changes,
    }

    def variable(name: str) -> Any:
        values, unit = held[name]
        return ("time", values, {} if unit is None else {"units": unit})

    names = [name for name in held if name != "time" and held[name] is not None]
    return xarray.Dataset({n: variable(n) for n in names}, coords={"time": variable("time")})


def stored(folder: Path, data: Any) -> Path:
    path = folder / "test_1.nc"
    data.to_netcdf(path)
    return path


def test_a_recording_is_band_limited_between_samples_unless_it_says_linear(tmp_path: Path) -> None:
    data = dataset()
    assert read_recording(stored(tmp_path, data)).shaking(False).band_limited
    data["base_acceleration_x"].attrs["between_samples"] = "linear"
    assert not read_recording(stored(tmp_path, data)).shaking(False).band_limited
    data["base_acceleration_x"].attrs["between_samples"] = "linaer"
    with pytest.raises(InputError, match=r"between_samples is 'linaer'; did you mean 'linear'"):
        read_recording(stored(tmp_path, data))


def test_a_table_says_so_too_and_a_motion_cannot(tmp_path: Path) -> None:
    header, rows = "t,a,r", [f"{k},{0.1 * k},{0.01 * k}" for k in range(20)]
    (tmp_path / "run.csv").write_text("\n".join([header, *rows]))
    channels = {"base_acceleration_x": ("a", "m/s2"), "rotation_1": ("r", "rad")}
    columns = [f'{name} = {{ column = "{column}", unit = "{unit}" }}' for name, (column, unit) in channels.items()]
    layout = "\n".join(['time_step = "0.01 s"', "[columns]", *columns])
    (tmp_path / "run.toml").write_text(layout)
    assert read_recording(tmp_path / "run.csv").band_limited
    (tmp_path / "run.toml").write_text(f'between_samples = "linear"\n{layout}')
    assert not read_recording(tmp_path / "run.csv").band_limited
    assert read_motion(tmp_path / "run.csv").time_step == 0.01  # which is linear anyway
    (tmp_path / "run.toml").write_text(f'between_samples = "band_limited"\n{layout}')
    assert read_recording(tmp_path / "run.csv").band_limited
    with pytest.raises(InputError, match=r"a motion is linear between samples"):
        read_motion(tmp_path / "run.csv")


def test_units_become_si_and_time_starts_at_zero(tmp_path: Path) -> None:
    data = dataset(
        base_acceleration_x=(BASE / GRAVITY, "g"),
        rotation_1=(np.degrees(ROTATION), "deg"),
        time=((TIME + 3.0) * 1e3, "ms"),
        temperature=(TIME, "K"),
    )
    found = read_recording(stored(tmp_path, data))
    assert np.allclose(found.channels["base_acceleration_x"], BASE)
    assert np.allclose(found.channels["rotation_1"], ROTATION)
    assert np.allclose(found.time, TIME) and found.time_step == pytest.approx(STEP, rel=1e-12)
    assert found.responses == ("rotation_1",)
    assert any("temperature" in note for note in found.notes) and any("3 s" in note for note in found.notes)
    assert found.suspicions == ()
    with pytest.raises(ValueError, match="read-only"):
        found.channels["rotation_1"][0] = 1.0


@pytest.mark.parametrize("start", [np.datetime64("2026-03-01T10:00:00", "ns"), np.timedelta64(0, "ns")])
def test_a_clock_of_dates_as_xarray_writes_it(tmp_path: Path, start: Any) -> None:
    data = dataset().assign_coords(time=start + (TIME * 1e9).round().astype("timedelta64[ns]"))
    data["time"].encoding["units"] = "nanoseconds since 2026-03-01" if start.dtype.kind == "M" else "nanoseconds"
    found = read_recording(stored(tmp_path, data))
    assert np.allclose(found.time, TIME) and found.time_step == pytest.approx(STEP, rel=1e-12)


def test_shaking_with_and_without_the_vertical_channel(tmp_path: Path) -> None:
    found = read_recording(stored(tmp_path, dataset(base_acceleration_z=(0.3 * BASE, "m s-2"))))
    vertical = found.shaking(True).vertical
    assert vertical is not None and np.allclose(vertical, 0.3 * BASE)
    assert found.shaking(False).vertical is None
    plain = read_recording(stored(tmp_path, dataset()))
    with pytest.raises(InputError, match=r"base_acceleration_z was not recorded; set \[motion\] vertical"):
        plain.shaking(True)


def test_unmeasured_ends_are_cut_and_said(tmp_path: Path) -> None:
    holed = ROTATION.copy()
    holed[:40], holed[-7:] = np.nan, np.nan
    found = read_recording(stored(tmp_path, dataset(rotation_1=(holed, "rad"))))
    assert np.allclose(found.channels["rotation_1"], ROTATION[40:-7])
    assert np.allclose(found.channels["base_acceleration_x"], BASE[40:-7])
    assert any("40 samples at the start and 7 at the end" in note for note in found.notes)


def mapped(written: Callable[[str, str], Path], toml: str, header: str = "t,acc,inc") -> Path:
    rows = "\n".join(f"{t:.3f},{a:.9f},{r:.9f}" for t, a, r in zip(TIME, BASE / GRAVITY, -1e3 * ROTATION, strict=True))
    written("test_2.toml", toml)
    return written("test_2.csv", f"{header}\n{rows}\n")


CSV = (
    "title = 'wall'\ntime = { column = 't', unit = 's' }\n[columns]\n"
    "base_acceleration_x = { column = 'acc', unit = 'g' }\n"
    "rotation_1 = { column = 3, unit = 'mrad', sign = -1 }\n"
)


def test_a_table_with_its_description(written: Callable[[str, str], Path]) -> None:
    path = mapped(written, CSV)
    for named in (path, path.with_suffix(".toml")):
        found = read_recording(named)
        assert np.allclose(found.channels["base_acceleration_x"], BASE, atol=1e-7)
        assert np.allclose(found.channels["rotation_1"], ROTATION, atol=1e-11)
        assert found.time_step == STEP and found.source["title"] == "wall"
        assert any("sign turned as stated: rotation_1" in note for note in found.notes)


def logged(written: Callable[[str, str], Path], cells: dict[int, str], decimal: str = ".") -> Path:
    """A logger's CSV in which the inclinometer wrote ``cells`` at some samples."""
    written("test_3.toml", CSV.replace("title", f"delimiter = ';'\ndecimal = '{decimal}'\ntitle"))
    rows = [[f"{t:.3f}", f"{a:.9f}", f"{r:.9f}"] for t, a, r in zip(TIME, BASE / GRAVITY, -1e3 * ROTATION, strict=True)]
    for sample, cell in cells.items():
        rows[sample][2] = cell
    lines = [";".join(row).replace(".", decimal) for row in rows]
    return written("test_3.csv", "\n".join(["t;acc;inc", *lines, ";;", ""]))


@pytest.mark.parametrize("missing", ["", "#N/A", "-", "NaN", "null"])
def test_cells_without_a_value_are_cut_at_the_ends_and_placed_inside(
    missing: str, written: Callable[[str, str], Path]
) -> None:
    found = read_recording(logged(written, dict.fromkeys([0, 1, COUNT - 1], missing)))
    assert np.allclose(found.channels["rotation_1"], ROTATION[2:-1], atol=1e-11)
    assert any("2 samples at the start and 1 at the end" in note for note in found.notes)
    with pytest.raises(InputError, match=r"rotation_1 lacks 3 value\(s\) between 2 s and 2.01 s; cut"):
        read_recording(logged(written, dict.fromkeys(range(400, 403), missing)))


def test_a_decimal_comma_is_stated_or_asked_for(written: Callable[[str, str], Path]) -> None:
    path = logged(written, {}, ",")
    found = read_recording(path)
    assert np.allclose(found.channels["rotation_1"], ROTATION, atol=1e-11)
    assert np.allclose(found.channels["base_acceleration_x"], BASE, atol=1e-7)
    mapping = path.with_suffix(".toml")
    mapping.write_text(mapping.read_text().replace("decimal = ','", "decimal = '.'"))
    with pytest.raises(InputError, match=r'line 2: base_acceleration_x is .*state decimal = ","'):
        read_recording(path)
    with pytest.raises(InputError, match=r'line 2: base_acceleration_x is .*state decimal = "\."'):
        path = logged(written, {})
        mapping.write_text(mapping.read_text().replace("decimal = '.'", "decimal = ','"))
        read_recording(path)


def test_a_word_among_the_numbers_is_told_with_its_line_and_the_file_once(written: Callable[[str, str], Path]) -> None:
    with pytest.raises(InputError, match="line 502: rotation_1 is 'ERR', not a number; correct it") as error:
        read_recording(logged(written, {500: "ERR"}))
    assert str(error.value).count("test_3.csv") == 1
    path = logged(written, {})
    lines = path.read_text().splitlines()
    lines[500] = lines[500][lines[500].index(";") :]
    path.write_text("\n".join(lines))
    with pytest.raises(InputError, match="line 501 has no time"):
        read_recording(path)


def test_levels_of_a_table(written: Callable[[str, str], Path]) -> None:
    toml = CSV.replace("rotation_1", "level_acceleration_x_1").replace("'mrad', sign = -1", "'m/s2'")
    toml += "level_acceleration_x_0 = { column = 'acc', unit = 'g' }\n"
    found = read_recording(mapped(written, toml))
    assert found.levels == ("0", "1")
    assert np.allclose(found.channels["level_acceleration_x"][0], BASE, atol=1e-7)


def bad_time(index: int, value: float) -> np.ndarray:
    times = TIME.copy()
    times[index:] += value
    return times


def holed(values: np.ndarray) -> np.ndarray:
    return np.where((TIME > 2.0) & (TIME < 2.1), np.nan, values)


BAD_FILES: dict[str, tuple[dict[str, Any], tuple[str, ...]]] = {
    "no base": (
        {"base_acceleration_x": None, "base_acc": (BASE, "m s-2")},
        ("no base_acceleration_x", "base_acc"),
    ),
    "no response": ({"rotation_1": None}, ("no response", "rotation_1", "add one")),
    "no unit": ({"rotation_1": (ROTATION, None)}, ("rotation_1", "'units'", "'rad'")),
    "wrong unit": ({"rotation_1": (ROTATION, "m")}, ("rotation_1", "'m'", "'rad' is needed", "deg")),
    "unknown unit": ({"base_acceleration_x": (BASE, "gees")}, ("gees", "not known", "'g'")),
    "a gap": ({"rotation_1": (holed(ROTATION), "rad")}, ("rotation_1", "2.005 s and 2.095 s", "cut")),
    "a gap of the base": (
        {"base_acceleration_x": (holed(BASE), "m s-2")},
        ("base_acceleration_x", "2.005 s"),
    ),
    "nothing measured": ({"rotation_1": (ROTATION * np.nan, "rad")}, ("rotation_1", "3000 of 3000", "leave")),
    "a reset clock": ({"time": (bad_time(1000, -3.0), "s")}, ("4.995 s to 2 s", "reset", "split")),
    "a standing clock": ({"time": (bad_time(1000, -STEP), "s")}, ("twice", "split")),
    "missing samples": ({"time": (bad_time(1000, 0.1), "s")}, ("20 sample(s) are missing", "4.995 s", "cut")),
    "jitter": ({"time": (TIME + 2e-4 * (np.arange(COUNT) % 2), "s")}, ("not uniform", "resample")),
    "time in metres": ({"time": (TIME, "m")}, ("time", "'m'", "'s' is needed")),
    "words": ({"rotation_1": (np.full(COUNT, "x"), "rad")}, ("rotation_1", "not numbers")),
}


@pytest.mark.parametrize("kind", BAD_FILES)
def test_bad_files(kind: str, tmp_path: Path) -> None:
    changes, words = BAD_FILES[kind]
    with pytest.raises(InputError) as error:
        read_recording(stored(tmp_path, dataset(**changes)))
    sentence = str(error.value)
    assert all(word in sentence for word in ("test_1.nc", *words)), sentence
    assert "\n" not in sentence


BAD_MAPS: dict[str, tuple[str, str, tuple[str, ...]]] = {
    "no such column": ("'acc'", "'ac'", ("'ac'", "base_acceleration_x", "did you mean 'acc'")),
    "no such channel": ("rotation_1", "rotation1", ("rotation1", "did you mean 'rotation_1'")),
    "wrong unit": ("'mrad'", "'mm'", ("rotation_1", "'mm'", "'rad' is needed")),
    "sign of two": ("sign = -1", "sign = 2", ("sign", "2", "1 or -1")),
    "two clocks": ("title", "time_step = 0.005\ntitle", ("time_step and time", "both")),
    "no clock": ("time = { column = 't', unit = 's' }", "", ("time_step and time", "neither")),
    "comma for decimals and columns": ("title", "decimal = ','\ntitle", ("decimal and delimiter", "';'")),
    "another decimal": ("title", "decimal = ';'\ntitle", ("decimal", "';'")),
    "a level without number": (
        "rotation_1",
        "level_acceleration_x",
        ("level by level", "level_acceleration_x_0"),
    ),
    "unknown key": ("title", "titel", ("titel", "did you mean 'title'")),
}


@pytest.mark.parametrize("kind", BAD_MAPS)
def test_bad_descriptions(kind: str, written: Callable[[str, str], Path]) -> None:
    old, new, words = BAD_MAPS[kind]
    with pytest.raises(InputError) as error:
        read_recording(mapped(written, CSV.replace(old, new, 1)))
    assert all(word in str(error.value) for word in ("test_2", *words)), str(error.value)


def test_a_misspelt_response_is_told_with_the_right_name(tmp_path: Path) -> None:
    data = dataset().rename(rotation_1="Rotation_1")
    with pytest.raises(InputError, match=r"no response \(channels: base.*'Rotation_1' is no .* mean 'rotation_1'"):
        read_recording(stored(tmp_path, data))


def test_files_that_are_none(tmp_path: Path, written: Callable[[str, str], Path]) -> None:
    path = stored(tmp_path, dataset())
    with pytest.raises(InputError, match=r"does not exist; did you mean 'test_1.nc'"):
        read_recording(tmp_path / "test_2.nc")
    whole = path.read_bytes()
    path.write_bytes(whole[: len(whole) // 2])
    with pytest.raises(InputError, match=r"test_1\.nc: not a readable netCDF file"):
        read_recording(path)
    with pytest.raises(InputError, match=r"'.dat' is not known; known: .nc"):
        read_recording(written("test.dat", "1 2 3"))
    with pytest.raises(InputError, match=r"lonely.toml does not exist"):
        read_recording(written("lonely.csv", "t,a\n0,1\n"))


AHEAD = round(0.1 / STEP)
SUSPECT: dict[str, tuple[dict[str, Any], str]] = {
    "g declared as m s-2": ({"base_acceleration_x": (BASE / GRAVITY, "m s-2")}, "in g, declared as m s-2"),
    "degrees declared as rad": (
        # the equation is linear in rotation, base and alpha together: a more slender block
        {"rotation_1": (np.degrees(0.3 * ROTATION), "rad"), "base_acceleration_x": (0.3 * BASE, "m s-2")},
        "is the rotation in degrees, declared as rad",
    ),
    "beyond lying flat": ({"rotation_1": (2 * np.degrees(ROTATION), "rad")}, "beyond lying flat"),
    "turned base": ({"base_acceleration_x": (-BASE, "m s-2")}, "wrong sign"),
    "turned rotation": ({"rotation_1": (-ROTATION, "rad")}, "wrong sign"),
    "response ahead": ({"rotation_1": (np.roll(ROTATION, -AHEAD), "rad")}, "ahead of base_acceleration_x"),
    "gravity in the vertical": ({"base_acceleration_z": (GRAVITY + 0.1 * BASE, "m s-2")}, "gravity is in it"),
    "cm s-2 declared as m s-2": ({"base_acceleration_x": (100 * BASE, "m s-2")}, "more than a shake table"),
    "a dead sensor": ({"rotation_1": (0 * ROTATION, "rad")}, "zero throughout"),
}


@pytest.mark.parametrize("kind", SUSPECT)
def test_suspicions_are_named(kind: str, tmp_path: Path) -> None:
    changes, words = SUSPECT[kind]
    found = read_recording(stored(tmp_path, dataset(**changes)))
    assert any(words in suspicion for suspicion in found.suspicions), found.suspicions


def test_an_upper_body_may_rock_against_the_one_that_carries_it(tmp_path: Path) -> None:
    turned = {"rotation_2": (-ROTATION, "rad")}
    assert read_recording(stored(tmp_path, dataset(**turned))).suspicions == ()
    assert read_recording(stored(tmp_path, dataset(rotation_2=(0 * ROTATION, "rad")))).suspicions != ()


def test_the_recordings_at_hand() -> None:
    folder = data_folder()
    files = sorted(folder.glob("recordings/concealed/*/train_1.nc")) if folder else []
    building = sorted(folder.glob("recordings/rubber_isolated_building/*.nc")) if folder else []
    if not files or not building:
        pytest.skip("the recordings are not at hand")
    for path in [*files, *building]:
        found = read_recording(path)
        assert found.time[-1] > 5.0 and found.suspicions == ()
    assert found.channels["level_acceleration_x"].shape == (6, found.time.size)
    assert found.levels == ("0", "1", "2", "3", "4", "5")


def test_the_table_of_the_page_is_read_as_the_page_maps_it(written: Callable[[str, str], Path]) -> None:
    page = (Path(__file__).resolve().parents[2] / "docs" / "recordings.md").read_text("utf-8")
    table = page.partition("```text\n")[2].partition("```")[0]
    mapping = page.partition("A data logger's CSV")[2].partition("```toml\n")[2].partition("```")[0]
    rows = "".join(f"{5 * k};0,1;-0,5;0,2;0,3\n" for k in range(2, 30))
    written("run_1.toml", mapping)
    found = read_recording(written("run_1.csv", table + rows))
    assert found.time_step == 0.005 and found.levels == ("0", "1")
    assert found.channels["rotation_1"][-1] == pytest.approx(np.radians(0.5))
    assert found.channels["level_acceleration_x"][:, -1] == pytest.approx([0.2 * GRAVITY, 0.3 * GRAVITY])


def test_a_motion_of_the_base_is_used_where_the_sensors_of_the_body_fail(tmp_path: Path) -> None:
    lost = np.where(np.arange(ROTATION.size) < ROTATION.size // 3, ROTATION, np.nan)
    path = stored(tmp_path, dataset(rotation_1=(lost, "rad")))
    found = read_recording(path, base_only=True)
    assert found.time.size == ROTATION.size and set(found.channels) == {"base_acceleration_x"}
    assert read_recording(path).time.size < ROTATION.size


def test_a_dead_channel_and_one_named_twice_are_suspected(tmp_path: Path) -> None:
    dead = read_recording(stored(tmp_path, dataset(rotation_2=(0 * ROTATION + 0.02, "rad"))))
    assert any("rotation_2 stays at 0.02 throughout" in said for said in dead.suspicions)
    twice = read_recording(stored(tmp_path, dataset(rotation_2=(ROTATION, "rad"))))
    assert any("rotation_2 holds the samples of rotation_1" in said for said in twice.suspicions)
