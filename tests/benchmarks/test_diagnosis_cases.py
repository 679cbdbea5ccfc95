"""The makers of concealed cases: the same by seed, of the size asked for, true to the physics."""

from __future__ import annotations

import math

import numpy as np
import pytest

from benchmarks.diagnosis import beginnings, instruments, shakings, truth
from benchmarks.diagnosis.cases import drawn, make
from benchmarks.diagnosis.effects import CATALOGUE
from benchmarks.diagnosis.files import write_case
from benchmarks.diagnosis.open_laws import LAWS
from benchmarks.diagnosis.size import NOMINAL
from benchmarks.diagnosis.suite import EVALUATION_SEED, GROUPS, TOO_SMALL, CaseDesign, suite
from benchmarks.diagnosis.unseen_laws import EVERY_LAW, UNSEEN
from grids.instruments import INSTRUMENTS
from grids.recordings import noise_of, read_recording
from grids.specimen import read_specimen
from models import get
from models.housner.model import MODEL
from models.housner.reference import run as reference
from models.runs import Request
from models.shaking import Shaking


@pytest.fixture(scope="module")
def gain_case():
    return make(CaseDesign(3, "single", ("offset",), 0.01, 1.0), 11)


def test_catalogue_is_the_one_that_models_and_sensors_declare() -> None:
    in_windows = {name: one for name, one in INSTRUMENTS.items() if "whole" not in one.acts}
    declared = {**get("housner").mechanisms, **in_windows}
    assert set(CATALOGUE) == {name for name, one in declared.items() if not one.tabulated}
    for name, row in CATALOGUE.items():
        first = declared[name].parameters[0]
        assert (row.parameter, row.effect_class) == (first.name, declared[name].effect_class)
        assert row.null == first.null and row.inverse == first.fit_inverse
        for end in row.ends:
            assert first.low <= end <= first.high
        assert set(row.shapes(np.random.default_rng(0), 0.05)) <= {p.name for p in declared[name].parameters}


def test_same_seed_same_case_and_other_seed_another(gain_case) -> None:
    again = make(CaseDesign(3, "single", ("offset",), 0.01, 1.0), 11)
    assert again.key == gain_case.key and again.specimen == gain_case.specimen
    for name, channels in gain_case.channels.items():
        for channel, values in channels.items():
            np.testing.assert_array_equal(values, again.channels[name][channel])
    design = CaseDesign(3, "null", (), 0.01, 1.0)
    first, same, other = (drawn(design, seed, lambda design, seed, rng: rng.uniform()) for seed in (11, 11, 12))
    assert first == same != other


def test_nominal_size_holds_on_the_exact_motion(gain_case) -> None:
    if not gain_case.key["weak"]:
        sizes = [gain_case.key["recordings"][name]["strength"] for name in ("train_1", "train_2")]
        assert max(sizes) == pytest.approx(NOMINAL, rel=0.15)
    # an offset shifts every window alike: with the base held, 10 times the noise is 10 noises of offset
    value = gain_case.key["effects"][0]["parameters"]["offset_over_peak"]
    shift = abs(value) * gain_case.key["over_peak"]
    noise = min(gain_case.key["recordings"][name]["noise_std"]["rotation_1"] for name in ("train_1", "train_2"))
    assert 0.7 * NOMINAL * noise < shift < 1.5 * NOMINAL * noise


def test_files_read_back_as_an_unsuspicious_recording_with_the_noise_asked_for(gain_case, tmp_path) -> None:
    write_case(gain_case, tmp_path / "case", tmp_path / "keys" / "case.json")
    specimen = read_specimen(tmp_path / "case" / "specimen.toml")
    assert set(specimen.parameters) == {"width", "height", "mass"}
    for name in ("train_1", "train_2", "test_1"):
        recording = read_recording(tmp_path / "case" / f"{name}.nc")
        written = gain_case.key["recordings"][name]["noise_std"]["rotation_1"]
        assert noise_of(recording.channels["rotation_1"]).sigma == pytest.approx(written, rel=0.15)
        assert recording.time_step == pytest.approx(1.0 / gain_case.sampling_hz)
    assert not (tmp_path / "case" / "case.json").exists()


@pytest.mark.parametrize("name", [n for n, row in CATALOGUE.items() if not row.sensor])
def test_null_of_a_row_is_the_base(name: str) -> None:
    row = CATALOGUE[name]
    assert row.at(0.0, row.ends[0]) == row.null
    assert row.at(1.0, row.ends[0]) == pytest.approx(row.ends[0])
    half = row.half(row.ends[0])
    assert half == pytest.approx(row.at(0.5, row.ends[0]))


def test_instruments_do_what_they_say() -> None:
    step = 1e-3
    time = step * np.arange(4000)
    wave, ground = 0.02 * np.sin(2 * np.pi * 1.5 * time), np.cos(2 * np.pi * 3.0 * time)

    def read(name: str, **values: float) -> np.ndarray:
        return instruments.response(wave, ground, step, {name: values}, 0.02)

    inner = slice(200, -200)
    np.testing.assert_allclose(read("gain", gain=0.1), 1.1 * wave)
    np.testing.assert_allclose(read("offset", offset_over_peak=-0.1), wave - 0.002)
    np.testing.assert_allclose(read("delay", delay=0.01)[inner], np.roll(wave, 10)[inner], atol=1e-9)
    late = 0.02 * np.sin(2 * np.pi * 1.5 * 1.01 * time)
    np.testing.assert_allclose(read("clock", rate=0.01)[inner], late[inner], atol=1e-9)
    np.testing.assert_allclose(read("cross_axis", rotation_per_acceleration=0.001), wave + 0.001 * ground)
    assert np.max(np.abs(read("saturation", level_over_peak=0.5))) == pytest.approx(0.01)
    slow = read("filter", corner_hz=1.5, order=1.0)
    assert np.max(np.abs(slow[2000:])) == pytest.approx(0.02 / math.sqrt(2.0), rel=0.01)
    np.testing.assert_allclose(read("drift", rate=0.001), wave + 0.001 * time)
    coupled = instruments.base(ground, step, {"base_filter": {"high_pass_hz": 3.0}})
    assert np.max(np.abs(coupled[2000:])) == pytest.approx(1.0 / math.sqrt(2.0), rel=0.01)
    np.testing.assert_allclose(instruments.base(ground, step, {"base_gain": {"gain": 0.25}}), 0.8 * ground)
    np.testing.assert_allclose(instruments.base(ground, step, {"accelerometer_offset": {"offset": 0.3}}), ground + 0.3)


