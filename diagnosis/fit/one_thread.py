"""One thread for linear algebra while recordings are fitted.

Matrices of a window's size are too small to share: a diagnosis took 55 s of computing with one thread and 167 s with
two, as long by the clock too. Processes beside each other are what makes several cores useful.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import ParamSpec, TypeVar

from threadpoolctl import threadpool_limits

P = ParamSpec("P")
R = TypeVar("R")


def one_thread(function: Callable[P, R]) -> Callable[P, R]:
    """The function with one thread for every BLAS that is loaded, while it runs."""

    @wraps(function)
    def limited(*args: P.args, **kwargs: P.kwargs) -> R:
        with threadpool_limits(1, "blas"):
            return function(*args, **kwargs)

    return limited
