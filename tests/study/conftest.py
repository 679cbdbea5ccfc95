"""Fixtures of the study tests: the size of blocks is set, not measured, so that tests are repeatable."""

from __future__ import annotations

from collections.abc import Callable

import pytest

import study.run
from study.timing import Sample


@pytest.fixture
def block_size(monkeypatch: pytest.MonkeyPatch) -> Callable[[int], None]:
    """Set how many cells a block may have, in place of the timed sample."""

    def set_size(cells: int) -> None:
        monkeypatch.setattr(study.run, "time_sample", lambda plan, setting: Sample(1, 1.0, 0.0, 8.0))
        monkeypatch.setattr(study.run, "cells_per_block", lambda plan, sample, workers: cells)

    return set_size
