"""Walls on rubber: every mechanism, simulated, is seen by the screen and recovered by its own refit."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import models
from diagnosis.errors.model import disturbance_about, estimate
from diagnosis.fit.linearisation import linearise_about
from diagnosis.fit.setup import measure
from diagnosis.fit.solver import fit_thoroughly
from diagnosis.search.candidates import candidates
from diagnosis.search.refit import Explanation
from diagnosis.search.screen import score
from diagnosis.search.thresholds import from_measured, misfits, setting_in
from grids.instruments import INSTRUMENTS
from grids.recordings.base import Recording
from tests.diagnosis.search.recovered import (
    SENSORS,
    assert_directions,
    assert_recovered,
    own_candidates,
    simulated,
    true_value,
)
from tests.diagnosis.walls import TRUE, WALL, misfit

EFFECTS: dict[str, dict[str, float]] = {
    "vertical_acceleration": {"kappa": 1.0},
    "sliding": {"friction": 0.085},
    "pivot_inset": {"inset_over_half_width": 0.08},
    "tilt": {"tilt": 0.004},
    "eccentricity": {"offset_top": 0.02},
    "contact_length": {"frozen": 0.2},
    "added_stiffness": {"couple_stiffness": 2e5, "gap": 0.0},
    "one_sided_stiffness": {"right_over_left": 1.25},
    "table_pitch": {"pitch_per_acceleration": 0.0005, "low_pass_hz": 8.0},
    "viscous_damping": {"couple_damping": 3e4},
    "coulomb_damping": {"over_m_g_b": 0.02},
    "degradation": {"final_loss": 0.3, "cycles": 5.0},
    "hardening": {"beta2": 15.0},
    "locking": {"lock_strain": 0.8},
    "maxwell": {"arm_stiffness_ratio": 0.3, "relaxation_time": 0.1},
    "bouc_wen": {"post_yield_ratio": 0.6, "yield_compression": 0.001, "exponent": 1.0},
    "mullins": {"softening": 0.2, "strain": 0.2},
    "permanent_set": {"rate": 0.5, "strain_limit": 0.3},
    "interface_shear": {"shear_over_normal": 1.0},
    "bonded_layer": {"tearing_strain": 0.02},
    "wall_flexibility": {"flexural_stiffness_ratio": 10.0},
    **SENSORS,
}
NOT_HERE = {"integrated_displacement": "it acts on whole recordings, and walls are compared in windows"}
SLIPS = "sliding"
"""It has no slope at its null, and where a base slips the windows of the plain wall end far from their states: fitted
from the measured ones."""
SPECIMEN = replace(WALL, vertical=False)


def recorded(name: str, seed: int) -> Recording:
    return simulated("interface", TRUE, {name: EFFECTS[name]}, seed, 3.0)


@cache
def base(name: str) -> Explanation:
    return fitted([recorded(name, seed) for seed in (1, 2)])


def fitted(recordings: list[Recording]) -> Explanation:
    """From the true layers: how the search comes there is another test's."""
    measured = measure(SPECIMEN, recordings)
    one = misfit(measured)
    true = np.array([x.coordinate(TRUE[x.name]) for x in one.unknowns])
    return Explanation((), fit_thoroughly(one, true, measured.states))


def test_every_mechanism_of_walls_and_their_sensors_is_here() -> None:
    own = {name for name, one in models.get("interface").mechanisms.items() if not one.tabulated}
    assert set(EFFECTS) | set(NOT_HERE) == own | set(INSTRUMENTS)


@pytest.mark.parametrize("name", [name for name in EFFECTS if name != SLIPS])
def test_the_direction_of_the_score_is_a_finite_difference(name: str) -> None:
    own = own_candidates(base(name), SPECIMEN, name, EFFECTS[name])
    assert_directions(base(name).fitted, own, 0.95 if name == "locking" else 0.99)  # stresses grow faster than the step


@pytest.mark.parametrize("name", [name for name in EFFECTS if name != SLIPS])
def test_a_simulated_effect_is_seen_and_recovered(name: str) -> None:
    before = base(name)
    assert_recovered(
        before, own_candidates(before, SPECIMEN, name, EFFECTS[name]), true_value(before, name, EFFECTS[name])
    )


def test_a_base_that_slips_is_recovered_from_measured_states() -> None:
    before, (slip,) = base(SLIPS), own_candidates(base(SLIPS), SPECIMEN, SLIPS, EFFECTS[SLIPS])
    others = [c for c in candidates(before.measured, SPECIMEN) if c.name in ("filter", "wall_flexibility")]
    assert misfits(before, estimate(before.fitted, disturbance_about(before.fitted)))
    assert setting_in(before, [slip, *others]) == [slip]
    found = min(from_measured(before, slip), key=lambda e: e.loss)
    assert before.loss - found.loss > 10_000.0
    assert found.fitted.values[f"{SLIPS}.friction"] == pytest.approx(EFFECTS[SLIPS]["friction"], rel=0.01)


def test_friction_that_never_slips_is_not_fitted() -> None:
    before, (slip,) = base("tilt"), own_candidates(base("tilt"), SPECIMEN, SLIPS, EFFECTS[SLIPS])
    never = replace(slip, unknowns=(replace(slip.unknowns[0], low=1.0),))
    assert not from_measured(before, never)


def test_a_set_that_begins_at_less_strain_than_its_search_does_is_seen() -> None:
    """At the start of the limit it never acts: the slope is that at another limit, and where the fit begins."""
    law = {"permanent_set": EFFECTS["permanent_set"]}
    before = fitted([simulated("interface", TRUE, law, seed, 1.5) for seed in (1, 2)])
    (own,) = own_candidates(before, SPECIMEN, "permanent_set", law["permanent_set"])
    rate, limit = own.unknowns
    far = replace(own, unknowns=(rate, replace(limit, start=1.9)))
    screen = linearise_about(before.fitted)
    for small in (False, True):
        (seen,) = score(screen, [far], small=small)
        assert seen.slope and seen.trial is not None and limit.value(seen.trial[1]) < 0.7
        assert seen.starts_from(2.0)[0].tolist() == [2.0, seen.trial[1]]
        assert screen.product(seen.column, seen.column) * 20.0**2 > 1000.0
