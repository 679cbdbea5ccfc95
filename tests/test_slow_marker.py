"""Every entry of the list of slow tests names a file or folder that is there."""

from __future__ import annotations

import pytest

from tests.conftest import HERE, SLOW


@pytest.mark.parametrize("path", SLOW)
def test_it_exists(path: str) -> None:
    assert (HERE / path).exists()
