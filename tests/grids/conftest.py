"""The fake model beside the real ones, and files of plans and specimens."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

import models
from tests.grids.fakes import FakeWall


@pytest.fixture
def fake_wall(monkeypatch: pytest.MonkeyPatch) -> FakeWall:
    wall, real = FakeWall(), models.get
    monkeypatch.setattr(models, "MODELS", (*models.MODELS, wall.name))
    monkeypatch.setattr(models, "get", lambda name: wall if name == wall.name else real(name))
    return wall


@pytest.fixture
def written(tmp_path: Path) -> Callable[[str, str], Path]:
    """Write a text to a file of that name and give its path."""

    def write(name: str, text: str) -> Path:
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        return path

    return write
