"""Every entry of the lists of slow tests and of proofs names something that is there."""

from __future__ import annotations

import pytest

from tests.conftest import HERE, SLOW
from tests.proofs import PROOFS


@pytest.mark.parametrize("path", SLOW)
def test_it_exists(path: str) -> None:
    assert (HERE / path).exists()


@pytest.mark.parametrize("name", PROOFS)
def test_a_proof_is_a_test_with_that_name(name: str) -> None:
    path, _, test = name.partition("::")
    function, cases, _ = test.partition("[")
    assert f"def {function}{'(' if cases else ''}" in (HERE / path).read_text()
