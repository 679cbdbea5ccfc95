"""What was found, in windows that grow with it: more of the recordings is followed, and a wrong law shows there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.diagnosis import rigid_stack
from benchmarks.diagnosis.open_laws import LAWS
from diagnosis.errors.model import calibrated
from diagnosis.fit.setup import measure
from diagnosis.progress import silent
from diagnosis.search.candidates import candidates
from diagnosis.search.found import Search
from diagnosis.search.grown import beside_in_grown_windows, grown
from diagnosis.search.refit import Explanation
from diagnosis.search.select import first_effect
from grids.recordings.base import Recording
from tests.diagnosis.made import TIME_STEP, motion
from tests.diagnosis.search.recovered import simulated
from tests.diagnosis.stacks import NOISE, TRUE, WALL

FINE = 8
"""Steps of the program apart in a sample."""
LOSS = 1.5
"""s-1, of a dashpot that acts on one side only."""
LEAN = 0.02
"""rad; beside the dashpot .015 is at the threshold."""


def recording(seed: int) -> Recording:
    base = motion(seed, pga=6.0)
    n = base.horizontal.size
    fine = np.interp(np.arange((n - 1) * FINE + 1) / FINE, np.arange(n), base.horizontal)
    numbers = (LOSS, *(0.0,) * 6)
    rotations, _ = rigid_stack.run(TRUE, fine, TIME_STEP / FINE, law=LAWS["right_damping"], numbers=numbers)
    rng = np.random.default_rng(seed + 1000)
    channels = {"base_acceleration_x": base.horizontal}
    for name, true in zip(("rotation_1", "rotation_2"), rotations[:, ::FINE], strict=True):
        channels[name] = true + NOISE * np.max(np.abs(true)) * rng.normal(size=n)
    return Recording(f"run_{seed}", TIME_STEP, base.time, channels)


def named(found: Search) -> Search:
    """A search up to its first effect."""
    *_, found = first_effect(found, silent)
    return found


@pytest.fixture(scope="module")
def searches() -> tuple[Search, Search]:
    """A dashpot found where one acts on one side only, before and in windows that grow with it."""
    whole = measure(WALL, [recording(3), recording(4)])
    fitted, errors = calibrated(WALL, whole)
    dashpot = tuple(c for c in candidates(whole, WALL) if c.name == "viscous_damping")
    found = named(Search(Explanation((), fitted), dashpot, errors))
    return found, grown(found, whole)


def test_windows_grow_with_what_was_found_and_none_gets_shorter(searches: tuple[Search, Search]) -> None:
    before, after = searches
    lengths = {(w.recording, w.first): w.samples for w in after.chosen.measured.windows}
    assert before.best is not None and after.best is not None and after.best.names == before.best.names
    assert all(lengths[w.recording, w.first] >= w.samples for w in before.measured.windows)
    assert after.chosen.measured.mask.sum() > 1.1 * before.measured.mask.sum()


def test_what_the_name_leaves_shows_more_in_them(searches: tuple[Search, Search]) -> None:
    before, after = searches
    first, then = (s.tested(s.chosen).tested[0] for s in (before, after))
    assert first.depends_on == then.depends_on == "side"
    assert then.statistic > 1.4 * first.statistic


def test_a_law_that_nothing_else_explains_adds_no_effect_and_is_left_to_be_tested(
    searches: tuple[Search, Search],
) -> None:
    before, _ = searches
    whole = measure(WALL, before.measured.recordings)
    assert not list(beside_in_grown_windows(before, whole, silent))
    assert before.longer is not None
    assert before.longer.chosen.measured.mask.sum() > before.measured.mask.sum()


def test_a_second_effect_that_grown_windows_ask_for_is_added() -> None:
    """The search for the first did not know of a lean: it leaves a force on one side, well beyond the threshold."""
    effect = {"viscous_damping": {"rate": 0.8}, "tilt": {"tilt": LEAN}}
    whole = measure(WALL, [simulated("stacked", TRUE, effect, seed, 6.0) for seed in (1, 2)])
    fitted, errors = calibrated(WALL, whole)
    both = tuple(c for c in candidates(whole, WALL) if c.name in effect)
    dashpot = tuple(c for c in both if c.name == "viscous_damping")
    first = replace(named(Search(Explanation((), fitted), dashpot, errors)), candidates=both)
    *_, found = beside_in_grown_windows(first, whole, silent)
    assert set(found.chosen.names) == set(effect)
    values = found.chosen.fitted.values
    assert values["viscous_damping.rate"] == pytest.approx(0.8, rel=0.1)
    assert values["tilt.tilt"] == pytest.approx(LEAN, rel=0.1)
