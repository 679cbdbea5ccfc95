"""Pieces of kernels without machine code of their own: the same kernel bit for bit, and no crash when called alone."""

from __future__ import annotations

import numba
import numpy as np
import pytest
from numba.core.compiler import Compiler

from models.lanes import pieces

SETTINGS = {"nogil": True, "fastmath": {"contract"}, "error_model": "numpy"}


def kernel(how: type) -> numba.core.dispatcher.Dispatcher:
    """A kernel with pieces in pieces, one of them never inlined."""

    @numba.njit(**SETTINGS, forceinline=True, pipeline_class=how)
    def square(x):
        return x * x

    @numba.njit(**SETTINGS, pipeline_class=how)
    def rarely(x, general):
        if general is not None:
            return square(x) + 0.3
        return 0.1 * square(x)

    @numba.njit(**SETTINGS)
    def whole(values, general):
        total = 0.0
        for k in range(values.size):
            total += square(values[k]) if values[k] > 0.0 else rarely(values[k], general)
        return total

    whole.pieces = (square, rarely)
    return whole


def test_the_kernel_is_the_same_bit_for_bit() -> None:
    values = np.random.default_rng(0).normal(size=1001)
    new, plain = kernel(pieces.PieceCompiler), kernel(Compiler)
    for general in (None, True):
        assert new(values, general) == plain(values, general)
    signature = new.signatures[0]
    assert new.inspect_asm(signature).count("vmul") == plain.inspect_asm(signature).count("vmul")


@pytest.mark.skipif(pieces.PieceCompiler is Compiler, reason="with this numba pieces are compiled as numba does")
def test_a_piece_has_no_machine_code_and_says_so_when_called_from_python() -> None:
    square = kernel(pieces.PieceCompiler).pieces[0]
    with pytest.raises(SystemError):
        square(2.0)
    (found,) = square.overloads.values()
    assert type(found.library).__name__ == "Library"


def test_kernels_of_the_models_use_it() -> None:
    from models.lanes.compiler import called, inlined

    for make in (called, inlined):
        assert make(lambda x: x)._compiler.pipeline_class is pieces.PieceCompiler
