"""A simulated effect against its own refit: seen by the screen, worth its gain, its size within its deviations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

import models
from diagnosis.fit.intervals import covariances
from diagnosis.fit.linearisation import linearise_about
from diagnosis.fit.solver import Fitted
from diagnosis.search.candidates import Candidate, candidates
from diagnosis.search.refit import Explanation, again, best_of, extend, with_memory
from diagnosis.search.screen import at, score
from grids.instruments import INSTRUMENTS, moved, recorded
from grids.instruments.base import Level, Surroundings
from grids.recordings.base import Recording
from grids.specimen import Specimen
from models.shaking import Shaking
from tests.diagnosis.made import as_read, motion

NOISE = 0.01
"""Of each rotation's peak."""
LEVELS_OVER = 0.05
"""rad, over which levels of instruments are given here."""
OTHER_STEP = 0.04
"""Of a coordinate; the screen takes .05."""
SENSORS: dict[str, dict[str, float]] = {
    "accelerometer_offset": {"offset": 0.06},
    "gain": {"gain": 0.04},
    "offset": {"offset_over_peak": 0.04},
    "delay": {"delay": 0.006},
    "clock": {"rate": 0.002},
    "filter": {"corner_hz": 8.0, "order": 2.0, "zero_phase": 0.0},
    "base_filter": {"high_pass_hz": 0.2},
    "base_gain": {"gain": 0.06},
    "drift": {"rate": 0.0005},
    "saturation": {"level_over_peak": 0.6},
    "cross_axis": {"rotation_per_acceleration": 0.0004},
}
"""What instruments do to the recordings of two blocks: one value of each."""


def simulated(
    model: str, true: Mapping[str, float], effect: Mapping[str, Mapping[str, float]], seed: int, pga: float
) -> Recording:
    """Both rotations of two blocks, by the lanes and the instruments, with white noise; ``pga`` in m s-2.

    The base moves vertically where the effect is that this was left out.
    """
    base = as_read(motion(seed, pga=pga), effect)
    if "vertical_acceleration" in effect:
        base = Shaking(base.time_step, base.horizontal, motion(seed + 50, pga=4.0).horizontal, vertical_acts=False)
    own = {f"{m}.{k}": v for m, values in effect.items() if m not in INSTRUMENTS for k, v in values.items()}
    ran = models.get(model).simulate({**true, **own}, moved(base, effect), duration=base.duration)
    names = ("rotation_1", "rotation_2")
    around = Surroundings(base.time_step, base.horizontal, LEVELS_OVER)
    seen = recorded({name: np.asarray(ran.channels[name]) for name in names}, effect, around)
    rng = np.random.default_rng(seed + 1000)  # not the one that made the motion: noise would go with it
    channels = {"base_acceleration_x": base.horizontal}
    if base.vertical is not None:
        channels["base_acceleration_z"] = base.vertical
    for name in names:
        peak = float(np.max(np.abs(seen[name])))
        channels[name] = seen[name] + NOISE * peak * rng.normal(size=seen[name].size)
    return Recording(f"run_{seed}", base.time_step, base.time, channels)


def own_candidates(before: Explanation, specimen: Specimen, name: str, values: Mapping[str, float]) -> list[Candidate]:
    """Those of the mechanism ``name`` that act at every joint alike, with the true whole numbers."""
    true = {f"{name}.{p}": value for p, value in values.items()}
    plain = {f"{name}.{p}" for p in {**before.measured.model.mechanisms, **INSTRUMENTS}[name].nulls}
    found = [c for c in candidates(before.measured, specimen) if c.name == name]
    return [
        c for c in found
        if c.unknowns[0].name in true and {x.name for x in c.unknowns} <= plain and c.held.items() <= true.items()
    ]  # fmt: skip


def true_value(before: Explanation, name: str, values: Mapping[str, float]) -> float:
    """The effect's parameter; a level over the peak is fitted over the one that was seen."""
    value = next(iter(values.values()))
    level = name in INSTRUMENTS and isinstance(INSTRUMENTS[name].parameters[0], Level)
    return value * LEVELS_OVER / before.measured.reference_peak if level else value


def assert_recovered(before: Explanation, own: Sequence[Candidate], truth: float) -> None:
    """``truth``: the true value of the first parameter of the candidates ``own``."""
    seen = [s for s in score(linearise_about(before.fitted), own) if s.starts]
    assert max(s.statistic for s in seen) > 15.0
    after = with_memory(best_of([again(extend(before, s.candidate, start)) for s in seen for start in s.starts]))
    assert before.loss - after.loss > 15.0
    unknown = after.candidates[0].unknowns[0]
    place = [x.name for x in after.fitted.misfit.unknowns].index(unknown.name)
    sandwich, laplace = covariances(after.fitted)
    deviation = np.sqrt(max(sandwich[place, place], laplace[place, place]))
    off = after.fitted.u[place] - unknown.coordinate(truth)
    assert abs(off) < 3.0 * deviation, (after.fitted.values[unknown.name], deviation)


def assert_directions(fitted: Fitted, own: Sequence[Candidate], least: float = 0.99) -> None:
    """The direction in which every candidate moves the residuals is that of a finite difference of another step.

    ``least``: cosine of the angle between them.
    """
    opened = linearise_about(fitted)
    for found in score(opened, own):
        candidate, step = found.candidate, np.zeros(len(found.candidate.unknowns))
        null = candidate.null
        assert found.slope
        step[0] = OTHER_STEP if null[0] < candidate.unknowns[0].bounds[1] else -OTHER_STEP
        back = null if candidate.one_sided else null - step
        r = fitted.misfit.residuals([at(fitted.point, candidate, u) for u in (null + step, back)])
        wanted = opened.reduced((r[0] - r[1]) / (null + step - back)[0])
        # the statistic knows the direction alone; where an impact comes or goes within a step there is no derivative
        along = np.sum(found.column * wanted) / (np.linalg.norm(found.column) * np.linalg.norm(wanted))
        assert along > least, (candidate.name, along)
