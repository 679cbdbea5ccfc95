"""Known numbers and fingerprints of every model, found again on this machine."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import models
from models.errors import InputError
from study.verify.base import Line, Oracle, agreeing_digits

__all__ = ["Report", "verify"]


@dataclass(frozen=True)
class Report:
    """``compiled``: seconds that compiling took, by model; those whose kernels came from the cache are left out."""

    lines: tuple[Line, ...]
    compiled: dict[str, float]
    seconds: float

    @property
    def passed(self) -> bool:
        return all(line.passed for line in self.lines)

    def __str__(self) -> str:
        failed = sum(not line.passed for line in self.lines)
        text = f"{len(self.lines)} lines, {failed} of them fail" if failed else f"all {len(self.lines)} lines agree"
        kernels = ", ".join(f"{model} in {seconds:.0f} s" for model, seconds in self.compiled.items())
        return f"{text}; {self.seconds:.0f} s; kernels compiled: {kernels or 'none, all were in the cache'}"


def verify(progress: Callable[[Line], None] = lambda line: None) -> Report:
    """Find every oracle and fingerprint; ``progress`` is called with each line.

    A line fails when fewer digits agree than its source gives, or when nothing is found.
    """
    from numba.core.event import install_timer

    found: list[Line] = []
    compiled: dict[str, float] = {}
    begun = time.perf_counter()
    for model in models.MODELS:

        def note(seconds: float, model: str = model) -> None:
            compiled[model] = seconds

        with install_timer("numba:compile", note):
            for line in _lines(model):
                found.append(line)
                progress(line)
    return Report(tuple(found), compiled, time.perf_counter() - begun)


def _lines(model: str) -> Iterator[Line]:
    from study.verify import bearings, fingerprint, one_block, rubber, two_blocks

    for family in (one_block, two_blocks, rubber, bearings):
        yield from (line_of(oracle) for oracle in family.oracles() if oracle.model == model)
    yield from fingerprint.lines(model)


def line_of(oracle: Oracle) -> Line:
    """How many digits of an oracle are found again; none, and why, where it finds no number."""
    try:
        digits, error = agreeing_digits(oracle.find(), oracle.expected), ""
    except (ArithmeticError, LookupError, InputError) as wrong:
        digits, error = 0.0, str(wrong)
    return Line(oracle.model, oracle.what, oracle.source, digits, oracle.digits, error)
