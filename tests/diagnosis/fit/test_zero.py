"""What the record of a base tells of its accelerometer's zero."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diagnosis.errors.model import calibrated
from diagnosis.fit.misfit import ZERO_READING, Misfit
from diagnosis.fit.prediction import Predictor
from diagnosis.fit.setup import measure
from diagnosis.fit.unknowns import fixed_values, in_range
from diagnosis.fit.whitening import sensor_noise_only
from diagnosis.search.candidates import candidates
from diagnosis.search.found import Search, rivals
from diagnosis.search.refit import Explanation
from grids.recordings.base import Recording
from grids.recordings.suspicions import suspicions_of
from grids.recordings.zero import CUT, LEVEL, NU, zeros
from grids.stages import Stage
from tests.diagnosis.made import SPECIMEN, TIME_STEP, motion, recording, searched

OFFSET = 0.2


def read(base: np.ndarray) -> Recording:
    return Recording("run", TIME_STEP, TIME_STEP * np.arange(base.size), {"base_acceleration_x": base})


def test_a_base_that_comes_back_to_rest_tells_the_zero() -> None:
    base = [motion(seed).horizontal for seed in range(20)]
    right, wrong = zeros([read(b) for b in base]), zeros([read(b + OFFSET) for b in base])
    np.testing.assert_allclose(wrong.mean - right.mean, OFFSET)
    np.testing.assert_allclose(wrong.deviation, right.deviation, rtol=1e-6)
    assert np.all(np.abs(right.mean) < right.deviation) and np.all(wrong.mean > 3.0 * wrong.deviation)


def test_a_record_cut_anywhere_in_strong_motion_is_within_what_is_said() -> None:
    rng = np.random.default_rng(3)
    ends = [np.sort(rng.choice(1600, 2, replace=False)) for _ in range(200)]
    cut = [motion(k).horizontal[a:b] for k, (a, b) in enumerate(ends) if b - a > 600]
    found = zeros([read(b) for b in cut])
    z = found.mean / found.deviation
    assert len(cut) > 60
    assert np.sqrt(np.mean(z**2)) < 1.0 and np.max(np.abs(z)) < 3.0


def test_a_pulse_of_whole_cycles_and_a_base_at_rest() -> None:
    time = TIME_STEP * np.arange(400)
    pulse, still = 3.0 * np.sin(2.0 * np.pi * time / 0.5), np.full(400, 1e-3)
    found = zeros([read(pulse), read(still), read(np.zeros(400))])
    assert found.mean[:2] == pytest.approx([0.0, 1e-3], abs=1e-9)
    velocity = 3.0 * 0.5 / (2.0 * np.pi)  # (1 - cos) times this, for 2 s
    assert found.deviation[0] == pytest.approx(np.hypot(CUT * 2.0 * velocity / 2.0, LEVEL), rel=0.02)
    assert found.deviation[1] == pytest.approx(LEVEL, rel=1e-6)
    assert np.isinf(found.deviation[2]) and not np.any(found.rows(np.full(3, 0.5))[0][2])


@pytest.mark.parametrize("length", [300, 1000, 3000])
def test_a_half_sine_after_which_the_base_would_go_on_for_ever_suspects_nobody(length: int) -> None:
    time = TIME_STEP * np.arange(length)
    found = zeros([read(np.where(time < 0.5, 3.0 * np.sin(np.pi * time / 0.5), 0.0))])
    assert abs(found.mean[0]) < 3.0 * found.deviation[0]


@pytest.fixture(scope="module")
def misfit() -> Misfit:
    measured = measure(SPECIMEN, [recording("run_1", 1), recording("run_2", 2)])
    predictor = Predictor(measured)
    unknown = in_range(ZERO_READING, "m s-2", -0.5, 0.5)
    return Misfit(predictor, sensor_noise_only(predictor), (unknown,), fixed_values(SPECIMEN))


def test_the_rows_are_those_of_a_t_distribution_and_their_slope_is_a_finite_difference(misfit: Misfit) -> None:
    known, unknown = misfit.measured.zeros, misfit.unknowns[0]
    for offset in (-0.4, -0.02, 0.0, 0.3):
        u = np.array([unknown.coordinate(offset)])
        z = (known.mean - offset) / known.deviation
        assert misfit.prior(u) == pytest.approx(np.sum(NU * np.log1p(z**2 / NU)))
        step = 1e-5
        ahead, behind = (misfit.prior_rows(u + d)[0] for d in (step, -step))
        np.testing.assert_allclose(misfit.prior_rows(u)[1][:, 0], (ahead - behind) / (2.0 * step), rtol=1e-5)
    fixed = replace(misfit, unknowns=(), fixed={**misfit.fixed, ZERO_READING: 0.3})
    assert fixed.prior(np.zeros(0)) == pytest.approx(misfit.prior(np.array([unknown.coordinate(0.3)])))


def test_a_zero_that_moves_counts_over_the_share_of_the_recording(misfit: Misfit) -> None:
    duration = misfit.measured.recordings[0].time[-1]
    stages = Stage("run_1", duration / 4.0, duration), Stage("run_2", 0.0, 0.0)
    staged = replace(misfit, predictor=replace(misfit.predictor, stages={"accelerometer_offset": stages}))
    known = misfit.measured.zeros
    z = (known.mean - 0.3 * np.array([0.75, 0.0])) / known.deviation
    u, step = np.array([misfit.unknowns[0].coordinate(0.3)]), 1e-5
    assert staged.prior(u) == pytest.approx(np.sum(NU * np.log1p(z**2 / NU)), rel=1e-2)
    ahead, behind = (staged.prior_rows(u + d)[0] for d in (step, -step))
    np.testing.assert_allclose(staged.prior_rows(u)[1][:, 0], (ahead - behind) / (2.0 * step), rtol=1e-5)


def test_a_lean_and_a_wrong_zero_are_told_apart_though_the_block_moves_alike() -> None:
    """Rotations alone leave both within the gap of rivals."""
    for name, values in (("tilt", {"tilt": OFFSET / 9.81}), ("accelerometer_offset", {"offset": OFFSET})):
        made = [recording(f"run_{seed}", seed, {name: values}) for seed in (1, 2)]
        measured = measure(SPECIMEN, made)
        fitted, errors = calibrated(SPECIMEN, measured)
        some = tuple(c for c in candidates(measured, SPECIMEN) if c.name in ("tilt", "accelerometer_offset"))
        found = searched(Search(Explanation((), fitted), some, errors))
        assert found.best is not None and found.best.names == (name,)
        assert not rivals(found)


def test_a_reading_with_a_wrong_zero_is_suspected_and_a_right_one_is_not() -> None:
    base = motion(3).horizontal
    said = f"mean of {np.mean(base) + 0.3:+.2g} m s-2"
    assert not any("mean of" in one for one in suspicions_of(read(base)))
    assert any(said in one for one in suspicions_of(read(base + 0.3)))
