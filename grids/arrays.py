"""Arrays of real numbers, as calls from Python bring them."""

from __future__ import annotations

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
