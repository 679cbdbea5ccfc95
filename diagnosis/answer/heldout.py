"""Before and after: windowed misfit, on the recordings fitted to and on those held out.

Parameters stay frozen; only the windows' initial states are estimated anew. The misfit is the rms
residual over all windows, each channel over the rms of its recording; the noise floor is the same
of the sensors' noise.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np
from numpy.typing import NDArray

from diagnosis.answer.result import Fit, HeldStage, Trace, Windows
from diagnosis.answer.when import as_stages, held_stages
from diagnosis.data.measured import Measured, seen_as
from diagnosis.data.noise import RELATIVE_FLOOR
from diagnosis.errors.model import Errors
from diagnosis.fit.growing import fit_followed
from diagnosis.fit.memory import counted
from diagnosis.fit.misfit import Misfit
from diagnosis.fit.prediction import Point, Predictor
from diagnosis.fit.solver import Fitted, fit, fit_thoroughly
from diagnosis.fit.starts import nominal
from diagnosis.fit.whitening import sensor_noise_only
from diagnosis.search.refit import Explanation
from models.base import FloatArray

HORIZON = 4.0
"""s that a prediction is followed beyond a window's start."""
LEAVES = 4.0
"""Levels over the noise at which a prediction has left the measurement."""
AVERAGED = 5


@dataclass(frozen=True)
class Shown:
    """Predictions (W, C, N) of the windows of ``measured`` before and after, with the points used."""

    measured: Measured
    before: FloatArray
    after: FloatArray
    point_before: Point
    point_after: Point
    held_stages: tuple[HeldStage, ...] = ()
    """When effects that do not always act do so in these recordings, if they were not learned from."""


def as_far_as_followed(held: Measured, base: Fitted) -> Measured:
    """Recordings held out, in windows that grow as those of the base fit did (`diagnosis.fit.growing`)."""
    if not held.parts_quickly:
        return held
    predictor = replace(base.misfit.predictor, measured=held)
    plain = Misfit(predictor, sensor_noise_only(predictor), (), base.point.values)
    return fit_followed(plain, [nominal(plain)]).measured


def frozen(
    explanation: Explanation, measured: Measured, errors: Errors, held: Sequence[HeldStage] = ()
) -> tuple[Point, FloatArray]:  # fmt: skip
    """The explanation's parameters on other windows: the point with fitted states, and channels (W, C, N).

    The states are weighed by the sensors' ``errors``.
    """
    misfit = explanation.fitted.misfit
    measured = seen_as(measured, explanation.measured)
    if not measured.free:
        fixed = {**misfit.fixed, **explanation.fitted.values}
        predictor = replace(with_held(misfit.predictor, held), measured=measured)
        point = Point(fixed, measured.states, predictor.coordinates)
        return point, predictor.predict([point])[0]
    found = _with_states(explanation, measured, errors, held)
    point, predictor = found.misfit.point(found.u, found.states), found.misfit.predictor
    return point, replace(predictor, measured=counted(predictor, point)).predict([point])[0]


def _with_states(
    explanation: Explanation, measured: Measured, errors: Errors, held: Sequence[HeldStage] = ()
) -> Fitted:  # fmt: skip
    """The states of windows estimated anew, parameters frozen; again with the events before each window counted."""
    misfit, own = explanation.fitted.misfit, explanation.measured
    fixed = {**misfit.fixed, **explanation.fitted.values}
    predictor = replace(with_held(misfit.predictor, held), measured=measured)
    learned = measured.windows == own.windows and measured.recordings == own.recordings
    states, whitening = explanation.fitted.states if learned else measured.states, errors.of_sensors(measured)
    first = fit_thoroughly(Misfit(predictor, whitening, (), fixed), np.zeros(0), states)
    predictor = replace(predictor, measured=counted(predictor, first.misfit.point(first.u, first.states)))
    return fit(Misfit(predictor, whitening, (), fixed), np.zeros(0), first.states)


def likelier(before: Explanation, after: Explanation, held: Measured, errors: Errors) -> float:
    """How much likelier (2 log likelihood) ``after`` makes recordings that neither was fitted to; 0 without states."""
    if not held.free:
        return 0.0
    one, other = (_with_states(e, seen_as(held, e.measured), errors).loss for e in (before, after))
    return float(one - other)


def compare(
    before: Explanation, after: Explanation, measured: Measured, errors: Errors, known: Shown | None = None
) -> Shown:  # fmt: skip
    """Both explanations on some recordings, states estimated anew; those of ``before`` as they are ``known`` to be."""
    learned = {r.name for r in after.measured.recordings}
    held: tuple[HeldStage, ...] = ()
    if not any(r.name in learned for r in measured.recordings):
        misfit = after.fitted.misfit
        seen = seen_as(measured, after.measured)
        predictor = replace(misfit.predictor, measured=seen)
        fixed = {**misfit.fixed, **after.fitted.values}
        held = held_stages(after, Misfit(predictor, errors.of_sensors(seen), (), fixed), seen.states)
    point, predicted = (known.point_before, known.before) if known else frozen(before, measured, errors)
    own, shown = frozen(after, measured, errors, held)
    return Shown(measured, predicted, shown, point, own, held)


def with_held(predictor: Predictor, held: Sequence[HeldStage]) -> Predictor:
    """The predictor with the stages of recordings held out after those learned from."""
    stages = {name: (*predictor.stages.get(name, ()), *more) for name, more in as_stages(held).items()}
    return replace(predictor, stages={**predictor.stages, **stages})


def worsens(before: Explanation, after: Explanation, held: Measured, errors: Errors) -> bool:
    """Whether recordings that neither was fitted to are predicted worse by ``after``."""
    shown = compare(before, after, held, errors)
    return relative_misfit(held, shown.after) > relative_misfit(held, shown.before)


