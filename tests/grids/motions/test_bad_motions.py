"""Damaged and misdescribed motions: one sentence with what, where, value and cure."""

from pathlib import Path

import numpy as np
import pytest

from grids.motions import find, read_motion
from models.errors import InputError

CASES = {}


def case(*facts, **options):
    def keep(build):
        CASES[build.__name__] = (build, facts, options)
        return build

    return keep


def damaged(path, old, new, count=1):
    path.write_text(path.read_text().replace(old, new, count))
    return path


@case("ridgecrest_2019_cl", "did you mean 'ridgecrest_2019_clc'?")
def misspelt_shipped_name(files):
    return "ridgecrest_2019_cl"


@case("nowhere.at2", "current folder", "ROCKING_DATA", "shipped: ridgecrest_2019_ccc")
def missing_file(files):
    return "nowhere.at2"


@case("no such file", "did you mean 'RSN7_SOME_STA000.AT2'?")
def missing_file_with_a_full_path(files):
    return files.at2_record().with_name("RSN7_SOMM_STA000.AT2")


@case("x.sac", "'.sac'", ".at2")
def unknown_ending(files):
    return files.text("x.sac", "1 2 3")


@case("x.AT2", "empty")
def empty_file(files):
    return files.text("x.AT2", "\n")


@case("x.AT2", "not a text file")
def binary_file_named_at2(files):
    (files.folder / "x.AT2").write_bytes(b"\0\1\2" * 100)
    return files.folder / "x.AT2"


@case("x.AT2", "3 lines", "4 before")
def at2_header_cut(files):
    return files.text("x.AT2", "a\nb\nc\n")


@case("x.AT2", "NPTS says 700", "600")
def at2_wrong_npts(files):
    return files.at2("x.AT2", files.north, "000", npts=700)


@case("x.AT2", "NPTS says 600", "300", "cut short")
def at2_truncated(files):
    path = files.at2("x.AT2", files.north, "000")
    path.write_text("\n".join(path.read_text().splitlines()[: 4 + 60]))
    return path


@case("x.AT2", "value 12", "'0.1X'", "not a number")
def at2_not_a_number(files):
    path = files.at2("x.AT2", files.north, "000")
    lines = path.read_text().splitlines()
    lines[6] = lines[6].replace(lines[6].split()[1], "0.1X")
    path.write_text("\n".join(lines))
    return path


@case("x.AT2", "not finite", "number 3")
def at2_nan(files):
    values = files.north.copy()
    values[2] = np.nan
    return files.at2("x.AT2", values, "000")


@case("x.AT2", "time step is 0 s")
def at2_zero_step(files):
    return files.at2("x.AT2", files.north, "000", step=0.0)


@case("x.AT2", "line 4", "NPTS and DT", "hello")
def at2_no_npts(files):
    return files.at2("x.AT2", files.north, "000", header="hello")


@case("x.AT2", "UNITS OF G", "CM/S/S")
def at2_other_unit(files):
    return files.at2("x.AT2", files.north, "000", units="UNITS OF CM/S/S")


@case("x.AT2", "not acceleration", "VELOCITY")
def at2_velocity(files):
    return damaged(files.at2("x.AT2", files.north, "000"), "ACCELERATION", "VELOCITY")


@case("x.AT2", "every sample is zero")
def at2_silent(files):
    return files.at2("x.AT2", 0 * files.north, "000")


@case("x.AT2", "3 sample(s)", "10")
def at2_too_short(files):
    return files.at2("x.AT2", files.north[:3] + 1, "000")


@case("x.AT2", "unit stated right", "peak is")
def at2_in_centimetres(files):
    return files.at2("x.AT2", 981 * files.north, "000")


@case("time step", "000 0.01 s", "090 0.02 s")
def at2_components_of_different_step(files):
    first = files.at2_record()
    files.at2("RSN7_SOME_STA090.AT2", files.east, "090", step=0.02)
    return first


@case("no horizontal component", "UP")
def at2_only_the_vertical(files):
    return files.at2("x_UP.AT2", files.up, "UP")


@case("UP", "-V", "both vertical")
def at2_two_verticals(files):
    first = files.at2_record()
    files.at2("RSN7_SOME_STA-V.AT2", files.up, "-V")
    return first


