"""The command line as a user meets it: what it prints, writes and refuses, and its exit codes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from typer.testing import CliRunner, Result
from xarray.backends.file_manager import FILE_CACHE

from rocking.commands import app
from study.open import open_study
from tests.study.plans import plan_text

SPECIMEN = """
title = "wall 3"
model = "housner"
[parameters]
height = "1.8 m"
width = "0.4 m"
mass = 800
[initial]
rotation_1 = "4 deg"
"""


def rocking(*words: object) -> Result:
    return CliRunner().invoke(app, [str(word) for word in words])


@pytest.fixture(autouse=True)
def current_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "120")


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a finished study."""
    home = tmp_path_factory.mktemp("finished")
    (home / "small.toml").write_text(plan_text())
    result = rocking("run", home / "small.toml", "--results", home / "results")
    assert result.exit_code == 0, result.output
    assert "168 cells" in result.stdout
    return home / "results" / "small"


def test_plan_prints_what_it_costs() -> None:
    Path("small.toml").write_text(plan_text())
    result = rocking("plan", "small.toml")
    assert result.exit_code == 0
    for word in ("aspect_ratio", "top_mass", "168", "blocks", "cube", "memory a task", "time", "on one core"):
        assert word in result.stdout
    lines = result.stdout.splitlines()
    for name, value, source in (("height", "1.8", "plan"), ("gravity", "9.80665", "default"), ("tail", "2", "plan")):
        assert any(name in line and value in line and source in line for line in lines), name
    assert not Path("results").exists()


def test_run_goes_on_without_a_flag(finished: Path) -> None:
    plan = finished.parent.parent / "small.toml"
    result = rocking("run", plan, "--results", finished.parent, "--scheduler", "synchronous")
    assert result.exit_code == 0 and "0 computed" in result.stdout


def test_status_check_export_and_map(finished: Path) -> None:
    said = rocking("status", finished).stdout
    assert "168 of 168 cells (100.0%)" in said
    with xr.open_dataset(finished / "cube.nc") as cube:
        status = cube["status"].values
    counts = {word: int(np.sum(status == k)) for k, word in ((1, "at rest"), (2, "rocked"), (3, "overturned"))}
    assert sum(counts.values()) == 168
    assert "cells: " + ", ".join(f"{word} {count}" for word, count in counts.items()) in said
    assert "equal bit for bit" in rocking("check", finished, "--cells", 20).stdout
    result = rocking("export", finished, "--out", "cells.csv", "--select", "pga=0.3 g", "--output", "impacts")
    assert result.exit_code == 0, result.output
    lines = Path("cells.csv").read_text().splitlines()
    assert len(lines) == 1 + 21 and "impacts" in lines[0] and "peak_rotation" not in lines[0]
    result = rocking("map", finished, "--x", "aspect_ratio", "--y", "pga", "--out", "maps")
    assert result.exit_code == 0, result.output
    for name in ("overturning_map", "onset_map"):
        assert (Path("maps") / f"{name}.png").stat().st_size > 5000
    result = rocking("slices", finished, "peak_rotation", "--x", "pga", "--select", "top_mass=1 t", "--out", "peak.png")
    assert result.exit_code == 0, result.output
    assert Path("peak.png").stat().st_size > 5000
    assert "at ridgecrest_2019_clc, top mass 1000 kg" in result.stdout
    for entry, words in (("top_mass=1", "has no unit"), ("top_mass=2 t", "1000 kg and 3000 kg"), ("pga=9 g", "0.8 g")):
        refused = rocking("slices", finished, "peak_rotation", "--x", "aspect_ratio", "--select", entry)
        assert refused.exit_code == 2 and words in refused.stderr
    near = rocking("slices", finished, "peak_rotation", "--x", "pga", "--select", "top_mass=1.9 t", "--nearest")
    assert near.exit_code == 0 and "top mass 1000 kg" in near.stdout
    wrong = rocking("slices", finished, "peak_rotaton", "--x", "pga")
    assert wrong.exit_code == 2 and "did you mean 'peak_rotation'" in wrong.stderr


def test_what_is_no_cube_is_refused_and_a_smaller_cube_is_one(finished: Path) -> None:
    xr.Dataset({"width": ("sample", np.ones(3))}).to_netcdf("posterior.nc")
    for words in (("map",), ("check",), ("slices", "--x", "pga"), ("export", "--out", "a.nc")):
        name, *rest = words
        refused = rocking(name, "posterior.nc", *(["peak_rotation"] if name == "slices" else []), *rest)
        assert refused.exit_code == 2 and "posterior.nc is no cube of a study" in refused.stderr, refused.output
    kept = rocking("export", finished, "--out", "small.nc", "--output", "peak_rotation")
    assert kept.exit_code == 0, kept.output
    drawn = rocking("slices", "small.nc", "peak_rotation", "--x", "pga", "--out", "peak.png")
    assert drawn.exit_code == 0, drawn.output


