"""Real numbers and arrays of them, as calls from Python bring them."""

from __future__ import annotations

from numbers import Real

import numpy as np
from numpy.typing import NDArray

from models.errors import InputError


def real_numbers(values: object, where: str) -> NDArray[np.float64]:
    """The values as an array of real numbers, the same one where it is; InputError names ``where``."""
    try:
        array = np.asarray(values)
    except ValueError:  # rows of unequal lengths
        array = np.asarray(None)
    if array.dtype.kind not in "iuf":
        what = "complex numbers" if array.dtype.kind == "c" else f"a {type(values).__name__} of no real numbers"
        raise InputError(f"{where} is {what}: give an array of real numbers")
    return np.asarray(array, dtype=np.float64)


def real_number(value: object) -> float | None:
    """A real number, or an array of one without dimensions, as a float; None of anything else, True and False too."""
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value.item()
    if isinstance(value, bool) or not isinstance(value, Real):
        return None
    try:
        return float(value)
    except OverflowError:  # a whole number of hundreds of digits
        return float("inf")
