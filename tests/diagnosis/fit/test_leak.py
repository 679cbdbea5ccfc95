"""What rotation sensors read of the base: of its true motion, on the clock of the responses, in windows and in runs."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.interpolate import CubicSpline

from diagnosis.answer.whole_runs import sensed_run
from diagnosis.fit.along import Along
from diagnosis.fit.prediction import Point
from diagnosis.fit.setup import base_fit, measure
from diagnosis.forces.action import action
from diagnosis.search.refit import Explanation
from tests.diagnosis.made import SPECIMEN, TRUE, recording

LEAK, GAIN, DELAY, RATE = 0.004, 0.1, 0.015, 0.004
OTHERS = {"base_gain.gain": GAIN, "delay.delay": DELAY, "clock.rate": RATE}


def test_windows_and_runs_read_the_base_as_it_moves() -> None:
    measured = measure(SPECIMEN, [recording("run", 1)])
    fitted = base_fit(SPECIMEN, measured)
    predictor, states = fitted.misfit.predictor, fitted.states

    def with_leak(size: float) -> np.ndarray:
        values = {**TRUE, **OTHERS, "cross_axis.rotation_per_acceleration": size}
        return np.asarray(predictor.predict([Point(values, states)])[0])

    base = measured.recordings[0].channels["base_acceleration_x"]
    time = measured.recordings[0].time
    at = (1.0 + RATE) * time - DELAY
    inner = (at > 0.0) & (at < time[-1])
    expected = LEAK * (1.0 + GAIN) * np.where(inner, CubicSpline(time, base)(at), 0.0)
    leak = (with_leak(LEAK) - with_leak(0.0))[:, 0]
    for w, window in enumerate(measured.windows):
        inside = slice(window.first, window.first + window.samples)
        np.testing.assert_allclose(leak[w, : window.samples], expected[inside], atol=2e-3 * LEAK * np.max(np.abs(base)))

    point = Point({**TRUE, **OTHERS, "cross_axis.rotation_per_acceleration": LEAK}, states)
    error = action(predictor, point, "cross_axis").amount[:, 0]
    np.testing.assert_allclose(error[measured.mask[:, 0]], leak[measured.mask[:, 0]], atol=1e-9)
    along, windows = Along(predictor, point), np.arange(len(measured.windows))
    again = along.recorded(windows, np.zeros(windows.size, np.intp), along.plain[0])[:, 0]
    wanted = with_leak(LEAK)[:, 0]
    np.testing.assert_allclose(again[measured.mask[:, 0]], wanted[measured.mask[:, 0]], atol=1e-9)

    def whole(size: float) -> np.ndarray:
        fixed = {**TRUE, **OTHERS, "cross_axis.rotation_per_acceleration": size}
        misfit = replace(fitted.misfit, unknowns=(), fixed=fixed)
        explained = Explanation((), replace(fitted, misfit=misfit, u=np.zeros(0)))
        return sensed_run(explained, measured, measured.recordings[0], ["rotation_1"])["rotation_1"]

    run = whole(LEAK) - whole(0.0)
    linear = LEAK * (1.0 + GAIN) * np.interp(at, time, base)
    np.testing.assert_allclose(run[inner], linear[inner], atol=1e-9)