def relative_misfit(measured: Measured, predicted: FloatArray | None) -> float:
    """Rms over windows and channels of the residual over the recording's rms; of the noise for None."""
    cells = product(range(len(measured.recordings)), range(len(measured.channels)))
    return _rms([_squares(measured, predicted, r, c) for r, c in cells])


def channel_misfit(measured: Measured, predicted: FloatArray, r: int, c: int) -> float:
    """The same of one channel in one recording."""
    return _rms([_squares(measured, predicted, r, c)])


def _squares(measured: Measured, predicted: FloatArray | None, r: int, c: int) -> tuple[float, float]:
    """Sum of squares of channel ``c`` in the windows of recording ``r``, over its mean square, and their number."""
    windows = np.flatnonzero(measured.recording_of == r)
    mask = measured.mask[windows, c]
    rms = float(np.sqrt(np.mean(measured.recordings[r].channels[measured.channels[c]] ** 2)))
    if not mask.any() or rms == 0.0:
        return 0.0, 0.0
    if predicted is None:
        square = float(np.sum(mask * measured.sigma[windows, c][:, None] ** 2))
    else:
        rest = (predicted - measured.values)[windows, c]
        square = float(np.sum(np.where(np.isfinite(rest), rest, rms)[mask] ** 2))
    return square / rms**2, float(mask.sum())


def _rms(parts: Sequence[tuple[float, float]]) -> float:
    """The root of the mean square; nan where nothing is compared."""
    squares, counts = (sum(one) for one in zip(*parts, strict=True))
    return float(np.sqrt(squares / counts)) if counts else np.nan


def fit_figures(shown: Shown, missing: bool) -> Fit:
    before, after = (relative_misfit(shown.measured, p) for p in (shown.before, shown.after))
    floor = relative_misfit(shown.measured, None)
    share = (before - after) / (before - floor) if missing and before > floor else None
    return Fit(before, after, floor, share, _noise_free(shown.measured))


def _noise_free(m: Measured) -> bool:
    """Whether the noise of every channel is the least that is assumed."""
    peak = np.array([[np.max(np.abs(r.channels[c])) for c in m.channels] for r in m.recordings])
    return bool(np.all(m.sigma <= 1.001 * RELATIVE_FLOOR * peak[m.recording_of]))


def windows_of(shown: Shown, held_out: bool) -> list[Windows]:
    """Rms residual over noise of every window, by recording and channel."""
    m = shown.measured
    found = []
    for r, recording in enumerate(m.recordings):
        own = np.flatnonzero(m.recording_of == r)
        start = np.array([m.windows[w].first for w in own]) * recording.time_step
        length = np.array([m.windows[w].samples for w in own]) * recording.time_step
        for c, channel in enumerate(m.channels):
            sizes = [_over_noise(m, p, own, c) for p in (shown.before, shown.after)]
            found.append(Windows(recording.name, channel, held_out, start, start + length, *sizes))
    return found


def _over_noise(m: Measured, predicted: FloatArray, own: NDArray[np.intp], c: int) -> FloatArray:
    rest = np.where(m.mask[own, c], (predicted - m.values)[own, c], 0.0)
    return np.asarray(np.sqrt((rest**2).sum(axis=1) / m.mask[own, c].sum(axis=1)) / m.sigma[own, c])


def traces_of(shown: Shown, held_out: bool) -> list[Trace]:
    """Measured and predicted channels over time, nan where nothing is compared."""
    m = shown.measured
    found = []
    for r, recording in enumerate(m.recordings):
        own = np.flatnonzero(m.recording_of == r)
        for c, channel in enumerate(m.channels):
            pair = []
            for predicted in (shown.before, shown.after):
                trace = np.full(recording.time.size, np.nan)
                for w in own:
                    window = m.windows[w]
                    here = np.where(m.mask[w, c], predicted[w, c], np.nan)[: window.samples]
                    trace[window.first : window.first + window.samples] = here
                pair.append(trace)
            found.append(
                Trace(recording.name, channel, m.unit_of(channel), held_out, recording.time,
                      recording.channels[channel], pair[0], pair[1])
            )  # fmt: skip
    return found


def horizons(shown: Shown, before: Predictor, after: Predictor) -> dict[str, tuple[float, float]]:
    """By recording: median seconds from a window's start until a prediction leaves the noise; inf where it does not.

    ``before``, ``after``: what predicts the recordings learned from."""
    from scipy.ndimage import uniform_filter1d

    m = shown.measured
    longer = lengthened(m)
    times = []
    for predictor, point in ((before, shown.point_before), (with_held(after, shown.held_stages), shown.point_after)):
        predicted = replace(predictor, measured=seen_as(longer, predictor.measured)).predict([point])[0]
        rest = np.where(longer.mask, predicted - longer.values, 0.0) / longer.sigma[..., None]
        smooth = uniform_filter1d(rest, AVERAGED, axis=-1)
        out = np.any(np.abs(smooth) > LEAVES, axis=1)
        # the end of a recording is no end of the agreement
        times.append(np.where(np.any(out, axis=1), np.argmax(out, axis=1), np.inf))
    found = {}
    for r, recording in enumerate(m.recordings):
        own = m.recording_of == r
        if own.any():
            pair = [float(np.median(t[own])) * recording.time_step for t in times]
            found[recording.name] = (pair[0], pair[1])
    return found


def lengthened(m: Measured) -> Measured:
    """The same windows, each followed for HORIZON seconds or to the end of its recording."""
    windows = tuple(
        replace(w, samples=min(int(HORIZON / m.recordings[w.recording].time_step),
                               m.recordings[w.recording].time.size - w.first))
        for w in m.windows
    )  # fmt: skip
    return m.cut_again(windows)