def test_check_says_when_a_cube_is_wrong(finished: Path) -> None:
    import shutil

    import netCDF4

    shutil.copytree(finished, "copy")
    with netCDF4.Dataset("copy/cube.nc", "a") as dataset:
        dataset["impacts"][:] = 77
    result = rocking("check", "copy", "--cells", 10)
    assert result.exit_code == 1 and "77" in result.stdout


def test_a_failed_block_gives_exit_code_1(monkeypatch: pytest.MonkeyPatch) -> None:
    import study.task
    import study.timing

    def failing(*_: object) -> None:
        raise ZeroDivisionError("division by zero")

    for room in (study.task, study.timing):
        monkeypatch.setattr(room, "evaluate", failing)
    Path("small.toml").write_text(plan_text())
    result = rocking("run", "small.toml")
    assert result.exit_code == 1
    assert "blocks failed" in result.stdout
    assert list(Path("results/small/failed").glob("*.txt"))
    assert "ZeroDivisionError" in rocking("status", "results/small").stdout


def test_simulate_writes_a_history_that_is_a_recording() -> None:
    from rocking import read_recording

    Path("wall.toml").write_text(SPECIMEN)
    result = rocking("simulate", "wall.toml", "--motion", "ridgecrest_2019_clc", "--out", "h.nc", "--figure", "h.png")
    assert result.exit_code == 0, result.output
    assert Path("h.png").stat().st_size > 5000
    with xr.open_dataset("h.nc") as history:
        assert history["rotation_1"].dims == ("time",)
        np.testing.assert_allclose(history["rotation_1"][0], np.radians(4.0))
        words = history["event_kind"].attrs["flag_meanings"].split()
        impacts = history["event_time"][history["event_kind"] == words.index("impact")]
        assert impacts.size > 3
        # between two samples around an impact the rotation changes sign or touches zero
        at = np.searchsorted(history["time"].values, impacts.values[:3])
        rotation = history["rotation_1"].values
        assert np.all(rotation[at - 1] * rotation[at] <= 1e-6)
    recording = read_recording("h.nc")
    assert {"rotation_1", "base_acceleration_x"} <= set(recording.channels)
    assert not recording.band_limited
    again = rocking("simulate", "wall.toml", "--motion", "h.nc", "--out", "again.nc")
    assert again.exit_code == 0, again.output
    with xr.open_dataset("h.nc") as one, xr.open_dataset("again.nc") as two:
        n = one.sizes["time"]
        np.testing.assert_allclose(two["rotation_1"][:n], one["rotation_1"], atol=1e-9)


def test_simulate_takes_a_motion_that_holds_the_base_alone() -> None:
    Path("wall.toml").write_text(SPECIMEN)
    time = 0.01 * np.arange(201)
    base = xr.Dataset(
        {"base_acceleration_x": ("time", 3.0 * np.sin(6.0 * time), {"units": "m s-2"})},
        {"time": ("time", time, {"units": "s"})},
    )
    base.to_netcdf("table.nc")
    result = rocking("simulate", "wall.toml", "--motion", "table.nc", "--out", "history.nc", "--duration", 2)
    assert result.exit_code == 0, result.output
    with xr.open_dataset("history.nc") as history:
        np.testing.assert_allclose(history["base_acceleration_x"], base["base_acceleration_x"], rtol=0, atol=1e-12)


def test_simulate_free_rocking() -> None:
    Path("wall.toml").write_text(SPECIMEN)
    assert rocking("simulate", "wall.toml", "--duration", 2, "--out", "free.nc").exit_code == 0
    with xr.open_dataset("free.nc") as history:
        assert float(history["time"][-1]) == pytest.approx(2.0)
        assert float(np.abs(history["rotation_1"]).max()) <= np.radians(4.0) * (1 + 1e-12)
        assert np.all(history["base_acceleration_x"] == 0.0)


def test_motions_lists_reads_draws_and_converts() -> None:
    assert rocking("motions").stdout.count("PGA") == 3
    result = rocking("motions", "ridgecrest_2019_clc", "--figure", "m.png", "--out", "m.nc")
    assert result.exit_code == 0, result.output
    assert "Arias intensity" in result.stdout and Path("m.png").stat().st_size > 5000
    assert rocking("motions", "m.nc").exit_code == 0


