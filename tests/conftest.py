"""Which tests are slow, and which are long proofs beside a reduced version of themselves.

``pytest -m "not slow"`` takes about two minutes with compiled kernels; ``make test`` leaves the proofs to
``make proofs``.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

from tests.proofs import PROOFS

# tests run beside each other: more threads a process cost more than they give; read when numpy is imported
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# how long an example takes says something of the machine's load, nothing of the code
settings.register_profile("any machine", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("any machine")

HERE = Path(__file__).resolve().parent
SLOW = (
    "benchmarks",
    "diagnosis/answer",
    "diagnosis/data/test_noise.py",
    "diagnosis/errors",
    "diagnosis/fit",
    "diagnosis/forces",
    "diagnosis/report/test_names.py",
    "diagnosis/search",
    "grids/motions/test_artificial.py",
    "models/housner/test_agreement.py",
    "models/housner/test_convergence.py",
    "models/housner/test_thresholds.py",
    "models/interface/test_effects.py",
    "models/interface/test_lanes.py",
    "models/interface/test_limits.py",
    "models/interface/test_reference.py",
    "models/interface/test_small_motions.py",
    "models/interface_linear/test_lanes.py",
    "models/isolated/test_lanes.py",
    "models/isolated/test_laws.py",
    "models/isolated/test_study.py",
    "models/lanes/test_sealed_cache.py",
    "models/mechanisms/test_agreement.py",
    "models/mechanisms/test_regimes.py",
    "models/rubber",
    "models/stacked/test_free_rocking.py",
    "models/stacked/test_lanes.py",
    "models/test_piecewise.py",
    "rocking/test_data_logger.py",
    "rocking/test_diagnose.py",
    "rocking/test_example.py",
    "study/test_partitions.py",
    "study/test_schedulers.py",
)
"""Files and folders that fit recordings, compare whole families of runs, or compile a kernel of their own."""


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    if not any("::" in str(argument) for argument in config.args):
        refuse_unknown(PROOFS, [item.nodeid.removeprefix("tests/") for item in items])
    listed = [HERE / path for path in SLOW]
    files = {item.path for item in items}  # of thousands of tests a few hundred
    slow = {file for file in files if any(path == file or path in file.parents for path in listed)}
    for item in items:
        if item.nodeid.removeprefix("tests/").startswith(PROOFS):
            item.add_marker(pytest.mark.proof)
        if item.path in slow:
            item.add_marker(pytest.mark.slow)
    # short files last: of two processes neither waits long for the other
    items.sort(key=lambda item: item.get_closest_marker("slow") is None)


def refuse_unknown(proofs: Iterable[str], names: Sequence[str]) -> None:
    """Raises UsageError where a proof is no beginning of a name among the tests of its file, if that was collected."""
    of_file: dict[str, list[str]] = {}
    for name in names:
        of_file.setdefault(name.partition("::")[0], []).append(name)
    for proof in proofs:
        collected = of_file.get(proof.partition("::")[0])
        if collected is not None and not any(name.startswith(proof) for name in collected):
            raise pytest.UsageError(f"tests/proofs.py: no test is called {proof}")
