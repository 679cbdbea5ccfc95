"""The program apart that moves two stacked blocks in the benchmark, against the model's own lanes."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest

from benchmarks.diagnosis import rigid_stack
from benchmarks.diagnosis.bodies import ROTATIONS
from benchmarks.diagnosis.open_laws import LAWS
from diagnosis.errors.kicks import kicks
from diagnosis.fit.prediction import Point, Predictor
from diagnosis.fit.setup import measure
from grids.recordings.base import Recording
from grids.specimen import Specimen
from models.shaking import Shaking
from models.stacked.model import MODEL

STACK = {
    "wall_length": 0.4, "wall_height": 1.4, "wall_mass": 900.0, "top_length": 0.2, "top_height": 1.1,
    "top_mass": 500.0,
}  # fmt: skip
STEP = 0.001
TIME = STEP * np.arange(2001)
LAW = LAWS["right_restitution"]
KICK = 2e-4
"""Change of the rate after an impact over that before it."""


def shaking() -> Shaking:
    """One and a half sines of .5 s that set the upper block rocking and the wall under it, then rest."""
    return Shaking(STEP, np.where(TIME < 0.75, 2.6 * np.sin(2.0 * np.pi * TIME / 0.5), 0.0))


def lanes(mechanisms: Mapping[str, float]) -> np.ndarray:
    channels = MODEL.simulate({**STACK, **mechanisms}, shaking()).channels
    return np.stack([channels[name] for name in ("rotation_1", "rotation_2", "rotation_rate_1", "rotation_rate_2")])


def apart(mechanisms: Mapping[str, float], size: float = 0.0, kicks: np.ndarray | None = None) -> np.ndarray:
    """Of the program apart, with a law outside the catalogue of this size (so that it compiles once)."""
    numbers = (size, *(6 * (0.0,)))
    found = rigid_stack.run(STACK, shaking().horizontal, STEP, mechanisms, LAW, numbers, kicks=kicks)
    return np.concatenate(found)


def differ(one: np.ndarray, other: np.ndarray) -> float:
    return float(np.sqrt(np.mean((one[:2] - other[:2]) ** 2) / np.mean(other[:2] ** 2)))


@pytest.mark.parametrize(
    "mechanisms",
    [
        {},
        {"restitution.factor_on_housner": 0.9},
        {"restitution.factor_on_housner": 1.1},
        {"pivot_inset.inset_over_half_width": 0.1},
        {"tilt.tilt": 0.008},
        {"eccentricity.offset_over_half_width": 0.04},
        {"viscous_damping.rate": 0.3},
        {"coulomb_damping.over_m_g_b": 0.03},
        {"table_pitch.pitch_per_acceleration": 0.0003, "table_pitch.low_pass_hz": 8.0},
    ],
    ids=lambda mechanisms: "+".join(f"{name}={value}" for name, value in mechanisms.items()) or "plain",
)
def test_both_programs_move_a_stack_alike(mechanisms: dict[str, float]) -> None:
    plain, found = lanes({}), lanes(mechanisms)
    impacts = np.sum(found[0, 1:] * found[0, :-1] < 0.0)
    assert impacts >= 3 and np.max(np.abs(found[1] - found[0])) > 2.0 * np.max(np.abs(found[0]))
    assert not mechanisms or differ(found, plain) > 0.02
    rough = {"coulomb_damping.over_m_g_b", "table_pitch.low_pass_hz"} & set(mechanisms)  # smooth here; filtered apart
    assert differ(apart(mechanisms), found) < (0.02 if rough else 2e-3)


def test_a_law_at_impacts_acts_on_one_side_and_scatter_on_both() -> None:
    assert rigid_stack.knows(LAW) and not rigid_stack.knows(LAWS["sloshing"])
    off, law, scattered = apart({}), apart({}, 0.3), apart({}, kicks=np.full(50, -0.2))
    first = int(np.argmax(np.abs(off[:2] - law[:2]).max(axis=0) > 1e-12))
    assert off[0, first - 2] < 0.0 < off[2, first]  # it has landed on its right corner
    assert differ(law, off) > 0.02 and differ(scattered, off) > 0.02


def test_what_a_scattered_impact_leaves_is_what_the_diagnosis_takes_for_it() -> None:
    """An impact at the base loses more in the program apart: what follows in both bodies is the column of that event.

    The column begins at the first sample after it, up to a sample late: compared are the rates.
    """
    every, plain, checked = 5, apart({}), 0
    recording = Recording("run", every * STEP, TIME[::every], {
        "base_acceleration_x": shaking().horizontal[::every], **dict(zip(ROTATIONS, plain[:2, ::every], strict=True)),
    })  # fmt: skip
    measured = measure(Specimen(title="stack", model="stacked", parameters=STACK), [recording])
    states = np.stack([plain[k, ::every][measured.first] for k in (0, 2, 1, 3)], axis=1)
    found = kicks(Predictor(measured), Point(dict(STACK), states))
    for impact in range(12):
        changed = apart({}, kicks=np.where(np.arange(200) == impact, -KICK, 0.0))
        after = int(np.argmax(np.any(changed != plain, axis=0))) // every + 1
        for e in np.flatnonzero(np.abs(found.sample - 1 - after) <= 1):
            window = measured.windows[found.window[e]]
            begin = after - window.first
            if not 0 <= begin < window.samples - 20:
                continue
            change = (changed - plain)[:2, ::every] / (changed[2, every * after] / plain[2, every * after] - 1.0)
            change = change[:, after : window.first + window.samples]
            column = found.columns[found.window[e], :, begin : window.samples, found.place[e]]
            for seen, true in zip(column, change, strict=True):
                assert np.corrcoef(seen, true)[0, 1] > 0.998
                assert abs(np.diff(seen) @ np.diff(true) / np.sum(np.diff(true) ** 2) - 1.0) < 0.1
            checked += 1
    assert checked >= 6