@pytest.mark.parametrize(
    ("words", "part"),
    [
        (("run", "no.toml"), "no.toml"),
        (("plan", "no.toml"), "no.toml"),
        (("run", "small.toml", "--scheduler", "thread"), "did you mean 'threads'"),
        (("run", "small.toml", "--workers", "0"), "give 1 or more"),
        (("status", "results/none"), "holds no study"),
        (("check", "results/none"), "run the study first"),
        (("check", "results/none", "--seed", "-1"), "seed is -1: give 0 or more"),
        (("map", "results/none"), "run the study first"),
        (("export", "results/none", "--out", "a.csv"), "run the study first"),
        (("simulate", "wall.toml", "--out", "h.nc"), "no motion and no duration"),
        (("simulate", "wall.toml", "--out", "h.csv", "--duration", "1"), "end the name in .nc"),
        (("simulate", "wall.toml", "--out", "h.nc", "--duration", "-1"), "give a positive time"),
        (
            ("simulate", "wall.toml", "--out", "h.nc", "--duration", "1", "--integrator", "lane"),
            "did you mean",
        ),
        (("simulate", "wall.toml", "--out", "h.nc", "--motion", "ridgecrest_2019_cl"), "did you mean"),
        (("motions", "no_such_record"), "no_such_record"),
        (("motions", "--figure", "m.png"), "name one"),
        (("motions", "ridgecrest_2019_clc", "--figure", "m.xyz"), "end the name in"),
    ],
)
def test_mistakes_are_one_sentence_and_exit_code_2(words: tuple[str, ...], part: str) -> None:
    Path("small.toml").write_text(plan_text())
    Path("wall.toml").write_text(SPECIMEN)
    result = rocking(*words)
    assert result.exit_code == 2, result.output
    assert part in result.stderr
    assert result.stderr.startswith("error: ") and result.stderr.count("\n") == 1
    assert sorted(path.name for path in Path().iterdir()) == ["small.toml", "wall.toml"]


@pytest.mark.parametrize(
    ("entry", "part"),
    [
        ("pga", "write axis=value"),
        ("pgs=1", "did you mean 'pga'"),
        ("pga=0.3 kg", "kg"),
        ("top_mass=heavy", "top_mass"),
    ],
)
def test_bad_selections(finished: Path, entry: str, part: str) -> None:
    result = rocking("export", finished, "--out", "a.csv", "--select", entry)
    assert result.exit_code == 2 and part in result.stderr
    assert not Path("a.csv").exists()


