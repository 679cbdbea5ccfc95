"""Measured order of every integrator: the error against the step, on one forced run with impacts."""

import numpy as np
import pytest

from models.housner.block import Block
from models.housner.lanes import run as lanes
from models.housner.model import MODEL
from models.housner.reference import newmark
from models.housner.reference import run as reference
from models.runs import Request
from models.shaking import Shaking
from tests.models.housner.adapter import rectangle

STEP = 0.08
END = 2.4
ALPHA = 0.25


def forced() -> tuple[Block, Shaking]:
    """A rough record, linear between samples .08 s apart, that lifts the block twice."""
    time = np.arange(round(END / STEP) + 1) * STEP
    return (
        MODEL.build(rectangle(ALPHA, 2.0, restitution=0.85)),
        Shaking(STEP, 4.2 * np.sin(4.0 * time) * np.exp(-0.8 * time)),
    )


def final_state(steps: int, integrator: str, rtol: float = 1e-13) -> np.ndarray:
    """theta and theta'/p at the end of the record over alpha, with ``steps`` steps a sample."""
    block, shaking = forced()
    request = Request(shaking, np.ones(1), samples=shaking.horizontal.size)
    if integrator == "newmark":
        rotation, rate, _ = newmark.run(block, request, steps).samples[0, -1]
    elif integrator == "lanes":
        rotation, rate, _ = lanes.run(block, request, steps).samples[0, -1]
    else:
        rotation, rate, _ = reference.run(block, request, rtol).samples[0, -1]
    return np.array([rotation, rate / 2.0]) / ALPHA


def test_the_run_has_what_an_order_test_needs() -> None:
    block, shaking = forced()
    run = reference.run(block, Request(shaking, np.ones(1)), 1e-13)
    assert run.outputs["impacts"] >= 2
    assert 0.1 < run.outputs["peak_rotation_ratio"] < 0.8


@pytest.mark.parametrize(
    ("integrator", "steps", "order", "best"),
    [("lanes", (2, 4, 8, 16), 4, 1e-7), ("newmark", (4, 8, 16, 32), 2, 1e-3)],
)
def test_order(
    integrator: str, steps: tuple[int, ...], order: int, best: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(lanes, "LARGEST_PHASE", np.inf)
    exact = final_state(1, "reference")
    errors = np.array([np.max(np.abs(final_state(n, integrator) - exact)) for n in steps])
    measured = np.polyfit(-np.log(steps), np.log(errors), 1)[0]
    assert measured == pytest.approx(order, abs=0.35), errors
    assert errors[-1] < best


def test_the_reference_follows_its_tolerance() -> None:
    exact = final_state(1, "reference", 1e-13)
    for rtol in (1e-6, 1e-8, 1e-10):
        assert np.max(np.abs(final_state(1, "reference", rtol) - exact)) < 20 * rtol
