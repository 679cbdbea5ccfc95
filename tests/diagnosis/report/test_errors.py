"""The errors as the page shows them: one spectrum and one autocorrelation a channel."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diagnosis.errors.adequacy import Inadequacy, Repeatability
from diagnosis.errors.summary import ChannelErrors, ErrorModel, Line, Spectrum
from diagnosis.errors.words import error_lines
from diagnosis.report.figures import plot_errors
from diagnosis.report.figures.panels import figure_of
from diagnosis.report.json_file import diagnosis_json
from tests.diagnosis.report.example import diagnosis
from tests.diagnosis.report.schema import AnswerFile

FREQUENCY = np.arange(1.0, 50.0)
SPECTRUM = Spectrum(
    tuple(FREQUENCY), tuple(1e-8 / FREQUENCY), tuple(1.1e-8 / FREQUENCY), (0.0, 0.01, 0.02), (1.0, 0.02, -0.01), 0.05
)
CHANNEL = ChannelErrors("rotation_1", "rad", 3e-4, "low", None, 2e-4, 0.0, (Line(12.3, 1e-4),), SPECTRUM)
ERRORS = ErrorModel(
    (CHANNEL,),
    Repeatability("impacts", 0.014, 0.01, 0.019, 40.0, False),
    (0.01,),
    0.0,
    Inadequacy((0.0,), 0.0, 0.0, True),
    3.0,
)


@pytest.mark.parametrize("width", [12.0, 5.2])
def test_both_curves_are_drawn(width: float) -> None:
    left, right = plot_errors(CHANNEL, width=width)
    drawn = [line.get_ydata() for line in left.get_lines()]
    np.testing.assert_allclose(drawn, [SPECTRUM.found, SPECTRUM.estimated])
    assert len(right.collections[0].get_segments()) == 2
    assert figure_of(left) is figure_of(right)


def test_the_words_say_what_was_found_and_no_more() -> None:
    said = " ".join(error_lines(ERRORS))
    assert "Impacts repeat to 1.4%" in said and "hum at 12.3 Hz" in said and "drift of 0.0002 rad" in said
    assert "base_acceleration_x: noise of 0.01 m s-2, that of its quietest tenth" in said
    assert "smooth error" not in said and "grows" not in said and "zero" not in said
    two = " ".join(error_lines(replace(ERRORS, base_noise=(0.02, 0.01))))
    assert "noise of 0.01 to 0.02 m s-2" in two
    for none in (replace(ERRORS, base_noise=(0.0,)), replace(ERRORS, base_drift=None)):
        assert "base_acceleration_x" not in " ".join(error_lines(none))
    assert "zero drifts by 0.7% of the peak, or the base tilts" in " ".join(
        error_lines(replace(ERRORS, base_drift=0.007))
    )
    filtered = replace(ERRORS, channels=(replace(CHANNEL, colour="filtered", corner_hz=30.0),))
    assert "rotation_1: noise of 0.0003 rad that a filter weakens above 30 Hz, drift" in " ".join(error_lines(filtered))
    hidden = replace(ERRORS, channels=(replace(CHANNEL, colour="filtered"),))
    assert "rotation_1: noise of 0.0003 rad without its high frequencies" in " ".join(error_lines(hidden))
    large = replace(ERRORS, inadequacy=Inadequacy((1e-3,), 4.0, 60.0, True))
    assert "4.0 times the variance" in " ".join(error_lines(large))
    assert "not told apart" in " ".join(error_lines(replace(ERRORS, inadequacy=Inadequacy((0.0,), 0.0, 0.0, False))))


def test_impacts_at_the_limit_of_what_is_taken_for_scatter_are_warned_of() -> None:
    assert ERRORS.scatter is not None
    scatter = replace(ERRORS.scatter, estimate=0.03, low95=0.027, high95=0.05, at_limit=True)
    said = " ".join(error_lines(replace(ERRORS, scatter=scatter)))
    assert (
        "Impacts scatter by 3.0% or more, which is the most that is taken for scatter" in said and "repeat" not in said
    )


def test_the_file_holds_them() -> None:
    filtered = replace(ERRORS, channels=(replace(CHANNEL, colour="filtered", corner_hz=30.0),))
    found = replace(diagnosis("nothing_missing"), errors=filtered, not_tried={"bounce": "it refuses"})
    read = AnswerFile.model_validate_json(diagnosis_json(found))
    assert read.errors is not None and read.errors.channels[0].hum[0].frequency == 12.3
    assert read.errors.channels[0].corner_hz == 30.0
    assert read.not_tried[0].why == "it refuses"
