"""Runs that are cut at an instant: the same as whole ones, and with other values the later part alone differs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import models
from models.base import MISSING, STATUS, FloatArray
from models.errors import InputError
from models.model import Model
from models.piecewise import Part, begun_at, simulate, trajectories
from models.pitch import pitch
from models.runs import DONE
from models.shaking import Shaking, Shakings

STEP = 0.005
TIME = STEP * np.arange(1601)
BURSTS = np.exp(-0.3 * TIME) * (TIME < 2.0) + 0.9 * np.exp(-0.3 * (TIME - 5.0)) * (TIME > 5.0)
SHAKING = Shaking(STEP, 2.2 * np.sin(2.0 * np.pi * 1.2 * TIME) * BURSTS)
AT = 0.02 * np.arange(81)
QUICK = Shaking(0.02, 3.0 * np.sin(2.0 * np.pi * 2.5 * AT) * (AT < 1.1))
WALL = {
    "wall_length": 0.4, "wall_height": 1.6, "wall_mass": 900.0, "top_mass": 1500.0, "top_length": 0.4,
    "top_height": 0.3,
}  # fmt: skip
LAYERS = {"wall_thickness": 0.4, "layer_thickness": 0.01, "layer_modulus": 3e6, "damping_ratio": 0.05}
BLOCK = {"width": 0.3, "height": 1.7, "mass": 500.0}
OF_MODEL = {"housner": BLOCK, "stacked": WALL, "interface": {**WALL, **LAYERS}}
WEARS = {**BLOCK, "degradation.loss_of_restitution_per_impact": 0.01, "degradation.floor": 0.8}
CRUSHES = {**BLOCK, "crushing.inset_per_rotation": 1.0}
IN_A_TABLE = {
    **BLOCK, "table_force.reach_rotation": 0.2, "table_force.reach_rate": 1.0, "table_force.reach_base": 3.0,
    "table_force.rotation_above_3": -0.2, "table_force.damping_below_2": -0.3, "table_force.impact_above_5": -0.05,
}  # fmt: skip
FADES = {**BLOCK, "restitution_amplitude_exponent": 0.1}
DRIVEN = {
    **BLOCK, "table_force.oscillator_motion": 0.05, "table_force.oscillator_frequency": 1.0,
    "table_force.oscillator_damping": 0.03,
}  # fmt: skip
PITCHES = {"table_pitch.pitch_per_acceleration": 1e-3, "table_pitch.low_pass_hz": 3.0}
RUBS = {**WALL, "coulomb_damping.over_m_g_b": 0.05}
ALIKE = {"housner": 1e-9, "stacked": 1e-8, "interface": 1e-4}
"""Share of the peak: the steps of elastic walls begin anew at a cut."""


PITCHED = [(name, {**values, **PITCHES}) for name, values in OF_MODEL.items()]
RUNS = {
    **{name: (name, values) for name, values in OF_MODEL.items()},
    "wears": ("housner", WEARS), "crushes": ("housner", CRUSHES), "in_a_table": ("housner", IN_A_TABLE),
    "fades": ("housner", FADES), "driven": ("housner", DRIVEN), "rubs": ("stacked", RUBS),
    **{f"{name}_pitched": (name, values) for name, values in PITCHED},
}  # fmt: skip
BY = [(run, integrator) for integrator in ("lanes", "reference") for run in RUNS]
BY += [(run, "newmark") for run in ("wears", "fades")]
BY.remove(("interface_pitched", "reference"))  # takes 25 s, and reads the base as stacks do


@pytest.mark.parametrize(("run", "integrator"), BY)
def test_a_cut_run_is_the_whole_run(run: str, integrator: str) -> None:
    name, values = RUNS[run]
    model = models.get(name)
    shaking, cuts, duration = SHAKING, (0, 211, 700, 1250, 1700), 9.0
    if name == "housner":  # a cut between the peak of a swing and its impact, too
        cuts = (0, 211, 330, 700, 1250, 1700)
    if (name, integrator) == ("interface", "reference"):  # takes 5 s a second
        shaking, cuts, duration = QUICK, (0, 16, 40, 72, 81), 1.6
    whole = model.simulate(values, shaking, duration=duration, integrator=integrator)
    parts = [Part(first, values) for first in cuts]
    cut = simulate(model, parts, shaking, duration=duration, integrator=integrator)
    np.testing.assert_array_equal(cut.time, whole.time)
    for channel in ("rotation_1", "rotation_rate_1", "displacement_1_x"):
        size = np.max(np.abs(whole.channels[channel]))
        np.testing.assert_allclose(cut.channels[channel], whole.channels[channel], atol=ALIKE[name] * size)
    assert [(e.kind, e.body) for e in cut.events] == [(e.kind, e.body) for e in whole.events]
    assert len(whole.events) > 7
    for output, value in whole.outputs.items():
        assert cut.outputs[output] == pytest.approx(value, rel=1e-3, nan_ok=True), output


def test_what_changes_acts_from_its_sample_on() -> None:
    model = models.get("housner")
    weak = {**BLOCK, "restitution.factor_on_housner": 0.9}
    plain = model.simulate(BLOCK, SHAKING).channels["rotation_1"]
    changed = simulate(model, [Part(0, BLOCK), Part(250, weak)], SHAKING).channels["rotation_1"]
    np.testing.assert_array_equal(changed[:251], plain[:251])
    assert np.max(np.abs(changed[251:] - plain[251:])) > 0.05 * np.max(np.abs(plain))
    never = simulate(model, [Part(0, BLOCK), Part(5000, weak)], SHAKING).channels["rotation_1"]
    np.testing.assert_array_equal(never, plain)


def test_of_parts_from_one_sample_on_the_last_acts() -> None:
    """Two stages that begin between two samples change the values twice at the next one."""
    model = models.get("housner")
    weak, weaker = ({**BLOCK, "restitution.factor_on_housner": factor} for factor in (0.95, 0.9))
    once = simulate(model, [Part(0, BLOCK), Part(250, weaker)], SHAKING)
    twice = simulate(model, [Part(0, weak), Part(0, BLOCK), Part(250, weak), Part(250, weaker)], SHAKING)
    np.testing.assert_array_equal(twice.channels["rotation_1"], once.channels["rotation_1"])
    assert twice.outputs == once.outputs and twice.events == once.events


def test_a_filter_over_the_whole_record_sees_what_came_before_a_cut() -> None:
    (psi, second), first = pitch(SHAKING, 3.0), 321
    cut = begun_at(SHAKING, first)
    for whole, part in zip((psi, second), pitch(cut, 3.0), strict=True):
        np.testing.assert_array_equal(part, whole[first:])
    again = begun_at(cut, 100).scaled(2.0)
    np.testing.assert_allclose(pitch(again, 3.0)[0], 2.0 * psi[first + 100 :], atol=1e-12)


def test_an_overturned_block_stays_down_over_the_parts() -> None:
    strong = Shaking(STEP, 3.0 * SHAKING.horizontal)
    model = models.get("housner")
    whole = model.simulate(BLOCK, strong)
    cut = simulate(model, [Part(0, BLOCK), Part(900, BLOCK), Part(1300, BLOCK)], strong)
    assert whole.outputs["overturned"] == 1.0
    np.testing.assert_allclose(cut.channels["rotation_1"], whole.channels["rotation_1"], atol=1e-12)
    assert cut.outputs["overturning_time"] == whole.outputs["overturning_time"]
    assert cut.outputs["uplift_duration"] == pytest.approx(whole.outputs["uplift_duration"])


@pytest.mark.parametrize("at", [0, 1])
@pytest.mark.parametrize("word", ["not_converged", "outside_model"])
def test_a_part_that_is_no_answer_makes_the_whole_none(word: str, at: int, monkeypatch: pytest.MonkeyPatch) -> None:
    model, status = models.get("housner"), float(STATUS.index(word))
    plain, done = type(model).simulate_from, []

    def flagged(*given: Any, **named: Any) -> Any:
        history, state = plain(*given, **named)
        done.append(history)
        return (
            replace(history, outputs={**history.outputs, "status": status}) if len(done) == at + 1 else history
        ), state

    monkeypatch.setattr(type(model), "simulate_from", flagged)
    outputs = dict(simulate(model, [Part(0, BLOCK), Part(250, {**BLOCK, "width": 0.31})], SHAKING).outputs)
    assert len(done) == 2 and done[1].outputs["status"] == STATUS.index("rocking")
    assert outputs.pop("status") == status
    assert outputs["impacts"] == MISSING and np.isnan(outputs["peak_rotation"])
    assert all(np.isnan(value) or value == MISSING for value in outputs.values())


@pytest.mark.parametrize(("name", "values"), [*OF_MODEL.items(), *PITCHED], ids=str)
def test_windows_before_after_and_over_the_instant(name: str, values: dict[str, float]) -> None:
    model = models.get(name)
    other = {**values, "pivot_inset.inset_over_half_width": 0.05}
    values = {**values, "pivot_inset.inset_over_half_width": 0.0}
    whole = simulate(model, [Part(0, values), Part(120, other)], SHAKING)
    first, samples = np.array([60, 90, 125]), 50
    states = {s: whole.channels[s][first] for s in model.states if s in whole.channels}
    if name == "interface":  # the vertical states come with a run to the window's start
        _, states = model.follow(
            {k: np.full(2, v) for k, v in values.items()}, SHAKING, first=np.zeros(2, np.int64), steps=first[:2],
            initial={}, options=None,
        )  # fmt: skip
        first = first[:2]
    found = trajectories(
        model, [values, other], np.full((first.size, 1), 120), SHAKING, first=first, samples=samples, initial=states
    )
    peak = np.max(np.abs(whole.channels["rotation_1"]))
    for k, start in enumerate(first):
        wanted = whole.channels["rotation_1"][start : start + samples]
        np.testing.assert_allclose(found["rotation_1"][k], wanted, atol=max(ALIKE[name], 1e-6) * peak)


@pytest.mark.parametrize("name", OF_MODEL)
def test_lanes_of_their_own_lengths_are_those_of_the_longest_to_their_ends(name: str) -> None:
    model, values = models.get(name), OF_MODEL[name]
    other = {**values, "pivot_inset.inset_over_half_width": 0.05}
    values = {**values, "pivot_inset.inset_over_half_width": 0.0}
    first, lengths = np.array([0, 0, 0]), np.array([90, 400, 251])
    for parts, changes in (([values], np.zeros((3, 0), np.int64)), ([values, other], np.full((3, 1), 200))):
        found, work = [], []
        for samples in (400, lengths):
            before = DONE.steps
            ran = trajectories(model, parts, changes, SHAKING, first=first, samples=samples, initial={})
            found.append(ran["rotation_1"])
            work.append(DONE.steps - before)
        whole, own = found
        assert own.shape == whole.shape
        assert work[1] < 0.8 * work[0]  # what nobody asked for is not run: .62 of the samples were
        for k, length in enumerate(lengths):
            np.testing.assert_array_equal(own[k, :length], whole[k, :length])


def alone(
    model: Model[Any], values: Mapping[str, float], other: Mapping[str, float] | None, shaking: Shaking, first: int
) -> FloatArray:
    """One lane of 300 samples, with ``other`` values from sample 200 on."""
    parts, cuts = ([values], np.zeros((1, 0), np.int64)) if other is None else ([values, other], np.full((1, 1), 200))
    ran = trajectories(model, parts, cuts, shaking, first=np.array([first]), samples=300, initial={})
    return ran["rotation_1"][0]


@pytest.mark.parametrize("cut", [False, True])
@pytest.mark.parametrize(("name", "values"), [*OF_MODEL.items(), ("housner", PITCHED[0][1]), ("housner", DRIVEN)])
def test_lanes_under_motions_of_their_own_move_as_under_each_alone(
    name: str, values: dict[str, float], cut: bool
) -> None:
    model = models.get(name)
    other = {**values, "pivot_inset.inset_over_half_width": 0.05} if cut else None
    values = {**values, "pivot_inset.inset_over_half_width": 0.0}
    strong, short = SHAKING.scaled(1.5), Shaking(STEP, 1.2 * SHAKING.horizontal[:260])
    motions = Shakings((strong, short, SHAKING.scaled(-1.3)), np.array([0, 1, 2, 1, 0]))
    first = np.array([0, 0, 40, 30, 90])
    parts = [values] if other is None else [values, other]
    changes = np.full((5, len(parts) - 1), 200)
    found = trajectories(model, parts, changes, motions, first=first, samples=300, initial={})["rotation_1"]
    assert np.ptp([np.max(np.abs(x)) for x in found]) > 0.005
    for k, under in enumerate(motions.of):
        inside = min(300, motions.each[under].horizontal.size - int(first[k]))
        wanted = alone(model, values, other, motions.each[under], int(first[k]))
        np.testing.assert_array_equal(found[k, :inside], wanted[:inside])


def test_chains_on_bearings_run_under_one_motion() -> None:
    two = Shakings((SHAKING, SHAKING.scaled(0.5)), np.array([0, 1]))
    values = {"total_mass": 1e4, "bearing_stiffness": 4e4}
    with pytest.raises(ValueError, match="one motion"):
        models.get("isolated").trajectories(values, two, first=np.zeros(2, np.int64), samples=10, initial={})


def test_what_remembers_more_than_its_states_is_refused() -> None:
    with pytest.raises(InputError, match="bounce remembers more than the motion"):
        bounces = {**BLOCK, "bounce.contact_restitution": 0.3}
        simulate(models.get("housner"), [Part(0, BLOCK), Part(100, bounces)], SHAKING)
    with pytest.raises(InputError, match="'isolated' cannot be cut"):
        simulate(models.get("isolated"), [Part(0, {}), Part(100, {})], SHAKING)


@pytest.mark.parametrize("name", models.MODELS)
def test_every_output_of_a_model_declares_what_it_is_of_a_run_in_parts(name: str) -> None:
    model = models.get(name)
    assert set(model.resumes_with or ()) <= set(model.mechanisms)
    assert not [quantity.name for quantity in model.outputs if quantity.over_parts is None]
    assert all(quantity.over_parts == "largest" for quantity in model.outputs if quantity.peak_of)