@case("no vertical component", "000", "vertical = false", vertical=True)
def vertical_demanded_and_missing(files):
    return files.at2("x.AT2", files.north, "000")


@case("no component 'nort'", "did you mean 'north'?", component="nort")
def unknown_component(files):
    return "ridgecrest_2019_clc"


@case("'up' is vertical", "east, north", component="up")
def vertical_as_horizontal_component(files):
    return "ridgecrest_2019_clc"


@case("'unit' cannot be stated for netCDF", "states it itself")
def statement_about_a_file_that_states_itself(files):
    return {"file": "ridgecrest_2019_clc", "unit": "g"}


@case("'unti' cannot be stated", "did you mean 'unit'?")
def misspelt_word_of_a_statement(files):
    return {"file": f"{files.npz(toml=None)}:q_sta_NS", "unti": "g"}


@case("component 3 (Up)", "600 samples", "500", "cut short")
def v2a_truncated(files):
    path = files.v2a()
    path.write_text("\n".join(path.read_text().splitlines()[:-130]))
    return path


@case("component 1 (N10E)", "peak of", "damaged")
def v2a_peak_differs(files):
    return files.v2a(lie=50.0)


@case("component 1", "no GeoNet V2A")
def v2a_other_content(files):
    return files.text("x.V2A", "a line\n" * 60)


@case("channel 360", "600 samples", "592", "cut short")
def v1_line_missing(files):
    path = files.v1()
    lines = path.read_text().splitlines()
    start = next(i for i, line in enumerate(lines) if "360 Deg" in line)
    del lines[start + 5]
    path.write_text("\n".join(lines))
    return path


@case("unit 'furlong'", "channel 90")
def v1_unknown_unit(files):
    return files.v1(unit="furlong")


@case("x.V1", "no CSMIP volume 1")
def v1_other_content(files):
    return files.text("x.V1", "a line\n" * 60)


@case("x.nc", "not a readable netCDF file", "cut short")
def netcdf_truncated(files):
    path = files.netcdf()
    path.write_bytes(path.read_bytes()[:3000])
    return path


@case("acceleration_north", "no units", "'m s-2'")
def netcdf_without_units(files):
    return files.netcdf(units=None)


@case("acceleration_north", "unit 'm'", "m s-2")
def netcdf_displacement_unit(files):
    return files.netcdf(units="m")


@case("time states no units", "units = 's'")
def netcdf_without_time_units(files):
    return files.netcdf(time_units=None)


@case("no variable acceleration_NAME", "rename")
def netcdf_without_motion(files):
    return files.netcdf(variables={"rotation_1": files.north})


@case("1 sample(s) are missing", "2.99 s", "3.01 s", "cut the record there")
def netcdf_with_a_gap(files):
    times = np.arange(600) * 0.01
    times[300:] += 0.01
    return files.netcdf(times=times)


@case("acceleration_north", "1 of 600", "number 43")
def netcdf_with_a_fill_value(files):
    values = files.north.copy()
    values[42] = np.nan
    return files.netcdf(variables={"acceleration_north": values})


@case("no key 'q_sta_N'", "did you mean 'q_sta_NS'?")
def npz_unknown_key(files):
    return f"{files.npz()}:q_sta_N"


@case("3 arrays", "x.npz:q_sta_NS")
def npz_without_key(files):
    return files.npz()


@case("x.npz", "no unit and no time step", "x.toml")
def npz_without_statement(files):
    return f"{files.npz(toml=None)}:q_sta_NS"


@case("x.toml", "time_stepp", "time_step")
def npz_misspelt_statement(files):
    path = files.npz(toml='time_step = 0.01\ntime_stepp = 0.01\nunit = "g"\n')
    return f"{path}:q_sta_NS"


@case("x.npz", "cut short")
def npz_truncated(files):
    path = files.npz()
    path.write_bytes(path.read_bytes()[:2000])
    return f"{path}:q_sta_NS"


@case("q_table", "shape (600, 2)", "one row")
def npz_two_dimensional(files):
    return f"{files.npz(q_table=np.ones((600, 2)))}:q_table"


@case("q_words", "not numbers")
def npz_words(files):
    return f"{files.npz(q_words=np.array(['a'] * 20))}:q_words"


