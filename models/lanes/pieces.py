"""Pieces of kernels compiled as far as a kernel needs them: to the code that it links in, not to machine code.

Numba compiles every function that another one calls as if it were called from Python too: wrappers, and machine code
of each with all that it calls in turn. A kernel links the optimised code of its pieces, not their machine code, so its
own is the same bit for bit, in about half the time. This rests on how numba does it inside: with a version that has
not been tried, pieces are compiled as numba does.
"""

from __future__ import annotations

import ctypes
from typing import Any

import numba
from numba.core.compiler import Compiler, CompilerBase

FIRST, LAST = (0, 59), (0, 68)
"""Versions of numba that were tried."""


def _called_from_python(*_: object) -> None:
    """In the place of the machine code that a piece does not have: it returns nothing, which Python refuses."""


_IN_PLACE = ctypes.PYFUNCTYPE(ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p)(_called_from_python)


def _of_pieces() -> type[CompilerBase]:
    from numba import _dynfunc
    from numba.core.codegen import JITCodeLibrary
    from numba.core.compiler_machinery import LoweringPass, register_pass
    from numba.core.typed_passes import NativeLowering

    class Library(JITCodeLibrary):  # type: ignore[misc]
        """Optimised code to be linked; the engine that makes machine code never sees it."""

        def _finalize_final_module(self) -> None:
            self._finalize_dynamic_globals()
            self._verify_declare_only_symbols()
            self._finalized = True

    @register_pass(mutates_CFG=False, analysis_only=False)
    class Entry(LoweringPass):  # type: ignore[misc]
        """The object by which callers find the code of a piece; without machine code there is none yet."""

        _name = "entry_of_a_piece"

        def __init__(self) -> None:
            LoweringPass.__init__(self)

        def run_pass(self, state: Any) -> bool:
            done = state.cr
            module, name = done.fndesc.lookup_module(), done.fndesc.qualname.rpartition(".")[2]
            address = ctypes.cast(_IN_PLACE, ctypes.c_void_p).value
            found = _dynfunc.make_function(module, name, "a piece of a kernel", address, done.env, (state.library,))
            state.targetctx.insert_user_function(found, done.fndesc, [state.library])
            state.cr = done._replace(cfunc=found)
            return True

    class Pieces(Compiler):  # type: ignore[misc]
        def define_pipelines(self) -> list[Any]:
            state = self.state
            state.flags.no_cpython_wrapper = state.flags.no_cfunc_wrapper = state.flags.no_compile = True
            state.library = Library(state.targetctx.codegen(), state.func_id.func_qualname)
            state.library.enable_object_caching()
            (pipeline,) = super().define_pipelines()
            pipeline.add_pass_after(Entry, NativeLowering)
            pipeline.finalize()
            return [pipeline]

    return Pieces


_VERSION = tuple(int(part) for part in numba.__version__.split(".")[:2])
PieceCompiler: type[CompilerBase] = _of_pieces() if FIRST <= _VERSION <= LAST else Compiler
