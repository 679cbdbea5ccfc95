"""Recordings may have any name that a file can have."""

from __future__ import annotations

import html
from dataclasses import replace
from pathlib import Path

import pytest
import xarray as xr

from diagnosis.report import write_answer
from tests.diagnosis.report.example import diagnosis, recordings, specimen


@pytest.mark.parametrize("names", [("errors", "6\"'<b>", "shake "), (r"r$\frac{$x", "été 5 % \\x", "read_1")])
def test_an_answer_is_written_whatever_its_recordings_are_called(names: tuple[str, ...], tmp_path: Path) -> None:
    found, read = diagnosis(), list(recordings())
    called = dict(zip((recording.name for recording in read), names, strict=True))
    assert called.keys() == {trace.recording for trace in found.traces}

    def named(parts: tuple[object, ...]) -> tuple[object, ...]:
        return tuple(replace(p, recording=called[p.recording]) for p in parts)  # type: ignore

    found = replace(
        found,
        traces=named(found.traces),
        windows=named(found.windows),
        located=named(found.located),
        shows=named(found.shows),
        prediction_horizon={called[k]: v for k, v in found.prediction_horizon.items()},
    )
    read = [replace(one, name=called[one.name]) for one in read]
    write_answer(found, specimen(), read[:1], read[1:], tmp_path)
    page = (tmp_path / "report.html").read_text("utf-8")
    if "errors" in names:  # errors_rotation_1 is the figure of that channel's errors
        assert (tmp_path / "figures" / "fit_errors_rotation_1.svg").is_file()
        assert not (tmp_path / "figures" / "errors_rotation_1.svg").is_file()
    assert "<b>" not in page
    with xr.open_datatree(tmp_path / "fit.nc", engine="netcdf4") as tree:
        assert set(names) == {group.attrs["recording"] for group in tree.children.values()}
    for name in names:
        assert html.escape(name).replace("&#x27;", "&#39;").replace("&quot;", "&#34;") in page, name
