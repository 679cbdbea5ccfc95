"""A second effect is sought beside every mechanism that explains as much alone, not only beside the first of them."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.signal import butter, sosfilt

import models
from diagnosis.errors.model import calibrated
from diagnosis.fit.setup import measure
from diagnosis.search import select
from diagnosis.search.candidates import candidates
from diagnosis.search.found import Search
from diagnosis.search.refit import Explanation
from grids.recordings.base import Recording
from tests.diagnosis.made import SPECIMEN, TIME_STEP, TRUE, motion, searched

CORNER, OFFSET = 0.12, 0.25
SOME = ("tilt", "accelerometer_offset", "base_filter", "clock", "delay")


def single(name: str, effect_class: str, gain: float) -> Any:
    return SimpleNamespace(names=(name,), classes=(effect_class,), gain=gain)


def leading(*singles: Any, adequate: bool, monkeypatch: pytest.MonkeyPatch) -> list[list[str]]:
    monkeypatch.setattr(select, "adequate", lambda best: adequate)
    found: Any = SimpleNamespace(singles=list(singles), gain=lambda e: e.gain)
    return [[e.names[0] for e in alike] for alike in select.pool(found, singles[0])]


def test_a_lean_and_an_instrument_that_explains_as_much_are_led_together(monkeypatch: pytest.MonkeyPatch) -> None:
    all_of_them = (
        single("tilt", "tilt", 1000.0), single("tilt", "tilt", 999.0), single("accelerometer_offset", "tilt", 998.0),
        single("eccentricity", "tilt", 997.0), single("gain", "gain", 900.0), single("filter", "filter", 800.0),
        single("delay", "delay", 700.0), single("drift", "drift", 100.0),
    )  # fmt: skip
    both = ["tilt", "accelerometer_offset"]
    assert leading(*all_of_them, adequate=True, monkeypatch=monkeypatch) == [both]
    assert leading(*all_of_them, adequate=False, monkeypatch=monkeypatch) == [both, ["gain"], ["filter"]]
    apart = (all_of_them[0], single("accelerometer_offset", "tilt", 950.0), all_of_them[4])
    assert leading(*apart, adequate=False, monkeypatch=monkeypatch) == [["tilt"], ["gain"]]
    weak = (all_of_them[0], all_of_them[-1])
    assert leading(*weak, adequate=False, monkeypatch=monkeypatch) == [["tilt"]]


def coupled(seed: int) -> Recording:
    """The plain block; its base accelerometer is AC coupled, and what it is read with has an offset."""
    base = motion(seed)
    rotation = np.ravel(models.get("housner").simulate(TRUE, base, duration=base.duration).channels["rotation_1"])
    rng = np.random.default_rng(seed)
    read = sosfilt(butter(1, CORNER, "highpass", fs=1.0 / TIME_STEP, output="sos"), base.horizontal) + OFFSET
    channels = {
        "base_acceleration_x": read + 0.003 * base.pga * rng.normal(size=read.size),
        "rotation_1": rotation + 0.01 * float(np.max(np.abs(rotation))) * rng.normal(size=rotation.size),
    }
    return Recording(f"run_{seed}", TIME_STEP, base.time, channels)


def test_an_offset_behind_an_ac_coupling_is_told_from_a_lean() -> None:
    """Alone both explain the same; with the coupling undone what is taken for a lean would grow with time."""
    measured = measure(SPECIMEN, [coupled(seed) for seed in (1, 2)])
    fitted, errors = calibrated(SPECIMEN, measured)
    some = tuple(c for c in candidates(measured, SPECIMEN) if c.name in SOME)
    found = searched(Search(Explanation((), fitted), some, errors))
    assert found.best is not None
    assert set(found.best.names) == {"accelerometer_offset", "base_filter"}
    assert found.best.fitted.values["base_filter.high_pass_hz"] == pytest.approx(CORNER, rel=0.05)
    assert found.best.fitted.values["accelerometer_offset.offset"] == pytest.approx(OFFSET, rel=0.02)
