"""The model of the cost in the benchmark of scale, on sizes whose cost is known."""

from __future__ import annotations

import pytest

from benchmarks import scale

START, STEPS, RATE, OUTSIDE, BYTES = 0.8, 3000.0, 5e7, 1.5e-5, 23.0


def size(cells: int) -> scale.Found:
    """What a study would measure that costs exactly what the model says."""
    kernels = cells * STEPS / RATE
    return {
        "cells": cells, "lane_steps": cells * STEPS, "kernel_cpu_seconds": kernels, "seconds": 1.0,
        "cpu_seconds": START + kernels + cells * OUTSIDE, "bytes": 5000.0 + cells * BYTES, "peak_memory": 3e8,
        "overhead_share": (START + cells * OUTSIDE) / (START + kernels + cells * OUTSIDE),
    }  # fmt: skip


def test_the_cost_of_two_sizes_is_that_of_all() -> None:
    found = scale.cost(size(10_000), size(100_000))
    assert found["start_seconds"] == pytest.approx(START)
    assert found["steps_per_cell"] == pytest.approx(STEPS)
    assert found["steps_per_second_and_core"] == pytest.approx(RATE)
    assert found["seconds_per_cell_outside"] == pytest.approx(OUTSIDE)
    assert found["bytes_per_cell"] == pytest.approx(BYTES)
    assert scale.cpu_seconds(found, 1e9) == pytest.approx(START + 1e9 * (STEPS / RATE + OUTSIDE))


def test_what_grows_with_the_cells_has_the_exponent_one() -> None:
    sizes = {str(n): size(n) for n in (10**6, 10**7, 10**8)}
    found = scale.summary(sizes)
    assert found["growth_exponent"] == pytest.approx(1.0, abs=0.01)
    assert found["foretold_over_measured"] == pytest.approx(1.0)
    assert found["largest"] == 10**8 and found["overhead_share"] == sizes[str(10**8)]["overhead_share"]


@pytest.mark.parametrize(("model", "cells"), [(model, n) for model, sizes in scale.AXES.items() for n in sizes])
def test_every_size_has_its_number_of_cells(model: str, cells: int) -> None:
    assert scale.plan(model, cells).grid.size == cells
