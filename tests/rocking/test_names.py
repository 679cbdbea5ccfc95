"""The public names, the time of the import, and packages that take our names."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

import rocking
from models.errors import InputError
from rocking.rooms import ROOMS, find_intruder

ROOT = Path(__file__).resolve().parents[2]


def test_import_takes_less_than_half_a_second() -> None:
    code = (
        "import time, sys; t = time.process_time(); import rocking; rocking.__dir__(); "
        "print(time.process_time() - t); "
        "print(*{'numpy', 'xarray', 'numba', 'matplotlib', 'dask', 'pint'} & set(sys.modules))"
    )
    times, loaded = [], set()
    for _ in range(3):
        found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=ROOT)
        first, second = found.stdout.split("\n")[:2]
        times.append(float(first))
        loaded |= set(second.split())
    assert min(times) < 0.5
    assert not loaded


def test_every_public_name_is_there() -> None:
    for name in rocking.__all__:
        assert callable(getattr(rocking, name)), name
    assert set(rocking.__all__) <= set(dir(rocking))
    with pytest.raises(AttributeError, match="it has"):
        rocking.no_such_name  # noqa: B018


def test_catalogues_print_a_line_each() -> None:
    for catalogue in (rocking.models(), rocking.mechanisms()):
        assert len(repr(catalogue).splitlines()) == len(catalogue) > 0
    assert "housner" in rocking.models() and "pivot_inset" in rocking.mechanisms()


def test_an_intruder_is_named(tmp_path: Path) -> None:
    assert find_intruder() is None
    stranger = tmp_path / "models"
    stranger.mkdir()
    (stranger / "__init__.py").write_text("")
    code = "import sys; from rocking.command import main; main()"
    found = subprocess.run(
        [sys.executable, "-c", f"import sys; sys.path.insert(0, {str(tmp_path)!r}); {code}"],
        capture_output=True,
        text=True,
        cwd=ROOT,
    )
    assert found.returncode == 2
    assert found.stderr.count("\n") == 1
    assert str(stranger) in found.stderr and str(ROOT / "models") in found.stderr
    assert "Traceback" not in found.stderr


def test_all_rooms_lie_side_by_side() -> None:
    assert all((ROOT / room / "__init__.py").is_file() for room in ROOMS)


def test_one_recording_may_be_named_alone() -> None:
    block = rocking.read_specimen(ROOT / "examples" / "from_a_data_logger" / "block.toml")
    with pytest.raises(InputError, match=r"recording nowhere.csv does not exist"):
        rocking.calibrate(block, "nowhere.csv")
