"""What models declare for the diagnosis holds together, and agrees with the models themselves."""

from __future__ import annotations

import numpy as np
import pytest

import models
from grids.recordings.base import CHANNELS
from models.identification import NARROWEST, Count, Identification, Motion, WindowLengths
from models.shaking import Shaking

WALL = {
    "wall_length": 0.72, "wall_height": 1.8, "wall_thickness": 0.138, "wall_density": 900.0, "top_mass": 5000.0,
    "top_length": 2.0, "top_height": 0.6, "layer_thickness": 0.01, "layer_modulus": 4.5e6, "damping_ratio": 0.05,
}  # fmt: skip


def declared(name: str) -> Identification:
    found = models.get(name).identification
    assert found is not None
    return found


@pytest.mark.parametrize("name", models.MODELS)
def test_every_state_is_declared_in_the_model_s_order(name: str) -> None:
    assert tuple(state.name for state in declared(name).states) == models.get(name).states


@pytest.mark.parametrize("name", models.MODELS)
def test_what_is_read_is_a_standard_channel_that_the_model_predicts(name: str) -> None:
    observables = {quantity.name for quantity in models.get(name).observables}
    found = declared(name)
    read = [lead.channel for lead in found.leads]
    read += [state.channel for state in found.states if not state.latent]
    read += [memory.channel for memory in found.memories]
    assert set(read) <= observables & CHANNELS.keys()


@pytest.mark.parametrize("name", models.MODELS)
def test_names_of_forces_phases_and_events_fit_together(name: str) -> None:
    found = declared(name)
    ports = {kind.port.name: kind.port for kind in found.forces}
    assert all(kind.port is ports[kind.port.name] for kind in found.forces)
    kinds, dependences = {kind.name for kind in found.forces}, {one.name for one in found.dependences}
    assert len(kinds) == len(found.forces) and len(dependences) == len(found.dependences)
    for kind in found.forces:
        assert kind.along is not None or (found.separation and kind.event == found.separation.event)
        assert all(on in dependences and same in kinds and to in dependences for on, (same, to) in kind.named.items())
    words = {word for one in found.dependences for word in one.phases if word}
    words |= {found.separation.event, found.separation.between} if found.separation else set()
    assert words == found.phases.keys()


def test_forces_are_of_order_one_and_those_of_one_name_are_one_force() -> None:
    rng = np.random.default_rng(5)
    motion = Motion(*(rng.normal(size=(3, 40)) for _ in range(3)), reach=1.7)
    found = declared("housner")
    factors = {one.name: one.factor(motion) for one in found.dependences}
    along = {kind.name: kind.along(motion) for kind in found.forces if kind.along}
    for kind in found.forces:
        if kind.along:
            assert 0.3 < np.max(np.abs(kind.along(motion))) < 3.0
        for on, (same, to) in kind.named.items():
            np.testing.assert_allclose(along[kind.name] * factors[on], along[same] * factors[to], atol=1e-12)


@pytest.mark.parametrize("name", ["interface", "interface_linear"])
def test_a_wall_on_rubber_rests_compressed_not_at_zero(name: str) -> None:
    model = models.get(name)
    rest = declared(name).rest(model.derive(WALL))
    assert rest["displacement_z_1"] < 0.0
    ran = model.simulate(WALL, Shaking.silence(0.02, 0.005), initial=rest, integrator="reference")
    for body in (1, 2):
        channel = next(q.name for q in model.observables if q.symbol == f"-z_{body}")
        np.testing.assert_allclose(ran.channels[channel], -rest[f"displacement_z_{body}"], rtol=1e-9)


def test_a_rigid_block_rests_at_zero_and_counts_what_the_model_calls_an_impact() -> None:
    found, model = declared("housner"), models.get("housner")
    values = {"width": 0.25, "height": 1.8, "mass": 540.0}
    assert set(found.rest(model.derive(values)).values()) == {0.0}
    ran = model.simulate(values, Shaking.silence(3.0, 0.005), initial={"rotation_1": 0.05}, integrator="reference")
    count = next(memory for memory in found.memories if isinstance(memory, Count))
    assert sum(event.kind == count.event for event in ran.events) > 2


def test_lengths_of_windows_follow_the_wall() -> None:
    lengths = WindowLengths(1.0, 2.0, 3.0, 1.5, 0.2, 0.4, unit=lambda d: 1.0 / d["p"])
    assert lengths.in_seconds({"p": np.array([4.0])}) == WindowLengths(0.25, 0.5, 0.75, 0.375, 0.05, 0.1)
    assert lengths.in_seconds({"p": np.array([80.0])}).carrying == NARROWEST
    fixed = WindowLengths(0.3, 0.6, 0.85, 0.35, 0.05)
    assert fixed.in_seconds({}) is fixed


@pytest.mark.parametrize("name", models.MODELS)
def test_a_refusal_names_every_latent_state_that_is_not_carried(name: str) -> None:
    found = declared(name)
    through = found.stretches is not None
    lost = [state.name for state in found.states if state.latent and not found.carrying and not through]
    assert (found.windows is None) == through
    assert all(state in found.refusal() for state in lost)
    assert bool(found.refusal()) == (bool(lost) or bool(found.not_carried))
