"""The corner of a filter that the noise went through, of spectra and of recordings."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import butter, sosfilt

from diagnosis.errors.corner import corner
from diagnosis.errors.model import disturbance_about, refitted
from diagnosis.errors.summary import summary
from diagnosis.fit.setup import base_fit, measure
from tests.diagnosis.made import SPECIMEN, TIME_STEP, scattered

FREQUENCY = np.arange(1.0, 50.0)
WINDOWS = 20


@pytest.mark.parametrize("order", [2, 4])
@pytest.mark.parametrize("true", [10.0, 20.0, 30.0, 38.0])
def test_half_of_the_density_is_left_at_the_corner(true: float, order: int) -> None:
    density = 1e-8 / (1.0 + (FREQUENCY / true) ** (2 * order))
    found = corner(FREQUENCY, density)
    assert found == pytest.approx(true, abs=2.0)
    drawn = density * np.random.default_rng(3).gamma(WINDOWS, 1.0 / WINDOWS, FREQUENCY.size)
    assert corner(FREQUENCY, drawn) == pytest.approx(true, abs=3.0)


def test_a_density_that_does_not_fall_to_half_has_no_corner() -> None:
    assert corner(FREQUENCY, np.ones_like(FREQUENCY)) is None
    assert corner(FREQUENCY, np.zeros_like(FREQUENCY)) is None
    assert corner(FREQUENCY[:9], 1.0 / FREQUENCY[:9] ** 4) is None


def test_a_line_of_hum_is_no_corner() -> None:
    density = np.where(FREQUENCY < 15.0, 1.0, 0.01) + np.where(np.abs(FREQUENCY - 35.0) < 0.6, 5.0, 0.0)
    assert corner(FREQUENCY, density) == pytest.approx(38.0, abs=1.0)
    assert corner(FREQUENCY, density, [35.0]) is None
    assert corner(FREQUENCY, np.where(FREQUENCY < 15.0, 1.0, 0.01), [35.0]) == pytest.approx(15.0, abs=1.0)


@pytest.mark.parametrize("true", [8.0, 16.0, 30.0])
def test_noise_that_a_filter_went_over_is_told_with_its_corner(true: float) -> None:
    def filtered(rng: np.random.Generator, n: int) -> np.ndarray:
        low_pass = butter(4, true, fs=1.0 / TIME_STEP, output="sos")
        noise = sosfilt(low_pass, rng.normal(size=n + 400))[400:]
        return np.asarray(noise / np.std(noise))

    measured = measure(SPECIMEN, [scattered(f"train_{k}", k, 0.0, 0.01, filtered) for k in (1, 6)])
    first = base_fit(SPECIMEN, measured)
    fitted, errors = refitted(first, disturbance_about(first))
    (found,) = summary(errors, fitted.measured).channels
    assert found.colour == "filtered" and found.corner_hz == pytest.approx(true, abs=2.0)
    peaks = [np.max(np.abs(recording.channels["rotation_1"])) for recording in measured.recordings]
    assert found.noise == pytest.approx(0.01 * np.mean(peaks), rel=0.4)
