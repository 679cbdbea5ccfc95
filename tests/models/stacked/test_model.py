"""The interface: derived constants, outputs that fit together, and sentences for mistakes."""

import numpy as np
import pytest

import models
from models.errors import InputError
from models.shaking import Shaking
from models.stacked.configuration import CONFIGURATIONS, NAMES
from models.stacked.model import MODEL
from tests.models.stacked.walls import A, B, G
from tests.models.strategies import random_motion


def test_it_is_a_model() -> None:
    assert models.get("stacked") is MODEL


def test_derived_constants() -> None:
    found = MODEL.derive({name: np.array([A[name], B[name]]) for name in A})
    np.testing.assert_allclose(found["onset_acceleration"] / G, [0.5 / 2.2, 0.1875], rtol=1e-14)
    np.testing.assert_allclose(found["onset_acceleration_base"] / G, [0.22727, 0.19737], atol=5e-6)
    np.testing.assert_allclose(np.tan(found["alpha_2"]), [0.5, 0.1875], rtol=1e-14)
    assert set(found) == {quantity.name for quantity in MODEL.derived}


def test_density_and_aspect_ratio_mean_the_same_wall() -> None:
    other = {"aspect_ratio": 1.0 / 3.0, "wall_height": 3.0, "wall_density": 1000.0 / 0.6, "wall_thickness": 0.2}
    same = {name: value for name, value in B.items() if name not in ("wall_length", "wall_mass")}
    for name, value in MODEL.derive({**same, **other}).items():
        np.testing.assert_allclose(value, MODEL.derive(B)[name], rtol=1e-14)


def test_outputs_fit_together() -> None:
    shaking = random_motion(np.random.default_rng(3), duration=6.0)
    names = [quantity.name for quantity in MODEL.outputs]
    found = MODEL.evaluate(B, shaking, np.linspace(0.5, 8.0, 40), outputs=names, tail=2.0)
    assert set(found["status"]) == {1, 2, 3}
    for quantity in MODEL.outputs:
        kind = "int8" if quantity.dtype == "bool" else quantity.dtype
        assert found[quantity.name].dtype == np.dtype(kind), quantity.name
    times = np.array([found[f"time_in_{name}"] for name in NAMES])
    stands = found["overturned"] == 0
    np.testing.assert_allclose(times.sum(axis=0)[stands], 8.0, rtol=1e-12)
    np.testing.assert_allclose(times.sum(axis=0)[~stands], found["overturning_time"][~stands], rtol=1e-12)
    visited = np.array([(found["configurations"] >> k & 1) for k in range(len(NAMES))])
    assert np.all((times > 0.0) <= visited)
    base = np.array([bool(s1) for s1, _ in CONFIGURATIONS])
    np.testing.assert_allclose(times[base].sum(axis=0), found["uplift_duration_base"], rtol=1e-12)
    for name in ("peak_rotation", "residual_rotation"):
        pair = np.abs([found[f"{name}_1"], found[f"{name}_2"]])
        np.testing.assert_array_equal(np.abs(found[name]), pair.max(axis=0))
    rest = found["status"] == 1
    assert np.all(found["peak_rotation"][rest] == 0.0) and np.all(np.isnan(found["onset_time"][rest]))
    assert np.all(found["friction_demand"][~rest] > 0.1)


def test_a_vertical_motion_that_does_not_act_is_left_out() -> None:
    rng = np.random.default_rng(5)
    across, up = random_motion(rng, duration=3.0), random_motion(rng, duration=3.0).horizontal
    alone = Shaking(across.time_step, across.horizontal)
    left_out = Shaking(across.time_step, across.horizontal, up, vertical_acts=False)
    acting = Shaking(across.time_step, across.horizontal, up)
    one, samples = np.zeros(1, np.int64), across.horizontal.size
    start = {"rotation_1": np.array([0.02])}

    def peaks(shaking: Shaking, integrator: str = "lanes") -> list[float]:
        run = MODEL.simulate(B, shaking, scale=3.0, integrator=integrator).channels["rotation_1"]
        window = MODEL.trajectories(B, shaking, first=one, samples=samples, initial=start)["rotation_1"]
        names = ["peak_rotation"]
        (peak,) = MODEL.evaluate(B, shaking, np.array([3.0]), outputs=names, tail=0.0)["peak_rotation"]
        return [float(np.sum(np.abs(run))), float(np.sum(np.abs(window))), float(peak)]

    for integrator in MODEL.integrators:
        assert peaks(left_out, integrator) == peaks(alone, integrator)
    assert all(a != b for a, b in zip(peaks(acting), peaks(alone), strict=True))


def test_overturned_history_stays_down() -> None:
    pulse = Shaking(0.005, 8.0 * np.sin(np.pi * np.arange(401) / 200.0))
    for integrator in MODEL.integrators:
        run = MODEL.simulate(B, pulse, tail=6.0, integrator=integrator)
        over = run.outputs["overturning_time"]
        assert run.outputs["overturned"] == 1.0 and 0.0 < over < 6.0
        assert [e.kind for e in run.events].count("overturned") == 1
        assert abs(run.channels["rotation_2"][-1]) == pytest.approx(np.pi / 2)
        assert np.all(np.abs(np.diff(run.channels["rotation_2"])) < 0.2)


def test_a_state_given_at_the_start_is_no_event() -> None:
    run = MODEL.simulate(B, Shaking.silence(1.0, 0.005), initial={"rotation_1": 0.05})
    assert run.events[0].kind != "onset"
    assert run.channels["rotation_2"][0] == 0.05, "the upper block is seated unless its rotation is given"


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({**{k: v for k, v in B.items() if k != "wall_mass"}, "wall_density": 900.0}, "wall_thickness"),
        ({**B, "tilt.tilt": 0.05, "top_height": 30.0}, "cannot stand at rest"),
    ],
)
def test_what_has_no_meaning_together(values: dict[str, float], words: str) -> None:
    (sentence,) = MODEL.check(values)
    assert words in sentence
    assert MODEL.check(B) == []


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"integrator": "newmark"}, "integrator is 'newmark'"),
        ({"options": {"formulation": "linaer"}}, "did you mean 'linear'"),
        ({"options": {"formulations": "linear"}}, "did you mean 'formulation'"),
        ({"initial": {"rotation_3": 0.1}}, "no state 'rotation_3'"),
    ],
)
def test_mistakes_get_a_sentence(arguments: dict[str, object], words: str) -> None:
    with pytest.raises(InputError, match=words):
        MODEL.simulate(B, Shaking.silence(0.1, 0.01), **arguments)  # type: ignore[arg-type]
