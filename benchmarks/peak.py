"""The multiply-add peak of one core with 256-bit vectors, measured.

Run in a process of its own in which the compiler may not use wider vectors; the kernel is many
independent chains of multiply-adds on numbers that stay in the nearest cache.
"""

from __future__ import annotations

import os
import subprocess
import sys

_CHAIN = 16
_KERNEL = (
    """
import time, numba, numpy as np
@numba.njit(fastmath={"contract"}, error_model="numpy")
def chains(n, x, k):
    for _ in range(n):
        for i in range(x.size):
            v = x[i]
"""
    + "            v = v * k + 1e-9\n" * _CHAIN
    + f"""            x[i] = v
x = np.ones(512)
chains(2, x, 0.999)
best = 0.0
for _ in range(9):
    n = 20_000
    t = time.process_time()
    chains(n, x, 0.999)
    best = max(best, 2.0 * {_CHAIN} * x.size * n / (time.process_time() - t))
print(best)
"""
)


def multiply_add_peak() -> float:
    """Floating-point operations per second of processor time of one core, a multiply-add counting as two."""
    import llvmlite.binding as llvm

    host = llvm.get_host_cpu_features()
    narrow = ",".join(("-" if name.startswith("avx512") or not on else "+") + name for name, on in host.items())
    environment = {**os.environ, "NUMBA_CPU_FEATURES": narrow, "NUMBA_CPU_NAME": llvm.get_host_cpu_name()}
    found = subprocess.run([sys.executable, "-c", _KERNEL], env=environment, capture_output=True, text=True, check=True)
    return float(found.stdout)
