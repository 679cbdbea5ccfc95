"""Cases of walls on rubber and of stacks by seed: how many of what, how large an effect is, that a chain reads them."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from benchmarks.diagnosis import bodies, body_size, imperfections, stacks, two_bodies, walls
from benchmarks.diagnosis.files import write_case
from benchmarks.diagnosis.scene import Unsuitable
from grids.instruments import INSTRUMENTS
from grids.recordings import read_recording
from grids.specimen import read_specimen
from models.shaking import Shaking

MODULES = pytest.mark.parametrize("of", [walls, stacks], ids=["walls", "stacks"])


@MODULES
def test_every_effect_is_asked_for_as_often_and_stands_in_the_catalogue(of: ModuleType) -> None:
    asked = of.designs(7)
    assert Counter(design.kind for design in asked) == two_bodies.COUNTS
    singles = Counter(design.names[0] for design in asked if design.kind == "single")
    assert set(singles) == set(of.CATALOGUE) and max(singles.values()) - min(singles.values()) <= 1
    for name, row in of.CATALOGUE.items():
        known = (INSTRUMENTS if row.sensor else of.MODEL.mechanisms)[name]
        assert known.effect_class == row.effect_class and known.parameter(row.parameter).null == row.null
        low, high = known.parameter(row.parameter).low, known.parameter(row.parameter).high
        assert all(low <= end <= high for end in row.ends)


@MODULES
def test_errors_are_shared_out_alike_and_pairs_are_of_two_classes(of: ModuleType) -> None:
    asked = of.designs(7)
    for kind, count in two_bodies.COUNTS.items():
        assert sum(bool(one.imperfection) for one in asked if one.kind == kind) == count // 2
    errors = Counter(one.imperfection for one in asked if one.imperfection)
    assert set(errors) == {*two_bodies.ERRORS, *(imperfections.SCATTER if of is stacks else ())}
    for names in (one.names for one in asked if one.kind == "pair"):
        assert len({of.CATALOGUE[name].effect_class for name in names}) == 2


@MODULES
def test_size_is_nothing_without_an_effect_and_grows_with_one(of: ModuleType) -> None:
    rng = np.random.default_rng(3)
    drawn: tuple[dict[str, float], tuple[str, Shaking, float]] | None = None
    while drawn is None:
        try:
            true = of.BODIES.specimen(rng)[1]
            drawn = true, of.BODIES.motion(true, rng, 22.0)
        except Unsuitable:
            continue
    true, (_, shaking, peak) = drawn
    plain = bodies.Truth(of.BODIES, true, {}, apart=False)
    assert body_size.strength(plain, {}, shaking, peak) < 0.05
    small, twice = (
        body_size.strength(plain, {"offset": {"offset_over_peak": share}}, shaking, peak) for share in (0.05, 0.1)
    )
    assert small > 1.0
    assert twice / small == pytest.approx(2.0, rel=0.1)  # an offset adds, and no refit takes it up


def test_a_dashpot_of_a_layer_takes_up_a_damping_couple() -> None:
    """Many times as strong: no refit by small changes of the parameters finds that."""
    of, rng = walls.BODIES, np.random.default_rng(1)
    taken = []
    while len(taken) < 2:
        try:
            true = of.specimen(rng)[1]
            _, shaking, peak = of.motion(true, rng, 88.0)
        except Unsuitable:
            continue
        truth = bodies.Truth(of, true, {"viscous_damping.couple_damping": 3e5}, apart=False)
        taken.append((body_size.strength(truth, {}, shaking, peak), body_size.left(truth, {}, shaking, peak)))
    assert all(left < change / 3.0 for change, left in taken)


@MODULES
def test_a_case_is_read_as_it_was_made(of: ModuleType, tmp_path: Path) -> None:
    design = next(one for one in of.designs(7) if one.kind == "null" and one.number % 2)
    case = of.make(design, 7)
    write_case(case, tmp_path / "case", tmp_path / "key.json")
    specimen, recording = read_specimen(tmp_path / "case/specimen.toml"), read_recording(tmp_path / "case/train_1.nc")
    assert specimen.model == of.MODEL.name and set(specimen.calibrate) == set(of.BODIES.calibrated)
    assert set(bodies.ROTATIONS) <= set(recording.channels)
    again = of.make(design, 7).channels["train_1"]["rotation_1"]
    np.testing.assert_array_equal(case.channels["train_1"]["rotation_1"], again)


def test_impacts_of_a_stack_scatter_in_a_program_apart() -> None:
    asked = next(one for one in stacks.designs(7) if one.kind == "null" and one.imperfection == "scatter_2")
    asked = replace(asked, number=asked.number | 1)
    made, plain = stacks.make(asked, 7), stacks.make(replace(asked, imperfection=""), 7)
    assert made.key["imperfections"]["scatter"] == 0.02
    assert made.key["program_apart"] and not plain.key["program_apart"]
    for name, channels in made.channels.items():
        for of, seen in channels.items():
            change = np.max(np.abs(seen - plain.channels[name][of])) / np.max(np.abs(seen))
            assert change > 0.1 if of.startswith("rotation") else change < 0.1
