"""A table that takes long goes on where it was broken off, and its exit code says what was found."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from benchmarks.by_row import Row, fill, parser


def test_rows_are_made_once_and_findings_decide_the_exit_code(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    out, made = tmp_path / "bench" / "table.json", []

    def maker(name: str, lost: int) -> Row:
        made.append(name)
        return {"kind": name, "tries": 3, "lost": lost, "notes": ["a block is gone"] if lost else []}

    def table(*words: str, lost: int = 0) -> int:
        monkeypatch.setattr("sys.argv", ["bench", "--out", str(out), *words])
        makers = {name: lambda name=name: maker(name, lost) for name in ("killed", "full disk")}
        return fill(parser("", out).parse_args(), "kind", ("tries", "lost"), ("lost",), makers)

    assert table("--only", "kill") == 0
    assert made == ["killed"]
    assert table(lost=1) == 1  # the second row alone is made, and has lost something
    assert made == ["killed", "full disk"]
    assert [row["lost"] for row in json.loads(out.read_text())] == [0, 1]
    said = capsys.readouterr().out
    assert "a block is gone" in said
    assert "6 tries, 1 kinds with findings" in said
    assert table("--again") == 0
    assert made[2:] == ["killed", "full disk"]
