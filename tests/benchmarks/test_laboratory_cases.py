"""Cases with a laboratory's errors: the errors have the statistics they are asked for, and the scores know them."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

from benchmarks.diagnosis import beginnings, report, shakings, truth
from benchmarks.diagnosis.cases import make
from benchmarks.diagnosis.effects import CATALOGUE
from benchmarks.diagnosis.imperfections import NAMES, SCATTER, Imperfections, autoregressive, draw, pink
from benchmarks.diagnosis.laboratory import EACH, EFFECTS, suite
from benchmarks.diagnosis.suite import CaseDesign
from diagnosis.prove.report import wrong
from diagnosis.prove.scores import Scored, score
from models.housner.model import MODEL
from models.housner.reference.run import run as reference
from models.runs import Request
from models.shaking import Shaking

GRAVITY = 9.80665
TIME = shakings.STEP * np.arange(801)
COARSE = shakings.scaled(Shaking(shakings.STEP, np.sin(2 * np.pi * 1.2 * TIME) * np.exp(-0.3 * TIME)), 2.2, False)
SHAKING = shakings.on_fine_grid(COARSE)
"""The same motion."""


def own(mechanisms: dict[str, float] | None = None, **more) -> truth.Motion:
    return truth.run(0.3, 1.7, GRAVITY, SHAKING.horizontal, SHAKING.time_step, mechanisms=mechanisms, **more)


@pytest.mark.parametrize(
    ("mechanisms", "share"),
    [
        ({"pivot_inset.inset_over_half_width": 0.05, "restitution.factor_on_housner": 0.93}, 1e-6),
        ({"tilt.tilt": -0.008, "eccentricity.offset_over_half_width": 0.04}, 1e-6),
        ({"added_stiffness.over_m_g_R": 0.3, "added_stiffness.gap": 0.01}, 1e-4),
        ({"velocity_restitution.beta": 0.2, "pivot_inset.inset_over_half_width": 0.1}, 1e-6),
        ({"degradation.loss_of_restitution_per_impact": 0.02, "degradation.floor": 0.93}, 1e-6),
        ({"viscous_damping.rate": 0.3, "quadratic_damping.coefficient": 2.0}, 1e-6),
        ({"coulomb_damping.over_m_g_b": 0.01}, 0.02),  # its change of sign is not located: a step's error a reversal
    ],
)
def test_mechanisms_of_the_own_program_are_those_of_the_reference(mechanisms: dict[str, float], share: float) -> None:
    found = own(mechanisms)
    block = MODEL.build({"width": 0.3, "height": 1.7, "mass": 500.0, **mechanisms, **_gap(mechanisms)})
    slow = reference(block, Request(COARSE, np.ones(1)), 1e-9).samples[0, :, 0]
    assert found.impacts >= 3 and np.max(np.abs(slow)) < 0.5
    still = np.flatnonzero(np.abs(slow) > 0.01 * np.max(np.abs(slow)))[-1]  # rest after many small impacts is a rule
    seen = found.rotation[:: shakings.FINE]
    np.testing.assert_allclose(seen[:still], slow[:still], atol=share * np.max(np.abs(slow)))
    assert np.max(np.abs(own().rotation - found.rotation)) > 0.02 * np.max(np.abs(slow))


def _gap(mechanisms: dict[str, float]) -> dict[str, float]:
    return {"added_stiffness.gap": mechanisms.get("added_stiffness.gap", 0.0)} if "added" in str(mechanisms) else {}


def test_a_kick_alike_at_every_impact_is_another_restitution() -> None:
    e = 1.0 - 1.5 * np.sin(np.arctan2(0.3, 1.7)) ** 2
    kicked = own(kicks=np.full(truth.MOST_IMPACTS, -0.03))
    np.testing.assert_allclose(
        kicked.rotation, own({"restitution.factor_on_housner": (e - 0.03) / e}).rotation, atol=1e-12
    )


def test_mechanisms_act_in_their_intervals_alone() -> None:
    whole, plain = own({"viscous_damping.rate": 0.5}), own()
    begins = own({"viscous_damping.rate": 0.5}, active=[(1.5, 9.0)])
    before = round(1.5 / SHAKING.time_step)
    np.testing.assert_array_equal(begins.rotation[: before + 1], plain.rotation[: before + 1])
    assert np.max(np.abs(begins.rotation - plain.rotation)) > 1e-3
    np.testing.assert_array_equal(own({"viscous_damping.rate": 0.5}, active=[(0.0, 9.0)]).rotation, whole.rotation)


def test_noise_has_the_size_and_colour_asked_for() -> None:
    rng = np.random.default_rng(4)
    red = autoregressive(200_000, 0.9, rng)
    assert np.std(red) == pytest.approx(1.0, rel=0.03)
    assert np.corrcoef(red[1:], red[:-1])[0, 1] == pytest.approx(0.9, abs=0.01)
    power = np.abs(np.fft.rfft(pink(2**17, rng))) ** 2
    slow, fast = np.mean(power[100:200]), np.mean(power[10_000:20_000])
    assert slow / fast == pytest.approx(100.0, rel=0.35)
    still = np.zeros(20_000)
    for errors in (Imperfections(), Imperfections(ar1_share=0.7, ar1_coefficient=0.85), Imperfections(pink_share=0.6)):
        assert np.std(errors.noise(still, 0.005, 0.01, 0.05, rng)) == pytest.approx(5e-4, rel=0.06)
    drifting = Imperfections(drift=0.004).noise(still, 0.005, 0.0, 0.05, rng)
    assert abs(drifting[-1] - drifting[0]) == pytest.approx(2e-4, rel=1e-6)
    growing = Imperfections(proportional=0.02).noise(np.full(20_000, 0.05), 0.005, 0.0, 0.05, rng)
    assert np.std(growing) == pytest.approx(1e-3, rel=0.03)
    line = np.abs(np.fft.rfft(Imperfections(hum=0.01, hum_hz=12.0).noise(still, 0.005, 0.0, 0.05, rng)))
    assert np.argmax(line) == 1200 and np.max(line) * 2 / still.size == pytest.approx(5e-4, rel=1e-3)


def test_scatter_is_about_the_law() -> None:
    kicks = draw("scatter_1", (), 200.0, np.random.default_rng(1)).kicks(50_000, np.random.default_rng(2))
    assert np.std(kicks) == pytest.approx(SCATTER["scatter_1"], rel=0.02) and abs(np.mean(kicks)) < 2e-4


def test_suite_gives_every_imperfection_its_share_from_the_beginning() -> None:
    designs = suite(5)
    assert designs == suite(5) and designs != suite(6)
    counts = Counter(d.kind for d in designs)
    assert counts["null"] >= 80 and counts["single"] >= 80 and counts["pair"] >= 30 and counts["open"] >= 30
    for kind, each in EACH.items():
        assert {sum(d.imperfection == name for d in designs if d.kind == kind) for name in NAMES} == {each}
    third = Counter(d.kind for d in designs[: len(designs) // 3])
    assert all(abs(third[kind] / counts[kind] - 1 / 3) < 0.1 for kind in counts)
    assert {name for d in designs if d.kind == "single" for name in d.names} == set(EFFECTS)
    assert not any("filter" in d.names and d.imperfection == "filter" for d in designs)


def test_a_case_is_the_same_by_seed_and_its_key_says_what_may_be_named() -> None:
    design = CaseDesign(1, "null", (), 0.01, 1.0, "ac_coupling")
    case, again = make(design, 3), make(design, 3)
    assert case.key == again.key and case.key["named_rightly"] == ["base_filter"]
    measured = case.channels["train_1"]["base_acceleration_x"]
    np.testing.assert_array_equal(measured, again.channels["train_1"]["base_acceleration_x"])
    corner = case.key["imperfections"]["sensors"]["base_filter"]["high_pass_hz"]
    assert 0.05 <= corner <= 0.3 and case.key["effects"] == []


def test_scattered_impacts_leave_the_size_of_an_effect_alone() -> None:
    case = make(CaseDesign(2, "single", ("offset",), 0.01, 1.0, "scatter_2"), 3)
    sizes = [case.key["recordings"][name]["strength"] for name in ("train_1", "train_2")]
    assert case.key["weak"] or max(sizes) == pytest.approx(10.0, rel=0.25)


def answered(verdict: str, *names: str) -> dict:
    effects = [{"name": n, "class": n, "parameters": {}, "evidence": 50.0} for n in names]
    return {"verdict": verdict, "effects": effects, "rivals": [], "base": {}, "seconds": 1.0}


def hidden(kind: str, *names: str) -> dict:
    effects = [{"name": n, "class": n, "parameters": {}} for n in names]
    return {
        "kind": kind, "model": "housner", "effects": effects, "true_parameters": {}, "named_rightly": ["base_filter"],
        "imperfections": {"names": ["ac_coupling"]}, "noise_fraction_of_peak": 0.01, "relative_size": 1.0,
    }  # fmt: skip


def test_naming_the_laboratorys_own_instrument_is_no_false_alarm() -> None:
    cases = [
        Scored("1", answered("missing", "base_filter"), hidden("null")),
        Scored("2", answered("missing", "base_filter", "delay"), hidden("null")),
        Scored("3", answered("not_in_library", "base_filter"), hidden("null")),
        Scored("4", answered("missing", "base_filter", "gain"), hidden("single", "gain")),
        Scored("5", answered("missing", "base_filter"), hidden("single", "gain")),
        Scored("6", answered("missing", "base_filter"), hidden("single", "base_filter")),
    ]
    found = score(cases)
    assert (found["false_alarm"]["count"], found["false_alarm"]["of"]) == (2, 3)
    assert (found["class_first"]["count"], found["class_first"]["of"]) == (2, 3)
    assert found["detected"]["count"] == 2
    figures = report.by_imperfection(cases)
    assert figures["by_imperfection"]["ac_coupling"]["counts"]["false_alarm"] == [2, 3]
    assert "ac_coupling" in report.tables(figures) and len(wrong(cases).splitlines()) == 3


def test_what_begins_acts_in_its_intervals_alone() -> None:
    design = next(d for d in beginnings.suite(5) if d.beginning == "a sensor is knocked")
    case = make(design, 5)
    notes = case.key["recordings"]
    assert notes["train_1"]["active"] == () and notes["train_1"]["strength"] < 1e-3
    (begins, ends) = notes["train_2"]["active"][0]
    assert 0.0 < begins < ends == notes["train_2"]["duration"] and notes["train_2"]["cycles"][0] > 0.0
    assert notes["test_1"]["active"] == ((0.0, notes["test_1"]["duration"]),)
    # at rest at the start, and at the end off by the offset, about which the last of the motion dies away
    shift = case.key["effects"][0]["parameters"]["offset_over_peak"] * case.key["over_peak"]
    rotation = case.channels["train_2"]["rotation_1"]
    quiet = round(0.4 * case.sampling_hz)
    noise = notes["train_2"]["noise_std"]["rotation_1"]
    assert abs(np.mean(rotation[:quiet])) < 0.5 * noise
    motion = np.ptp(rotation[-quiet:])
    assert np.mean(rotation[-quiet:]) == pytest.approx(shift, abs=2.0 * noise + 0.1 * motion)
    assert 2.0 * noise + 0.1 * motion < 0.7 * abs(shift)


def test_every_kind_of_beginning_is_asked_for_alike() -> None:
    designs = beginnings.suite(5)
    counts = Counter(d.beginning for d in designs if d.beginning)
    assert len(counts) == 12 and set(counts.values()) == {beginnings.EACH} and counts.total() >= 40
    assert sum(d.kind == "null" for d in designs) == beginnings.NULLS
    for name in beginnings.BEGINNINGS:
        assert set(beginnings.BEGINNINGS[name].ends) <= set(CATALOGUE[beginnings.BEGINNINGS[name].effect].ends)
