"""Files and words that once ended in a traceback, a hang or gigabytes: each is one sentence now."""

from __future__ import annotations

import contextlib
import io
import os
import shutil
import struct
import subprocess
import sys
import time
import zipfile
from collections.abc import Callable
from pathlib import Path

import netCDF4
import numpy as np
import pytest

from grids.files import parse_toml
from grids.motions import read_motion
from grids.motions.locate import SHIPPED
from grids.netcdf_file import read_netcdf
from grids.recordings.read import read_recording
from grids.units import to_si
from models.errors import InputError
from study.export import export
from study.open import open_study
from study.run import run
from tests.study.cubes import EXAMPLE
from tests.study.plans import small_plan


@pytest.mark.parametrize(
    "text",
    [
        "1_ m",
        "1_5 m",
        "1s1e9dB,",
        "1e-320 m",
        "1e-200 m",
        "1e160 m",
        "1e300 m",
        "1e400 m",
        "-1e299 m",
        "１ m",
        "1" + "0" * 5000 + " m",
    ],
)
def test_words_that_are_no_lengths(text: str) -> None:
    with pytest.raises(InputError):
        to_si(text, "m", "width")


def test_infinity_and_whole_numbers_of_any_size() -> None:
    assert to_si("inf m", "m", "friction") == float("inf") and to_si("-inf m", "m", "x") == -float("inf")
    with pytest.raises(InputError, match="hundreds of digits"):
        to_si(10**400, "m", "width")


@pytest.mark.parametrize("text", ["a = " + "[" * 3000, "a = " + "1" * 5000, "a = " + "{b=" * 3000])
def test_toml_of_no_sense(text: str) -> None:
    with pytest.raises(InputError, match="not valid TOML"):
        parse_toml(text)


def classic(count: int) -> bytes:
    """A netCDF-3 file of one variable of ``count`` samples that it does not hold."""
    name = struct.pack(">I", 4) + b"time"
    dimension = struct.pack(">II", 10, 1) + name + struct.pack(">I", count)
    variable = struct.pack(">II", 11, 1) + name + struct.pack(">III", 1, 0, 0) + struct.pack(">I", 0)
    return (
        b"CDF\x01" + bytes(4) + dimension + bytes(8) + variable + struct.pack(">III", 6, (8 * count) & 0xFFFFFFFF, 120)
    )


@pytest.mark.parametrize("count", [2**31 - 1, 10**9])
def test_a_netcdf_file_that_claims_gigabytes(tmp_path: Path, count: int) -> None:
    path = tmp_path / "large.nc"
    path.write_bytes(classic(count))
    with pytest.raises(InputError, match="not a readable netCDF file"):
        read_netcdf(path)


def test_no_flipped_byte_of_a_netcdf_file_does_harm(tmp_path: Path) -> None:
    """Every outcome is content or a sentence, in reasonable time, and the next file is read all the same."""
    whole = tmp_path / "whole.nc"
    with netCDF4.Dataset(whole, "w") as data:
        data.createDimension("time", 50)
        data.createVariable("time", "f8", ("time",), zlib=True)[:] = np.arange(50) * 0.01
    data_bytes = bytearray(whole.read_bytes())
    random = np.random.default_rng(7)
    damaged = tmp_path / "damaged.nc"
    begun = time.process_time()
    for _ in range(60):
        changed = data_bytes.copy()
        for at in random.integers(0, len(changed), 3):
            changed[at] = random.integers(0, 256)
        damaged.write_bytes(changed)
        with contextlib.suppress(InputError):
            read_netcdf(damaged)
    assert time.process_time() - begun < 60.0
    np.testing.assert_allclose(read_netcdf(whole).variables["time"].values, np.arange(50) * 0.01)


