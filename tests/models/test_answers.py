"""A cell without a valid answer holds no number: in every model, by lanes and reference, in outputs and histories."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import models
from models.base import MISSING, STATUS, UNANSWERED
from models.model import Model
from models.runs import Request, Run
from models.shaking import Shaking
from tests.models.stacked.walls import A

WALLS = {"housner": {"width": 0.5, "height": 2.0, "mass": 900.0}, "stacked": A}
PULSE = Shaking(0.01, 4.0 * np.sin(2 * np.pi * np.arange(101) / 100))


def with_status(model: Model, status: list[int], monkeypatch: pytest.MonkeyPatch) -> Model:
    """The model, whose runs end with these flags whatever happens."""
    run = type(model).run

    def flagged(self: Model, integrator: str, coefficients: Any, request: Request) -> Run:
        found = run(self, integrator, coefficients, request)
        return replace(found, outputs={**found.outputs, "status": np.array(status, dtype=np.int8)})

    monkeypatch.setattr(type(model), "run", flagged)
    return model


@pytest.mark.parametrize("name", WALLS)
@pytest.mark.parametrize("integrator", ["lanes", "reference"])
def test_outputs(name: str, integrator: str, monkeypatch: pytest.MonkeyPatch) -> None:
    model, scale = models.get(name), np.linspace(0.5, 1.0, len(STATUS))
    names = [quantity.name for quantity in model.outputs]
    plain = model.evaluate(WALLS[name], PULSE, scale, outputs=names, tail=0.5, integrator=integrator)
    flagged = with_status(model, list(range(len(STATUS))), monkeypatch)
    found = flagged.evaluate(WALLS[name], PULSE, scale, outputs=names, tail=0.5, integrator=integrator)
    lost = np.isin(np.arange(len(STATUS)), UNANSWERED)
    assert [word for word, gone in zip(STATUS, lost, strict=True) if gone] == [
        "outside_model",
        "not_converged",
        "failed",
    ]
    np.testing.assert_array_equal(found.pop("status"), np.arange(len(STATUS)))
    for output, values in found.items():
        assert np.all(np.isnan(values[lost]) if values.dtype.kind == "f" else values[lost] == MISSING), output
        np.testing.assert_array_equal(values[~lost], plain[output][~lost])


@pytest.mark.parametrize("name", WALLS)
def test_the_outputs_of_a_history(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    history = with_status(models.get(name), [UNANSWERED[1]], monkeypatch).simulate(WALLS[name], PULSE)
    assert history.outputs.pop("status") == UNANSWERED[1]  # type: ignore[attr-defined]
    assert all(np.isnan(value) or value == MISSING for value in history.outputs.values())
