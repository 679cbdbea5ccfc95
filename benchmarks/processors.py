"""Digits between processors: the fingerprint's cells compiled for other targets; ``make processors``.

The compiler's target stands for the processor: vectors of 512, 256 and 128 bits, with and without fused
multiply-add; null for one that this machine cannot execute. The digits in which the worst output of the worst cell
agrees with the answer of this machine's own target are written to ``results/bench/processors.json``.
"""

from __future__ import annotations

import argparse
import json
import os
import signal
import subprocess
import sys
from pathlib import Path

from study.verify.base import MOST_DIGITS, agreeing_digits
from study.verify.fingerprint import CELLS

TARGETS: dict[str, dict[str, str]] = {
    "its own": {},
    "512 bit, fused": {"NUMBA_CPU_NAME": "skylake-avx512", "NUMBA_CPU_FEATURES": "+avx512f,+avx512dq,+avx512vl,+fma"},
    "256 bit, fused": {"NUMBA_CPU_NAME": "haswell", "NUMBA_CPU_FEATURES": "+avx,+avx2,+fma"},
    "256 bit, not fused": {"NUMBA_CPU_NAME": "sandybridge", "NUMBA_CPU_FEATURES": "+avx,-fma"},
    "128 bit, not fused": {"NUMBA_CPU_NAME": "nehalem", "NUMBA_CPU_FEATURES": "+sse4.2,-avx,-fma"},
}
ASK = "import json, sys; from study.verify.fingerprint import answers; print(json.dumps(answers(sys.argv[1])))"
OUT = Path("results/bench/processors.json")


def answers(model: str, target: dict[str, str]) -> dict[str, list[float]] | None:
    """The outputs of a model's cells, by a process that compiles for the target; None: not on this machine."""
    done = subprocess.run(
        [sys.executable, "-c", ASK, model], env={**os.environ, **target}, capture_output=True, text=True
    )
    if done.returncode == -signal.SIGILL:
        return None
    if done.returncode:
        raise RuntimeError(f"{model}: {done.stderr}")
    found: dict[str, list[float]] = json.loads(done.stdout)
    return found


def main() -> None:
    """Print digits that agree in the worst output of the worst cell, by model and target."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--model", choices=tuple(CELLS), action="append")
    given = parser.parse_args()
    table = json.loads(OUT.read_text("utf-8")) if OUT.exists() else {}
    OUT.parent.mkdir(parents=True, exist_ok=True)
    for model in given.model or CELLS:
        own = answers(model, {}) or {}
        table[model] = {}
        for name, target in TARGETS.items():
            found = answers(model, target)
            table[model][name] = None if found is None else digits(own, found)
        OUT.write_text(json.dumps(table, indent=1) + "\n")
        print(f"{model:<18}" + ", ".join(f"{name} {least}" for name, least in table[model].items()), flush=True)


def digits(own: dict[str, list[float]], found: dict[str, list[float]]) -> float:
    """Digits that agree in the worst output of the worst cell."""
    pairs = [(a, b) for output in own for a, b in zip(found[output], own[output], strict=True)]
    return round(min((agreeing_digits(a, b) for a, b in pairs), default=MOST_DIGITS), 1)


if __name__ == "__main__":
    main()
