"""What is usually done: simulate from rest, least squares over the whole records, choose by BIC.

The base's width and height (with the laboratory's priors) and, for one mechanism of the same list after
the other, its parameters are fitted by `scipy.optimize.least_squares` to the recorded rotation;

    BIC = n log(SSR/n) + k log(n)

over the samples of both training recordings. The least BIC is the answer, if it is at least 10 below that
of the base; mechanisms within 10 of the best are its rivals. Intervals are those of the linearised fit.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import OptimizeResult, least_squares

from diagnosis.prove.answers import NOTHING
from grids.instruments import INSTRUMENTS, moved, recorded
from grids.instruments.base import Surroundings
from grids.recordings import Recording, noise_of, read_recording
from grids.specimen import Specimen, read_specimen
from models import get
from models.base import Mechanism, MechanismParameter

FloatArray = NDArray[np.float64]
Sensor = Mapping[str, Mapping[str, float]]

STRONG = 10.0
STARTS = (0.2,)
"""Shares of the way from the null to an end of the range that fits start from."""
EVALUATIONS = 10


def answer(folder: Path) -> dict[str, Any]:
    """The answer of this method to a case folder, in the form of `answers`."""
    specimen = read_specimen(folder / "specimen.toml")
    fit = _Fit(specimen, [read_recording(folder / f"train_{k}.nc") for k in (1, 2)])
    base = fit.best(None)
    fitted = {m.name: (m, fit.best(m)) for m in fit.mechanisms()}
    bic = {name: found["bic"] for name, (_, found) in fitted.items()}
    best = min(bic, key=lambda name: bic[name])
    if base["bic"] - bic[best] < STRONG:
        return {"verdict": "nothing_missing", "statement": "", **NOTHING}
    rivals = [
        {"name": name, "class": fitted[name][0].effect_class, "evidence_gap": bic[name] - bic[best]}
        for name in bic
        if name != best and bic[name] - bic[best] < STRONG
    ]
    mechanism, found = fitted[best]
    effect = {
        "name": best, "class": mechanism.effect_class, "parameters": found["parameters"],
        "evidence": base["bic"] - bic[best], "p_value": 0.0,
    }  # fmt: skip
    other = any(rival["class"] != mechanism.effect_class for rival in rivals)
    verdict = "cannot_tell_apart" if other else "missing"
    return {"verdict": verdict, "statement": "", **NOTHING, "effects": [effect], "rivals": rivals}


class _Fit:
    """Least squares on one specimen's recordings."""

    def __init__(self, specimen: Specimen, recordings: list[Recording]) -> None:
        self.specimen, self.recordings = specimen, recordings
        self.model = get(specimen.model)
        self.free = [name for name in ("width", "height") if name in specimen.tolerance]
        self.noise = [noise_of(r.channels["rotation_1"]).sigma for r in recordings]

    def mechanisms(self) -> list[Mechanism]:
        """Of the model and of the instruments; the vertical motion only where it was measured and left out."""
        measured = all("base_acceleration_z" in r.channels for r in self.recordings)
        found = [
            m for m in self.model.mechanisms.values()
            if m.name != "vertical_acceleration" or (measured and not self.specimen.vertical)
        ]  # fmt: skip
        return [*found, *(one for one in INSTRUMENTS.values() if "whole" not in one.acts)]

    def best(self, mechanism: Mechanism | None) -> dict[str, Any]:
        """The best fit of the base, with ``mechanism`` if given: BIC and the mechanism's parameters."""
        if mechanism is None:
            return self._fit(None, 1.0, 0.0)
        primary = mechanism.parameters[0]
        ends = {_inner(end, primary) for end in (primary.low, primary.high)} - {_inner(primary.null, primary)}
        fits = [self._fit(mechanism, end, share) for end in sorted(ends) for share in STARTS]
        return min(fits, key=lambda found: float(found["bic"]))

    def _fit(self, mechanism: Mechanism | None, end: float, share: float) -> dict[str, Any]:
        """From ``share`` of the way between the null and ``end`` (the parameter, or its inverse)."""
        count = len(self.free)
        start, low, high = [0.0] * count, [-3.0] * count, [3.0] * count
        step = [1e-2] * count
        if mechanism is not None:
            primary = mechanism.parameters[0]
            null = _inner(primary.null, primary)
            start.append(null + share * (end - null))
            bounds = sorted([_inner(primary.low, primary), _inner(primary.high, primary), null])
            low.append(bounds[0])
            high.append(bounds[-1])
            step.append(1e-3 * (bounds[-1] - bounds[0]))

        def residual(x: FloatArray) -> FloatArray:
            return np.asarray(self._misfit(x[None], mechanism)[0])

        def jacobian(x: FloatArray) -> FloatArray:
            way = np.where(x + step <= high, 1.0, -1.0) * step
            all_at_once = self._misfit(np.vstack([x, x + np.diag(way)]), mechanism)
            return np.asarray(((all_at_once[1:] - all_at_once[0]) / way[:, None]).T)

        x = np.clip(start, np.add(low, 1e-9), np.subtract(high, 1e-9))
        found: OptimizeResult = least_squares(
            residual, x, jac=jacobian, bounds=(low, high), x_scale="jac", max_nfev=EVALUATIONS
        )
        samples = sum(r.time.size for r in self.recordings)
        mean = 2.0 * found.cost / samples
        bic = samples * math.log(mean) + len(start) * math.log(samples)
        parameters = {}
        if mechanism is not None:
            covariance = np.linalg.pinv(found.jac.T @ found.jac) * mean
            error = 1.96 * math.sqrt(abs(covariance[count, count]))
            primary = mechanism.parameters[0]
            at = sorted(_outer(float(found.x[count] + s * error), primary) for s in (-1.0, 0.0, 1.0))
            parameters = {primary.name: {"low95": at[0], "estimate": at[1], "high95": at[2], "unit": primary.unit}}
        return {"bic": bic, "parameters": parameters}

    def _misfit(self, points: FloatArray, mechanism: Mechanism | None) -> FloatArray:
        """Residuals over the noise of both recordings, and the priors: (points, samples + priors)."""
        count, specimen = len(self.free), self.specimen
        base: dict[str, Any] = dict(specimen.parameters)
        for k, name in enumerate(self.free):
            base[name] = base[name] * (1.0 + specimen.tolerance[name] * points[:, k])
        if mechanism is None:
            return self._run(base, {}, points)
        primary = mechanism.parameters[0]
        given = {p.name: p.null for p in mechanism.parameters[1:]}
        values = np.array([_outer(float(v), primary) for v in points[:, count]])
        if mechanism.name not in INSTRUMENTS:
            named = {**given, primary.name: values}
            return self._run({**base, **{f"{mechanism.name}.{k}": v for k, v in named.items()}}, {}, points)
        rows = []
        for k, value in enumerate(values.tolist()):
            alone = {name: v[k : k + 1] if np.ndim(v) else v for name, v in base.items()}
            rows.append(self._run(alone, {mechanism.name: {**given, primary.name: value}}, points[k : k + 1])[0])
        return np.array(rows)

    def _run(self, values: Mapping[str, Any], sensor: Sensor, points: FloatArray) -> FloatArray:
        specimen, lanes = self.specimen, len(points)
        left_out = "vertical_acceleration.kappa" in values
        parts = []
        for recording, sigma in zip(self.recordings, self.noise, strict=True):
            shaking = moved(recording.shaking(bool(specimen.vertical) or left_out), sensor)
            shaking = replace(shaking, vertical_acts=not left_out)
            still = {"rotation_1": np.zeros(lanes), "rotation_rate_1": np.zeros(lanes)}
            ran = self.model.trajectories(
                values, shaking, first=np.zeros(lanes, np.int64), samples=recording.time.size, initial=still
            )["rotation_1"]
            for k in range(lanes if sensor else 0):
                true = {"rotation_1": ran[k]}
                measured = recording.channels["base_acceleration_x"]
                ran[k] = recorded(true, sensor, Surroundings(recording.time_step, measured))["rotation_1"]
            parts.append((recording.channels["rotation_1"] - ran) / sigma)
        return np.hstack([*parts, points[:, : len(self.free)]])


def _inner(value: float, parameter: MechanismParameter) -> float:
    return 1.0 / value if parameter.fit_inverse else value


def _outer(value: float, parameter: MechanismParameter) -> float:
    if not parameter.fit_inverse:
        return value
    return 1.0 / value if value > 0.0 else math.inf
