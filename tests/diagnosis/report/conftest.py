"""One answer written to a folder, for all that only reads it."""

from __future__ import annotations

from pathlib import Path

import pytest

from diagnosis.report import write_answer
from tests.diagnosis.report.example import diagnosis, recordings, specimen


@pytest.fixture(scope="session")
def answer(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("answer")
    *train, test = recordings()
    write_answer(diagnosis(), specimen(), train, [test], folder)
    return folder
