"""What would separate the rivals: a recording, a sensor, or a test that needs no shaking.

For an explanation A and its rival B the expected evidence of an experiment is what B, refitted within
what it has learnt (covariance V of its estimates), misses of A's noise-free windows:

    gain = min over du of |r + J du|^2 + du' V^-1 du
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from diagnosis.answer.whole_runs import no_run, sensed_run
from diagnosis.data.measured import Measured, arrange
from diagnosis.data.stretches import arrange_stretches, names_by_level
from diagnosis.errors.model import Errors
from diagnosis.fit.intervals import covariances
from diagnosis.fit.misfit import Misfit, reduce
from diagnosis.fit.solver import fit
from diagnosis.search.found import Near, Search
from diagnosis.search.refit import Explanation
from grids.recordings.base import CHANNELS, REQUIRED, SHARE, Recording
from models.base import Values
from models.errors import InputError
from models.kinematics import Place

SCALES = (0.7, 1.0, 1.4)
NEW_SENSOR_NOISE = 0.01
"""Noise assumed of a channel that is not measured yet, over its peak."""
OVERTURNED = 1.0
"""rad."""
LEAST = 1.0
"""Expected evidence under which an experiment is not offered: it would tell as good as nothing."""


def next_experiment(
    found: Search, near: Sequence[Near], planned: Mapping[str, Place] | None = None
) -> Mapping[str, Any] | None:
    """The best recording, the best extra sensor and a static test that would separate the first rivals.

    None where nothing would; recording and sensor None where none would. ``planned``: channels at positions on the
    bodies that could be recorded as well.
    """
    best = found.chosen
    own = set(best.classes)
    other = next((r.explanation for r in near if r.candidate.effect_class not in own), None)
    if other is None:
        return None
    measured = best.measured
    bank = {}
    for recording in measured.recordings:
        for scale in SCALES:
            made = _made(best, recording, scale, measured.channels)
            gain = _expected(best, other, made, found.errors) if made is not None else 0.0
            bank[recording.name, scale] = gain
    (name, scale), expected = max(bank.items(), key=lambda item: item[1])
    again = {"base_motion": name, "scale": scale, "expected_evidence": expected} if expected >= LEAST else None
    sensor = _sensor(best, other, found.errors, planned or {})
    mine = [c for c in best.candidates if c.name not in other.names]
    theirs = [c for c in other.candidates if c.name not in best.names]
    pair = (*mine, *theirs)
    static = "; or ".join(dict.fromkeys(c.mechanism.static_test for c in pair if c.mechanism.static_test))
    if not (again or sensor or static):
        return None
    return {"separates": [c.name for c in pair], "recording": again, "sensor": sensor, "static_test": static}


def _sensor(
    best: Explanation, other: Explanation, errors: Errors, planned: Mapping[str, Place]
) -> Mapping[str, Any] | None:
    """The channel that is not recorded yet and would add most evidence, on the same runs; None where none would."""
    measured = best.measured
    gains = {}
    for name in unrecorded(measured, planned, best.fitted.point.values):
        made = [_made(best, r, 1.0, (*measured.channels, name), planned) for r in measured.recordings]
        gains[name] = sum(_expected(best, other, m, errors) for m in made if m is not None)
    if not gains:
        return None
    name, expected = max(gains.items(), key=lambda item: item[1])
    if expected < LEAST:
        return None
    return {"channel": name, "noise": f"{NEW_SENSOR_NOISE:.0%} of its peak", "expected_evidence": expected}


def unrecorded(measured: Measured, planned: Mapping[str, Place], values: Values) -> list[str]:
    """The channels that recordings could hold and do not: standard ones of the model, at all levels, and planned."""
    m = measured
    points = m.model.points(values)
    standard = [q.name for q in m.model.observables if q.name in CHANNELS and q.unit != SHARE]
    names = [name for quantity in standard for name in names_by_level(quantity, points)]
    names += [name for name, place in planned.items() if place.body <= m.model.bodies_of(values)]
    held = [name for name in names if all(name in r.channels for r in m.recordings)]
    return [name for name in dict.fromkeys(names) if name not in (*m.channels, *held)]


def _made(
    explanation: Explanation, recording: Recording, scale: float, channels: Sequence[str],
    planned: Mapping[str, Place] | None = None,
) -> Recording | None:  # fmt: skip
    """What the explanation predicts for a base motion, with noise as recorded or assumed; None: nothing to compare."""
    if no_run(explanation, recording):
        return None
    measured = explanation.measured
    base = {k: v * scale for k, v in recording.channels.items() if k.startswith("base_acceleration")}
    motion = replace(recording, channels={**recording.channels, **base})
    places = {**(planned or {}), **recording.places}
    # rotations that were estimated from channels as recorded follow the new motion
    follow = [name for name in recording.estimated if name not in channels]
    ran = sensed_run(explanation, measured, motion, (*channels, *follow), more=places)
    rng = np.random.default_rng(0)
    found = dict(base)
    for name, values in ran.items():
        known = [c for c in measured.channels if c == name]
        sigma = float(measured.sigma[:, measured.channels.index(name)].mean()) if known else 0.0
        sigma = sigma or NEW_SENSOR_NOISE * float(np.max(np.abs(values)))
        found[name] = values + sigma * rng.normal(size=values.size)
    leading = ran[_leading(measured)]
    falls = measured.stretches is None and np.max(np.abs(leading)) > OVERTURNED
    if falls or not np.all(np.isfinite(leading)):
        return None
    used = {name: place for name, place in places.items() if name in found}
    return replace(recording, channels={**found, REQUIRED: base[REQUIRED]}, places=used)


def _leading(measured: Measured) -> str:
    """A channel in which a fall shows."""
    lead = measured.identification.leads[0].channel
    return lead if any(lead in r.estimated for r in measured.recordings) else measured.channels[0]


def _expected(truth: Explanation, rival: Explanation, made: Recording, errors: Errors) -> float:
    """Expected evidence for ``truth`` over ``rival`` from one more recording; 0 where one cannot be compared."""
    try:
        return _evidence(truth, rival, made, errors)
    except InputError:  # no window, or one that would be cut where an effect of theirs cannot be
        return 0.0


def _evidence(truth: Explanation, rival: Explanation, made: Recording, errors: Errors) -> float:
    fitted = rival.fitted
    true = truth.fitted
    windows = _arranged(fitted.measured, made, true.point.values)
    of_truth = replace(true.misfit.predictor, measured=windows)  # effects that begin do so in their own stages
    own = Misfit(of_truth, errors.of_sensors(windows), (), {**true.misfit.fixed, **true.values})
    point = own.point(np.zeros(0), fit(own, np.zeros(0), windows.states).states)
    clean = of_truth.predict([point])[0]
    predictor = replace(fitted.misfit.predictor, measured=replace(windows, values=clean * windows.mask))
    exact = Misfit(predictor, errors.expected(of_truth, point), fitted.misfit.unknowns, fitted.misfit.fixed)
    linear = exact.linearise(fitted.u, point.states)
    reduced = reduce(linear)
    weights = exact.weights(linear.residual)
    j = reduced.by_unknown
    sandwich, _ = covariances(fitted)
    known = np.linalg.pinv(sandwich, hermitian=True)
    hessian = np.einsum("w,wmi,wmj->ij", weights, j, j, optimize=True) + known
    gradient = np.einsum("w,wmi,wm->i", weights, j, reduced.residual, optimize=True)
    left = np.einsum("w,wm,wm->", weights, reduced.residual, reduced.residual, optimize=True)
    return float(max(left - gradient @ np.linalg.pinv(hessian, hermitian=True) @ gradient, 0.0))


def _arranged(like: Measured, made: Recording, values: Values) -> Measured:
    """One more recording, cut as those learned from were."""
    if like.stretches is not None:
        points = like.model.points(values)
        return arrange_stretches(
            like.model, [made], like.stretches, points, tuple(made.places), (), like.reference_peak
        )
    assert like.lengths is not None
    acts = like.shakings[0].vertical is not None and like.shakings[0].vertical_acts
    return arrange(like.in_own_steps.model, [made], acts, like.lengths, like.reference_peak)
