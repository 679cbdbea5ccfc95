"""The bearings' laws: dissipation, closed forms of loops, Payne's amplitude, wear by cycles."""

from itertools import pairwise

import numba
import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from models.isolated import bearing
from models.isolated.lanes import bearing as compiled
from models.isolated.lanes import run as lanes
from models.isolated.lanes.rows import W
from models.rubber import lanes as rubber
from models.shaking import Shaking
from tests.models.isolated.buildings import BODY, HOUSE, LAWS, MODEL, chain, two_tones
from tests.models.requests import asked

TURNS = st.lists(st.floats(-0.15, 0.15), min_size=2, max_size=4)


def drive(values: dict[str, float], turns: list[float], steps: int = 60) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """u, force and stored energy on a slow path from 0 through ``turns``; the amplitude changes at each turn."""
    one = chain(values)
    memory = bearing.relaxed(one, np.zeros(1))
    outcome = [(0.0, 0.0, 0.0)]
    for start, end in pairwise([0.0, *turns]):
        memory = bearing.Memory(memory.hidden, np.array([abs(start)]), memory.crossings)
        turn, last = np.array([start]), start
        outcome.append(
            (start, float(bearing.spring_force(one, turn, memory)[0]), float(bearing.stored(one, turn, memory)[0]))
        )
        for u in np.linspace(start, end, steps + 1)[1:]:
            change = np.array([u - last])
            middle, hidden = np.array([0.5 * (u + last)]), memory.hidden
            # a second-order step of a law that does not know time, of a Maxwell arm at .3 s a turn
            duration = 0.3 / steps
            half = [h + 0.5 * duration * r for h, r in zip(
                hidden, one.layer.rates(np.array([last]), change / duration, hidden), strict=True)]  # fmt: skip
            rates = one.layer.rates(middle, change / duration, half)
            hidden = [h + duration * r for h, r in zip(hidden, rates, strict=True)]
            # u and its largest value so far may differ by rounding, and then the latter has no rate
            hidden = one.layer.reached(np.array([u]), hidden)
            crossings = memory.crossings + (1.0 if u * last < 0.0 else 0.0)
            memory = bearing.Memory(hidden, memory.amplitude, crossings)
            at = np.array([u])
            outcome.append(
                (u, float(bearing.spring_force(one, at, memory)[0]), float(bearing.stored(one, at, memory)[0]))
            )
            last = u
    return tuple(np.array(column) for column in zip(*outcome, strict=True))


@pytest.mark.parametrize("name", LAWS)
@settings(max_examples=2, deadline=None)
@example(turns=[0.115234375, 0.0])
@given(turns=TURNS)
def test_closed_cycles_never_give_energy_back(name: str, turns: list[float]) -> None:
    # the fourth round closes: what remembers has seen the path before (wear never closes: it stores less)
    once = len(turns) * 61
    u, force, stored = drive({**BODY, **LAWS[name]}, turns * 4)
    work = np.sum(0.5 * (force[1:] + force[:-1])[-once:] * np.diff(u)[-once:])
    assert work - (stored[-1] - stored[-once - 1]) >= -5e-4 * BODY["bearing_stiffness"] * np.max(np.abs(u)) ** 2


@pytest.mark.parametrize("name", sorted(set(LAWS) - {"payne"}))
@settings(max_examples=2, deadline=None)
@example(turns=[0.115234375, 0.0])
@given(turns=TURNS)
def test_what_is_put_in_is_stored_or_lost_at_any_time(name: str, turns: list[float]) -> None:
    # Payne's stiffness rises at a reversal, out of nothing: only its closed cycles lose
    u, force, stored = drive({**BODY, **LAWS[name]}, turns)
    work = np.cumsum(0.5 * (force[1:] + force[:-1]) * np.diff(u))
    lost = work - stored[1:]
    assert np.min(np.diff(lost, prepend=0.0)) > -1e-4 * BODY["bearing_stiffness"] * 0.15**2


def closed_form_zeta(u: np.ndarray, turned: np.ndarray, limit: float, n: int) -> np.ndarray:
    """zeta along u that turns at the indices ``turned``: straight while unloaded, exp or tanh while loaded."""
    virgin = (lambda x: -np.expm1(-x)) if n == 1 else np.tanh
    inverse = (lambda y: -np.log1p(-y)) if n == 1 else np.arctanh
    zeta = np.zeros_like(u)
    for start, end in pairwise([0, *turned, u.size - 1]):
        way = np.sign(u[end] - u[start])
        path = way * (u[start : end + 1] - u[start])
        first = way * zeta[start]
        # length of the path until zeta is zero (negative: on the loaded branch already)
        free = -first if first < 0.0 else -limit * inverse(first / limit)
        zeta[start : end + 1] = way * np.where(
            path <= free, first + path, limit * virgin(np.maximum(path - free, 0.0) / limit)
        )
    return zeta