def test_a_reader_that_dies_is_one_sentence(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from grids import netcdf_file

    whole = tmp_path / "whole.nc"
    with netCDF4.Dataset(whole, "w"):
        pass
    read_netcdf(whole)
    reader = netcdf_file._READERS[0]
    monkeypatch.setattr(type(reader), "usable", True)
    reader.process.kill()
    with pytest.raises(InputError, match="broke off"):
        read_netcdf(whole)
    monkeypatch.undo()
    assert read_netcdf(whole).variables == {}


def test_a_cube_of_others_cannot_end_the_program(tmp_path: Path) -> None:
    """A header that claims gigabytes; a file without a seal is read by a process of its own first."""
    path = tmp_path / "cube.nc"
    path.write_bytes(classic(2**31 - 1))
    with pytest.raises(InputError, match=r"cube\.nc: not a readable netCDF file"):
        open_study(path)


@pytest.mark.parametrize("name", ["a\\b", os.fsdecode(b"\xff")])
def test_folders_that_the_netcdf_library_cannot_open(name: str, tmp_path: Path) -> None:
    """Refused with a sentence that can be printed, before anything is computed or written."""
    folder = tmp_path / name
    folder.mkdir()
    shutil.copy(SHIPPED / "ridgecrest_2019_clc.nc", folder / "m.nc")
    cube = open_study(EXAMPLE)
    uses: tuple[Callable[[], object], ...] = (
        lambda: read_motion(folder / "m.nc"),
        lambda: open_study(folder / "m.nc"),
        lambda: export(cube, folder / "e.nc"),
        lambda: run(small_plan(), results=folder),
    )
    for use in uses:
        with pytest.raises(InputError, match="takes no path with a backslash") as refused:
            use()
        str(refused.value).encode()
    assert [path.name for path in folder.iterdir()] == ["m.nc"]
    table = export(cube, folder / "e.csv")
    assert table.stat().st_size > 1000


@pytest.mark.parametrize("text", ["two", "0.001"])
def test_a_text_scale_factor(tmp_path: Path, text: str) -> None:
    path = tmp_path / "scale.nc"
    with netCDF4.Dataset(path, "w") as data:
        data.createDimension("time", 20)
        data.createVariable("time", "f8", ("time",))[:] = 0.01 * np.arange(20)
        variable = data.createVariable("base_acceleration_x", "i4", ("time",))
        variable[:] = np.arange(20)
        variable.scale_factor = text
    with pytest.raises(InputError, match=f"scale_factor of base_acceleration_x is '{text}', no number"):
        read_netcdf(path)


@pytest.mark.parametrize("limit", ["-v 16000000", "-t 3600"])
def test_limits_of_a_batch_system_are_kept(tmp_path: Path, limit: str) -> None:
    """They were to be raised, which is refused, and a good file was said to be damaged."""
    path = tmp_path / "good.nc"
    with netCDF4.Dataset(path, "w") as data:
        data.createDimension("time", 20)
        data.createVariable("time", "f8", ("time",))[:] = np.arange(20.0)
    read = f"from pathlib import Path; from grids.netcdf_file import read_netcdf; read_netcdf(Path('{path}'))"
    done = subprocess.run(
        ["bash", "-c", f'ulimit {limit}; "$0" -c "$1"', sys.executable, read], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr


def test_a_file_that_breaks_off_leaves_the_next_one_alone(tmp_path: Path) -> None:
    """What had been read of it once stayed in the pipe, and was taken for the content of the next file."""
    broken, whole = tmp_path / "broken.nc", tmp_path / "whole.nc"
    for path in (broken, whole):
        with netCDF4.Dataset(path, "w") as data:
            data.createDimension("time", 20)
            data.createVariable("time", "f8", ("time",))[:] = np.arange(20.0) + (path == broken)
            data.createVariable("x", "i4", ("time",), fletcher32=True)[:] = 123456789
    content = bytearray(broken.read_bytes())
    content[content.index(struct.pack("<i", 123456789))] ^= 1
    broken.write_bytes(content)
    with pytest.raises(InputError):
        read_netcdf(broken)
    np.testing.assert_array_equal(read_netcdf(whole).variables["time"].values, np.arange(20.0))


def test_time_over_two_dimensions(tmp_path: Path) -> None:
    path = tmp_path / "wide.nc"
    with netCDF4.Dataset(path, "w") as data:
        data.createDimension("time", 20)
        data.createDimension("two", 2)
        data.createVariable("time", "f8", ("time", "two"))[:] = 0.0
    for read in (read_recording, read_motion):
        with pytest.raises(InputError, match="time"):
            read(path)


def npz(path: Path, header_shape: tuple[int, ...], held: int) -> Path:
    """An archive of one array whose header says another size than it holds."""
    member = io.BytesIO()
    np.lib.format.write_array_header_1_0(member, {"descr": "<f8", "fortran_order": False, "shape": header_shape})
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("a_NS.npy", member.getvalue() + bytes(8 * held))
    path.with_suffix(".toml").write_text('time_step = "0.01 s"\nunit = "g"\n')
    return path


@pytest.mark.parametrize(("shape", "held"), [((10**11,), 100), ((100,), 200), ((10**8,), 10**8 // 8)])
def test_an_archive_that_lies_about_its_size(tmp_path: Path, shape: tuple[int, ...], held: int) -> None:
    path = npz(tmp_path / "a.npz", shape, held)
    with pytest.raises(InputError, match="cannot be read"):
        read_motion(f"{path}:a_NS")


def test_an_archive_with_a_damaged_stream(tmp_path: Path) -> None:
    path = npz(tmp_path / "a.npz", (1000,), 1000)
    data = bytearray(path.read_bytes())
    data[60:70] = b"\xff" * 10
    path.write_bytes(data)
    with pytest.raises(InputError):
        read_motion(f"{path}:a_NS")


def test_a_table_beside_an_archive_that_is_no_text(tmp_path: Path) -> None:
    path = npz(tmp_path / "a.npz", (100,), 100)
    path.with_suffix(".toml").unlink()
    path.with_suffix(".csv").write_text("id,dt_s\na,0.01\n", encoding="utf-16")
    with pytest.raises(InputError, match="UTF-8"):
        read_motion(f"{path}:a_NS")


def table(folder: Path, rows: str) -> Path:
    path = folder / "r.csv"
    path.write_text(rows)
    path.with_suffix(".toml").write_text(
        'time_step = 0.01\n[columns]\nbase_acceleration_x = { column = "a", unit = "g" }\n'
        'rotation_1 = { column = "b", unit = "rad" }\n'
    )
    return path


@pytest.mark.parametrize("first", ['1,"2', '1,"2\n3"', "1_5,2"])
def test_tables_with_open_quotes_or_words_for_numbers(tmp_path: Path, first: str) -> None:
    rows = f"a,b\n{first}\n" + "3,4\n" * 30
    with pytest.raises(InputError):
        read_recording(table(tmp_path, rows))


def v2a_counts(text: str, count: int) -> str:
    lines = text.splitlines()
    lines[19] = f"{0:8d}" * 3 + f"{count:8d}" * 3 + f"{0:8d}" * 4
    return "\n".join(lines) + "\n"


@pytest.mark.parametrize("count", [-10, 0, -2600])
def test_a_v2a_file_with_counts_below_one_ends(tmp_path: Path, count: int) -> None:
    lines = [f"text {i}" for i in range(16)]
    lines[12], lines[13] = "Component N10E", "Acceleration:  peak  1.0 mm/s/s at"
    lines += ["".join(f"{0:8d}" for _ in range(10))] * 4 + ["".join(f"{0.01:8.4f}" for _ in range(10))] * 6
    lines += ["".join(f"{1.0:8.1f}" for _ in range(10))] * 9
    path = tmp_path / "x.V2A"
    path.write_text(v2a_counts("\n".join(lines), count))
    with pytest.raises(InputError, match="damaged"):
        read_motion(path)