def test_logger_has_no_phase_shift() -> None:
    time = 6.25e-4 * np.arange(8000)
    wave = np.sin(2 * np.pi * 5.0 * time)
    logged = instruments.logged(wave, 6.25e-4, 100.0, 4.0)
    np.testing.assert_allclose(logged[50:350], np.sin(2 * np.pi * 5.0 * np.arange(400) / 100.0)[50:350], atol=1e-4)


def test_fine_samples_lie_exactly_on_lines() -> None:
    rng = np.random.default_rng(1)
    coarse = shakings.scaled(Shaking(shakings.STEP, rng.normal(size=200)), 3.7, False)
    second = np.diff(shakings.on_fine_grid(coarse).horizontal, n=2)
    kinks = np.flatnonzero(second) + 1
    assert np.all(kinks % shakings.FINE == 0) and kinks.size > 190


@pytest.mark.parametrize("name", ["sloshing", "right_restitution", "slow_pendulum"])
def test_own_program_without_its_law_equals_the_reference(name: str) -> None:
    time = shakings.STEP * np.arange(801)
    shaking = shakings.scaled(Shaking(shakings.STEP, np.sin(2 * np.pi * 1.2 * time) * np.exp(-0.3 * time)), 2.1, False)
    fine = shakings.on_fine_grid(shaking)
    law = {**LAWS, **UNSEEN}[name]
    nothing = truth.Applied(law, 0.0, law.draw(np.random.default_rng(0)), (1.0, 2.0), 0.02)
    own = truth.run(0.3, 1.7, 9.80665, fine.horizontal, fine.time_step, nothing)
    block = MODEL.build({"width": 0.3, "height": 1.7, "mass": 500.0})
    slow = reference.run(block, Request(shaking, np.ones(1)), 1e-9).samples[0, :, 0]  # the same motion
    assert own.impacts >= 4
    np.testing.assert_allclose(own.rotation[:: shakings.FINE], slow, atol=1e-6 * np.max(np.abs(slow)) + 1e-9)


def test_suite_is_balanced_and_deterministic() -> None:
    designs = suite(5)
    assert designs == suite(5) and designs != suite(6)
    main = [w for w in designs if (w.noise, w.relative_size) == (0.01, 1.0)]
    count = {kind: sum(w.kind == kind for w in main) for kind in ("null", "single", "pair", "open")}
    assert count["null"] >= 100 and count["single"] >= 120 and count["pair"] >= 40 and count["open"] >= 40
    singles = [w.names[0] for w in main if w.kind == "single"]
    counts = [singles.count(n) for n in CATALOGUE if n not in TOO_SMALL]
    assert max(counts) - min(counts) <= 1 and sum(counts) == len(singles)
    for first, second in (w.names for w in main if w.kind == "pair"):
        assert CATALOGUE[first].effect_class != CATALOGUE[second].effect_class
    quarter = designs[: len(designs) // 4]
    assert 0.15 < sum(w.kind == "null" for w in quarter) / sum(w.kind == "null" for w in designs) < 0.35
    assert len(designs) == sum(sum(g.counts.values()) for g in GROUPS)
    assert EVALUATION_SEED not in range(1000, 100_000)
    assert {w.names[0] for w in designs if w.kind == "open"} == set(LAWS)
    assert {w.names[0] for w in suite(EVALUATION_SEED) if w.kind == "open"} == set(UNSEEN)
    assert not set(LAWS) & set(UNSEEN)


def test_a_mechanism_of_the_catalogue_at_work_for_a_while_is_no_law_outside() -> None:
    known = {row.effect_class for row in CATALOGUE.values()}
    within = {name for name, law in EVERY_LAW.items() if law.effect}
    assert within == {"passing_stiffness", "late_damping", "passing_loss"}
    for name in within:
        law = EVERY_LAW[name]
        assert law.kind == "single" and law.described(0.3)["class"] == law.effect and law.effect in known
    assert EVERY_LAW["magnet"].kind == "open" and EVERY_LAW["magnet"].described(0.3)["class"] == "open"
    case = make(CaseDesign(0, "open", ("late_damping",), 0.005, 1.0), 771)
    assert case.key["kind"] == "single" and case.key["effects"][0]["class"] == "viscous_damping"
    for name, note in case.key["recordings"].items():
        begins, ends = note["active_interval"]
        length = case.channels[name]["rotation_1"].size / case.sampling_hz
        assert 0.0 < begins < 0.6 * length and ends == pytest.approx(length, abs=0.05)


def test_what_comes_and_goes_in_every_test_has_an_interval_in_each() -> None:
    motions = [Shaking(0.01, np.sin(0.01 * (2 + k) * np.arange(900))) for k in range(3)]
    when = beginnings.draw("a guide rubs in every test", motions, np.random.default_rng(1))
    assert all(len(spans) == 1 and spans[0][1] == pytest.approx(spans[0][0] + beginnings.WHILE) for spans in when)