@pytest.mark.parametrize("n", [1, 2])
def test_bouc_wen_loops_follow_their_closed_forms(n: int) -> None:
    values = {**BODY, **LAWS[f"bouc_wen, n {n}"]}
    step = 0.001
    shaking = two_tones(step=step)
    outcome = MODEL.simulate(values, shaking).channels
    u, v = outcome["bearing_displacement"], outcome["bearing_velocity"]
    turned = np.flatnonzero(v[1:-1] * v[2:] < 0.0) + 1
    assert turned.size >= 5
    zeta = closed_form_zeta(u, turned.tolist(), 0.01, n)
    k = BODY["bearing_stiffness"]
    force = 0.2 * k * u + 0.8 * k * zeta + BODY["bearing_damping"] * v
    np.testing.assert_allclose(outcome["bearing_force"], force, rtol=0, atol=2e-5 * np.max(np.abs(force)))


def test_payne_stiffness_is_that_of_the_cycle() -> None:
    # free swings without a dashpot: at the turns the force is k(A) A of the swing that ends there
    values = {**BODY, **LAWS["payne"], "bearing_damping": 2e4}
    outcome = MODEL.simulate(values, Shaking.silence(20.0, 0.002), initial={"bearing_displacement": 0.12}).channels
    u, v, force = outcome["bearing_displacement"], outcome["bearing_velocity"], outcome["bearing_force"]
    turns = np.flatnonzero((v[1:-1] * v[2:] <= 0.0) & (np.abs(u[1:-1]) > 1e-3)) + 1
    assert turns.size > 8
    amplitudes = np.abs(u[turns])
    assert np.all(np.diff(amplitudes) < 0.0)
    # just before a turn the amplitude is still the last one, just after it is this one
    for k, turn in enumerate(turns[1:], start=1):
        for at, amplitude in ((turn - 2, amplitudes[k - 1]), (turn + 3, amplitudes[k])):
            stiffness = (force[at] - values["bearing_damping"] * v[at]) / u[at]
            loss = 0.5 * -np.expm1(-amplitude / (0.5 * 0.1))
            assert stiffness == pytest.approx(BODY["bearing_stiffness"] * (1 - loss), rel=2e-4)


def test_wear_counts_full_cycles() -> None:
    values = {**BODY, **LAWS["degradation"], "bearing_damping": 2e4}
    for start in (0.1, -0.1):
        outcome = MODEL.simulate(values, Shaking.silence(20.0, 0.002), initial={"bearing_displacement": start}).channels
        u, v, force = outcome["bearing_displacement"], outcome["bearing_velocity"], outcome["bearing_force"]
        crossings = np.concatenate([[0], np.cumsum(u[1:] * u[:-1] < 0.0)])
        assert crossings[-1] > 10
        expected = BODY["bearing_stiffness"] * (1 - 0.6 * (1 - np.exp(-(crossings // 2) / 3.0))) * u
        found = force - values["bearing_damping"] * v
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-6 * np.max(np.abs(expected)))


def test_shaking_never_takes_energy_out_of_bearings() -> None:
    rng = np.random.default_rng(7)
    for name, law in LAWS.items():
        values = {**HOUSE, **law, "bearing_damping": 0.0, "storey_damping": 0.0}
        one = chain({**values, "bearing_stiffness": rng.uniform(1e6, 6e6, 16)})
        outcome = lanes.run(one, asked(two_tones(step=0.005), rng.uniform(0.2, 1.5, 16))).outputs
        size = one.stiffness * outcome["peak_bearing_displacement"] ** 2
        assert np.all(outcome["dissipated_energy"] > -2e-4 * size), name


@pytest.mark.parametrize("name", ["linear", "hardening"])
def test_springs_of_the_kernel_carry_what_the_law_says(name: str) -> None:
    """One look from rest, by the compiled piece alone, against the plain form of the law."""
    one = chain({**BODY, **LAWS.get(name, {})}, size=W)
    laws, u = one.rubber_laws, np.random.default_rng(1).uniform(-0.1, 0.1, W)
    spring = np.zeros(compiled.N_SPRING)
    spring[compiled.K : compiled.K + W], spring[compiled.U : compiled.U + W] = one.stiffness, u
    numbers = rubber.number_table(laws, np.full(W, 0.01)).T.ravel()
    spring[compiled.P_LAWS : compiled.P_LAWS + numbers.size] = numbers

    @numba.njit
    def look(table, which):
        compiled.springs_all(table, which)

    look(spring, rubber.acting(laws))
    carried = spring[compiled.WHOLE : compiled.WHOLE + W]
    np.testing.assert_allclose(carried, one.layer.stress(u, one.layer.relaxed(u)), rtol=1e-13)
