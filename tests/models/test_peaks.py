"""Outputs that are peaks of observables, on every model."""

from __future__ import annotations

import numpy as np
import pytest

import models
from models import peaks
from models.base import Values
from models.shaking import Shaking

WALL = {
    "wall_length": 0.72, "wall_height": 1.8, "wall_thickness": 0.138, "wall_density": 900.0, "top_mass": 5000.0,
    "top_length": 2.0, "top_height": 0.6,
}  # fmt: skip
ON_RUBBER = {**WALL, "layer_thickness": 0.01, "layer_modulus": 4.5e6, "damping_ratio": 0.05}
CELLS: dict[str, Values] = {
    "housner": {"height": 2.0, "width": 0.5, "mass": 1000.0},
    "stacked": WALL,
    "interface": ON_RUBBER,
    "interface_linear": ON_RUBBER,
    "isolated": {
        "levels": np.array([1.0, 3.0, 2.0]), "total_mass": 1e5, "storey_stiffness": 5e8, "storey_damping": 1e6,
        "bearing_stiffness": 1e6, "bearing_damping": 2e4,
    },
}  # fmt: skip
STEP = 0.005
TIME = np.arange(0.0, 1.5, STEP)
SHAKING = Shaking(STEP, 3.0 * np.sin(2.0 * np.pi * 1.3 * TIME) * np.sin(np.pi * TIME / 1.5))
SCALE = np.array([0.2, 0.9, 1.1])


@pytest.mark.parametrize("name", CELLS)
def test_peak_velocity_is_the_largest_rate_of_the_history(name: str) -> None:
    model, values = models.get(name), CELLS[name]
    found = model.evaluate(values, SHAKING, SCALE, outputs=["peak_velocity", "status"], tail=0.5)["peak_velocity"]
    for k, scale in enumerate(SCALE):
        one = {key: float(np.broadcast_to(value, SCALE.shape)[k]) for key, value in values.items()}
        history = model.simulate(one, SHAKING, scale=float(scale), tail=0.5)
        rates = [
            np.abs(c).max() for key, c in history.channels.items() if key.startswith(("rotation_rate", "bearing_v"))
        ]
        assert found[k] == pytest.approx(max(rates), rel=1e-12) == history.outputs["peak_velocity"]
    assert found[1] > 0.0


@pytest.mark.parametrize("name", ["housner", "isolated"])
def test_the_reference_gives_the_same(name: str) -> None:
    both = [
        models.get(name).evaluate(
            CELLS[name], SHAKING, SCALE, outputs=["peak_velocity"], tail=0.2, integrator=integrator
        )["peak_velocity"]
        for integrator in ("lanes", "reference")
    ]
    np.testing.assert_allclose(both[0], both[1], rtol=2e-3)


def test_it_is_the_velocity_at_the_first_impact_of_free_rocking() -> None:
    """alpha = .25, released at .6 alpha: theta' = .228437052894 p at the impact, the largest of the motion."""
    block = {"height": 2.0 * np.cos(0.25), "width": 2.0 * np.sin(0.25), "mass": 1000.0}
    model = models.get("housner")
    p = model.derive(block)["frequency_parameter"].item()
    free = model.simulate(block, Shaking.silence(1.5, 1e-4), initial={"rotation_1": 0.6 * 0.25})
    slope = 0.25 * p**2 * 1e-4  # what the rate can gain between two samples
    assert 0.0 <= 0.228437052894 * p - free.outputs["peak_velocity"] < slope


def test_what_follows_overturning_does_not_count() -> None:
    block, push = CELLS["housner"], Shaking(STEP, np.where(TIME < 0.6, 6.0, 0.0))
    ran = models.get("housner").simulate(block, push, tail=2.0)
    before = ran.time <= ran.outputs["overturning_time"]
    assert ran.outputs["overturned"] == 1.0
    assert ran.outputs["peak_velocity"] == np.abs(ran.channels["rotation_rate_1"][before]).max()


def test_it_does_not_depend_on_how_many_lanes_are_held_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    model, values = models.get("housner"), CELLS["housner"]

    def found() -> np.ndarray:
        return model.evaluate(values, SHAKING, SCALE, outputs=["peak_velocity"], tail=0.5)["peak_velocity"]

    whole = found()
    monkeypatch.setattr(peaks, "STATES_PER_CALL", 1)
    np.testing.assert_array_equal(found(), whole)
