"""Every entry of the lists of slow tests and of proofs names something that is there."""

from __future__ import annotations

import re

import pytest

from tests.conftest import HERE, SLOW, refuse_unknown
from tests.proofs import PROOFS


@pytest.mark.parametrize("path", [*SLOW, *sorted({name.partition("::")[0] for name in PROOFS})])
def test_it_exists(path: str) -> None:
    assert (HERE / path).exists()


def test_a_proof_without_a_test_is_refused() -> None:
    names = ["a/test_one.py::test_x[1]", "a/test_one.py::test_x[2]", "a/test_two.py::test_y"]
    refuse_unknown(["a/test_one.py::test_x[2]", "a/test_two.py::test_y", "b/test_other.py::test_z"], names)
    for proof in ("a/test_one.py::test_x[3]", "a/test_two.py::test_z"):
        with pytest.raises(pytest.UsageError, match=re.escape(proof)):
            refuse_unknown([proof], names)