@pytest.mark.parametrize(
    "words",
    [
        ("export", "--out", "a.csv"),
        ("map", "--out", "maps"),
        ("slices", "peak_rotation", "--x", "pga", "--out", "a.png"),
    ],
)
@pytest.mark.parametrize("refused", [(), ("--select", "pgs=1")])
def test_a_command_closes_the_cube(
    finished: Path, words: tuple[str, ...], refused: tuple[str, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also when it refuses: a file that is left to the garbage collection crashed the next one that was opened."""
    name, *rest = words
    before, kept, opened = set(FILE_CACHE), [], open_study

    def kept_open(*args: Any, **options: Any) -> xr.Dataset:
        kept.append(opened(*args, **options))  # or the last reference to it closes it
        return kept[-1]

    monkeypatch.setattr("study.open.open_study", kept_open)
    result = rocking(name, finished, *rest, *refused)
    assert (result.exit_code == 2) == bool(refused), result.output
    assert set(FILE_CACHE) <= before and kept


def test_what_is_unusual_is_a_warning_or_refused_if_strict() -> None:
    Path("tall.toml").write_text(plan_text().replace('"1.8 m"', '"1500 m"'))
    warned = rocking("plan", "tall.toml")
    assert warned.exit_code == 0 and "warning: height = 1500 m is unusually large" in warned.stderr
    for command in ("plan", "run"):
        refused = rocking(command, "tall.toml", "--strict")
        assert refused.exit_code == 2 and "height = 1500 m" in refused.stderr and "--strict" in refused.stderr
    assert not Path("results").exists()
    warned = rocking("run", "tall.toml")
    assert warned.output.count("unusually large") == warned.stderr.count("unusually large") == 1, warned.output
    Path("wall.toml").write_text(SPECIMEN.replace("4 deg", "400 deg"))
    refused = rocking("simulate", "wall.toml", "--duration", 1, "--out", "h.nc", "--strict")
    assert refused.exit_code == 2 and "400 deg" in refused.stderr and not Path("h.nc").exists()


def test_simulate_refuses_before_the_work_what_it_would_refuse_after() -> None:
    Path("wall.toml").write_text(SPECIMEN)
    free = ("simulate", "wall.toml", "--duration", 1, "--out", "h.nc")
    for more, words in ((("--figure", "h.xyz"), "end the name in"), (("--scale", 0), "leaves no motion")):
        refused = rocking(*free, *more)
        assert refused.exit_code == 2 and words in refused.stderr and not Path("h.nc").exists()


@pytest.mark.parametrize(
    ("option", "value", "words"),
    [
        *(("--scale", value, "scale is") for value in ("nan", "inf", "1e300")),
        *((option, "1_5", "is no number") for option in ("--scale", "--duration", "--displacement-high-pass")),
        *(("--duration", value, "duration is") for value in ("1e-300", "1e30", "1e7")),
    ],
)
def test_simulate_refuses_numbers_of_no_sense(option: str, value: str, words: str) -> None:
    Path("wall.toml").write_text(SPECIMEN)
    refused = rocking("simulate", "wall.toml", "--motion", "ridgecrest_2019_clc", "--out", "h.nc", option, value)
    assert refused.exit_code == 2 and words in refused.stderr and not Path("h.nc").exists()


def test_whole_numbers_are_written_as_such(finished: Path) -> None:
    for words in (
        ("check", finished, "--cells"),
        ("run", "small.toml", "--workers"),
        ("plan", "small.toml", "--workers"),
    ):
        refused = rocking(*words, "1_0")
        assert refused.exit_code == 2 and "is no whole number" in refused.stderr


def test_simulate_suspects_a_motion_beyond_any_earthquake() -> None:
    Path("wall.toml").write_text(SPECIMEN)
    words = ("simulate", "wall.toml", "--motion", "ridgecrest_2019_clc", "--scale", 100, "--out", "h.nc")
    refused = rocking(*words, "--strict")
    assert refused.exit_code == 2 and "the motion peaks at" in refused.stderr and not Path("h.nc").exists()
    warned = rocking(*words)
    assert warned.exit_code == 0 and "warning: the motion peaks at" in warned.stderr


@pytest.mark.parametrize("tail", ["1e7 s", "1e9 s"])
def test_a_run_without_end_is_refused(tail: str) -> None:
    Path("long.toml").write_text(plan_text(tail=tail))
    refused = rocking("plan", "long.toml")
    assert refused.exit_code == 2 and "shorten the motion or its tail" in refused.stderr


def test_a_set_of_motions_from_plan_to_figures() -> None:
    plan = plan_text(
        motion='files = ["ridgecrest_2019_c*", "ridgecrest_2019_tow2"]\nvertical = false',
        aspect="values = [0.15]",
        pga="linspace = [0.1, 1.0, 8], unit = 'g'",
    )
    Path("set.toml").write_text(plan.replace("small", "set"))
    assert rocking("run", "set.toml").exit_code == 0
    words = ("--event", "peak_rotation > 1 deg")
    few = rocking("fragility", "results/set", *words, "--measure", "pgv", "--over", "top_mass")
    assert few.exit_code == 0 and "peak_rotation > 0.01745 rad" in few.stdout and "3000 kg" in few.stdout
    assert rocking("ida", "results/set", "peak_rotation").exit_code == 0
    cloud = rocking("cloud", "results/set", "peak_rotation", *words)
    assert cloud.exit_code == 0 and "pgv_over_pga" in cloud.stdout
    for name in ("fragility", "ida", "cloud", "measures"):
        assert (Path("results/set") / f"{name}.png").stat().st_size > 5000
    refused = rocking("spectra", "results/set")
    assert refused.exit_code == 2 and "onset_acceleration changes along top_mass too" in refused.stderr
    assert "did you mean 'pgv'" in rocking("fragility", "results/set", "--measure", "pvg").stderr


def test_sensitivity_from_plan_to_table() -> None:
    axes = "sample = { morris = 10, seed = 1, parameters = { aspect_ratio = [0.15, 0.3], pga = [2, 9] } }"
    text = plan_text(outputs='"overturned", "peak_rotation"')
    head, tail = text.split("[axes]")[0], text[text.index("[outputs]") :]
    Path("sens.toml").write_text(f"{head}[axes]\n{axes}\n{tail}")
    result = rocking("sensitivity", "sens.toml", "--event", "peak_rotation > 2 deg")
    assert result.exit_code == 0, result.output
    assert "30 cells" in result.stdout and "mu*" in result.stdout and "peak_rotation > 0.03491 rad" in result.stdout
    with xr.open_dataset("results/small/sensitivity.nc") as found:
        assert found["mu_star"].dims == ("output", "motions", "parameter") and found.attrs["kind"] == "morris"
    again = rocking("sensitivity", "sens.toml", "--output", "overturned")
    assert "0 computed" in again.stdout and "tornado_peak" not in again.stdout
    refused = rocking("sensitivity", "sens.toml", "--output", "overturnd")
    assert refused.exit_code == 2 and "did you mean 'overturned'" in refused.stderr
    Path("plain.toml").write_text(plan_text())
    assert "saltelli or morris" in rocking("sensitivity", "plain.toml").stderr
