"""Fits use one thread for linear algebra, and leave what the caller has set."""

from __future__ import annotations

import numpy as np
from threadpoolctl import threadpool_info, threadpool_limits

from diagnosis import calibrate, diagnose
from diagnosis.fit.one_thread import one_thread


def threads() -> set[int]:
    assert np.linalg.inv(np.eye(2)).size == 4  # a library is loaded
    return {pool["num_threads"] for pool in threadpool_info() if pool["user_api"] == "blas"}


def test_there_is_one_thread_within_and_what_was_set_afterwards() -> None:
    with threadpool_limits(2, "blas"):
        before = threads()
        assert one_thread(threads)() == {1}
        assert threads() == before == {2}


def test_fits_are_within() -> None:
    assert all(hasattr(function, "__wrapped__") for function in (calibrate, diagnose))