@case("x.npz:q_NS", "the table says 0.5 g", "unit", "TOML")
def npz_peak_differs_from_the_table(files):
    path = files.npz(toml=None, q_NS=files.north)
    files.text("x.csv", "id,npts,dt_s,H1,PGA_H1_g\nq,600,0.005,NS,0.5\n")
    return f"{path}:q_NS"


@case("x.toml", "does not exist")
def csv_without_toml(files):
    path = files.csv()
    path.with_suffix(".toml").unlink()
    return path


@case("x.toml", "not valid TOML", "line 1")
def csv_with_broken_toml(files):
    return files.csv(toml="time_step = = 3\n")


@case("no column 'acc'", "north", "t, u_m")
def csv_unknown_column(files):
    return files.csv(toml='time_step = 0.01\n[columns]\nnorth = { column = "acc", unit = "g" }\n')


@case("x.toml", "exactly one of time_step and time", "neither")
def csv_without_sampling(files):
    return files.csv(toml='[columns]\nnorth = { column = 2, unit = "g" }\n')


@case("x.toml", "north", "unit", "missing")
def csv_without_unit(files):
    return files.csv(toml="time_step = 0.01\n[columns]\nnorth = { column = 2 }\n")


@case("north", "unit 'stone'")
def csv_unknown_unit(files):
    return files.csv(toml='time_step = 0.01\n[columns]\nnorth = { column = 2, unit = "stone" }\n')


@case("line 302", "1 column(s)", "number 2")
def csv_short_line(files):
    path = files.csv()
    lines = path.read_text().splitlines()
    lines[301] = "3.0"
    path.write_text("\n".join(lines))
    return path


@case("north", "number 5", "not finite", "cut the record")
def csv_gap(files):
    path = files.csv()
    lines = path.read_text().splitlines()
    lines[5] = "0.04,n/a,0.1"
    path.write_text("\n".join(lines))
    return path


@case("sign", "3")
def csv_sign_that_scales(files):
    return files.csv(toml='time_step = 0.01\n[columns]\nnorth = { column = 2, unit = "g", sign = 3 }\n')


@case("give 'file', 'pulse' or 'artificial'", "shape")
def table_without_file_or_pulse(files):
    return {"shape": "sine"}


@case("no component 'north'", "pulse", component="north")
def component_of_a_pulse(files):
    return {"pulse": {"shape": "sine", "amplitude": 1.0, "frequency": 1.0}}


@case("no vertical", "pulse", vertical=True)
def vertical_of_a_pulse(files):
    return {"pulse": {"shape": "sine", "amplitude": 1.0, "frequency": 1.0}}


@pytest.mark.parametrize("name", CASES)
def test_bad_motion_is_one_sentence(name, files):
    build, facts, options = CASES[name]
    source = build(files)
    with pytest.raises(InputError) as caught:
        read_motion(source, **options)
    sentence = str(caught.value)
    assert all(fact in sentence for fact in facts), sentence
    assert "\n" not in sentence and len(sentence) < 330, sentence


def test_a_glob_that_matches_nothing_says_so():
    with pytest.raises(InputError, match=r"no_such_\*\.AT2.*nothing matches"):
        find("no_such_*.AT2")


def test_there_are_enough_kinds():
    assert len(CASES) >= 40


def test_two_columns_of_one_name_are_told_apart_by_number(tmp_path: Path) -> None:
    lines = "".join(f"{0.01 * k:.2f},{k % 3},{k % 5}\n" for k in range(30))
    (tmp_path / "a.csv").write_text(f"t,acc,acc\n{lines}")
    described = 'time = { column = "t", unit = "s" }\n[columns]\nbase_acceleration_x = { column = %s, unit = "m/s2" }\n'
    (tmp_path / "a.toml").write_text(described % '"acc"')
    with pytest.raises(InputError, match="has 2 columns 'acc'"):
        read_motion(tmp_path / "a.csv")
    (tmp_path / "a.toml").write_text(described % "3")
    assert read_motion(tmp_path / "a.csv").pga == 4.0


def test_a_step_that_no_recorder_has_is_refused(tmp_path: Path) -> None:
    np.savez(tmp_path / "a.npz", x=np.ones(50))
    with pytest.raises(InputError, match="time step is 1e-07 s: give one from 1e-06 to 1 s"):
        read_motion({"file": str(tmp_path / "a.npz:x"), "time_step": "1e-7 s", "unit": "g"})
