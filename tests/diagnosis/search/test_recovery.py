"""Every mechanism, simulated, is seen by the screen and recovered by its own refit."""

from __future__ import annotations

from functools import cache

import pytest

import models
from diagnosis.fit.linearisation import linearise_about
from diagnosis.fit.setup import base_fit, measure
from diagnosis.search.candidates import candidates
from diagnosis.search.refit import Explanation, best_of, extend
from diagnosis.search.screen import score
from grids.instruments import INSTRUMENTS
from grids.instruments.base import Level
from tests.diagnosis.made import PEAK, SPECIMEN, recording
from tests.diagnosis.search.recovered import assert_recovered

EFFECTS: dict[str, dict[str, float]] = {
    "sliding": {"friction": 0.142},
    "pivot_inset": {"inset_over_half_width": 0.06},
    "rounded_corner": {"radius_over_half_width": 0.06},
    "crushing": {"inset_per_rotation": 1.0},
    "tilt": {"tilt": 0.004},
    "eccentricity": {"offset_over_half_width": 0.04},
    "flexible_joint": {"angle": 0.004},
    "added_stiffness": {"over_m_g_R": -0.1, "gap": 0.0},
    "table_pitch": {"pitch_per_acceleration": 0.0008, "low_pass_hz": 8.0},
    "restitution": {"factor_on_housner": 0.95},
    "velocity_restitution": {"beta": 0.15},
    "viscous_damping": {"rate": 0.15},
    "coulomb_damping": {"over_m_g_b": 0.015},
    "quadratic_damping": {"coefficient": 1.5},
    "degradation": {"loss_of_restitution_per_impact": 0.004, "floor": 0.7},
    "wall_flexibility": {"first_frequency": 10.0},
    "accelerometer_offset": {"offset": 0.06},
    "gain": {"gain": 0.04},
    "offset": {"offset_over_peak": 0.03},
    "delay": {"delay": 0.006},
    "clock": {"rate": 0.002},
    "filter": {"corner_hz": 8.0, "order": 2.0, "zero_phase": 0.0},
    "base_filter": {"high_pass_hz": 0.1},
    "base_gain": {"gain": 0.04},
    "drift": {"rate": 0.0004},
    "saturation": {"level_over_peak": 0.75},
    "cross_axis": {"rotation_per_acceleration": 0.0006},
}
"""One value of each, some times what the recordings can tell."""
NOT_HERE = {
    "vertical_acceleration": "the recordings of these tests have no vertical channel",
    "integrated_displacement": "it acts on whole recordings, and a block is compared in windows",
    "bounce": "it moves the response of slender blocks by less than the noise",
}


BY_THE_REFERENCE = "restitution"
"""Recorded by the plain reference: what is fitted is not what made it."""
TOLD_BY_TWO = ("sliding", "eccentricity")
"""Recorded twice: under the first motion alone hardly anything rocks, or a lean does as well."""


@cache
def base(name: str) -> Explanation:
    seeds = (1, 2) if name in TOLD_BY_TWO else (1,)
    return _base({name: EFFECTS[name]}, seeds, "reference" if name == BY_THE_REFERENCE else "lanes")


def _base(effect: dict[str, dict[str, float]], seeds: tuple[int, ...], integrator: str = "lanes") -> Explanation:
    recordings = [recording(f"train_{k}", k, effect, integrator=integrator) for k in seeds]
    return Explanation((), base_fit(SPECIMEN, measure(SPECIMEN, recordings), 0))


def test_every_mechanism_of_the_block_and_its_sensors_is_here() -> None:
    block = {name for name, one in models.get("housner").mechanisms.items() if not one.tabulated}
    assert set(EFFECTS) | set(NOT_HERE) == block | set(INSTRUMENTS)


@pytest.mark.parametrize("name", EFFECTS)
def test_a_simulated_effect_is_seen_and_recovered(name: str) -> None:
    before = base(name)
    own = [c for c in candidates(before.measured, SPECIMEN) if c.name == name and c.held.items() <= _held(name).items()]
    assert_recovered(before, own, _truth(name, before))


def test_a_low_pass_run_both_ways_is_told_from_a_causal_one() -> None:
    """It has no lag, so its own fit has to explain what no causal one does."""
    values = {"corner_hz": 4.0, "order": 2.0, "zero_phase": 1.0}
    before = _base({"filter": values}, (1,))
    low = [c for c in candidates(before.measured, SPECIMEN) if c.unknowns[0].name == "filter.corner_hz"]
    causal, own = ([c for c in low if c.held["filter.zero_phase"] == way] for way in (0.0, 1.0))
    assert len(causal) == len(own) == 4
    opened = linearise_about(before.fitted)
    assert_recovered(before, [c for c in own if c.held["filter.order"] == values["order"]], values["corner_hz"])
    best = score(opened, own)[0]  # its values are near one another: none but those near the true corner show it
    start = best.candidate.unknowns[0].value(float(best.starts[0][0]))
    assert best.candidate.held["filter.order"] == values["order"] and start == pytest.approx(
        values["corner_hz"], rel=0.1
    )
    causal_fits, own_fits = (
        [extend(before, s.candidate, start) for s in score(opened, some) for start in s.starts]
        for some in (causal, own)
    )
    assert best_of([before, *causal_fits]).loss > best_of(own_fits).loss + 20.0


def _held(name: str) -> dict[str, float]:
    """The true whole numbers, such as the order of a filter (those of others are in `test_variants`)."""
    return {f"{name}.{parameter}": value for parameter, value in EFFECTS[name].items()}


def _truth(name: str, before: Explanation) -> float:
    """The effect's parameter; a level over the peak is fitted over the one that was seen."""
    value = next(iter(EFFECTS[name].values()))
    level = name in INSTRUMENTS and isinstance(INSTRUMENTS[name].parameters[0], Level)
    return value * PEAK / before.measured.reference_peak if level else value
