"""Run cells of one tree's models on demand: the process that `benchmarks.compare_speed` starts for each tree.

Reads pickled (model, values, options, shaking, scale, tail) from its input; the answer to each is the processor
time of `evaluate` in s and the lane-steps of its kernels. Knows only `models`, as either tree has it.
"""

from __future__ import annotations

import pickle
import sys
import time
from importlib import import_module
from typing import Any

import models
from models.shaking import Shaking


def counted(kernel: Any, steps: list[int]) -> Any:
    """The kernel, with the lane-steps of each call noted."""

    def call(*arguments: Any) -> int:
        done: int = kernel(*arguments)
        steps.append(done)
        return done

    return call


def main() -> None:
    steps: list[int] = []
    for name in models.MODELS:
        run = import_module(f"models.{name}.lanes.run")
        run.advance = counted(run.advance, steps)  # type: ignore[attr-defined]
    while True:
        try:
            name, values, options, shaking, scale, tail = pickle.load(sys.stdin.buffer)
        except EOFError:
            return
        steps.clear()
        model = models.get(name)
        began = time.thread_time()
        model.evaluate(values, Shaking(*shaking), scale, outputs=["status"], tail=tail, options=options)
        pickle.dump((time.thread_time() - began, sum(steps)), sys.stdout.buffer)
        sys.stdout.buffer.flush()


if __name__ == "__main__":
    main()
