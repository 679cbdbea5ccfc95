"""The paragraph: what it says, when, and that it never says the opposite of its numbers."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

import models
from diagnosis.answer.judgement import FITTED, REFIT
from diagnosis.answer.result import (
    Beyond,
    Diagnosis,
    Effect,
    EffectStage,
    Fit,
    Located,
    OtherModel,
    Rival,
    Screened,
    Undecided,
    Verdict,
)
from diagnosis.answer.statement import effect_text, statement
from diagnosis.data.measured import identification_of
from diagnosis.fit.intervals import Estimate
from diagnosis.forces.constancy import BLOW, FOR_A_WHILE, Constancy
from diagnosis.forces.varying import WINDOW
from diagnosis.report import diagnosis_json
from diagnosis.report.page import headline
from diagnosis.search.budget import ENDED
from diagnosis.search.null import LEAST_P
from grids.instruments import INSTRUMENTS
from tests.diagnosis.report.example import diagnosis

ORDER = {"order": Estimate(1.0, 1.0, 1.0, "1")}
HIGH = Effect("filter", "filter", {"high_pass_hz": Estimate(3.6, 3.0, 4.4, "Hz"), **ORDER}, 80.0, 1e-6)
TILT = Effect("tilt", "tilt", {"tilt": Estimate(0.01, 0.009, 0.011, "rad")}, 50.0, 1e-6)
LOW = Effect("filter", "filter", {"corner_hz": Estimate(12.0, 10.0, 15.0, "Hz"), **ORDER}, 80.0, 1e-6)


@pytest.mark.parametrize(
    ("effect", "said", "unsaid"),
    [(HIGH, "high-pass of order 1 at 3.6 Hz", "low-pass"), (LOW, "low-pass of order 1 at 12 Hz", "high-pass")],
)
def test_a_filter_is_named_by_what_it_lets_through(effect: Effect, said: str, unsaid: str) -> None:
    values = {name: value.estimate for name, value in effect.parameters.items()}
    for text in (effect_text(effect, INSTRUMENTS["filter"]), INSTRUMENTS["filter"].says(values)):
        assert said in text and unsaid not in text and "inf" not in text


def said(verdict: Verdict = "missing", **changes: object) -> str:
    return statement(answer(verdict, **changes), models.get("housner"))


def answer(verdict: Verdict = "missing", **changes: object) -> Diagnosis:
    return replace(diagnosis(verdict), **changes)  # type: ignore[arg-type]


def test_nothing_missing_is_stated_with_its_p_value() -> None:
    assert "no stronger than chance, p = 0.41" in said("nothing_missing")


def test_what_recordings_held_out_contradict_is_said_with_both_misfits() -> None:
    text = said("not_in_library", contradicted=(0.037, 0.069))
    assert "predicts recordings held out worse than without: misfit 0.069 of the signal in place of 0.037" in text
    assert "held out worse" not in said("not_in_library") and "Best explanation" not in text
    read = json.loads(diagnosis_json(answer("not_in_library", contradicted=(0.037, 0.069))))
    assert read["fit"]["holdout"]["contradicted"] == [0.037, 0.069]


def test_an_effect_that_needs_more_than_its_range_is_said_with_what_it_needs() -> None:
    beyond = (Beyond("viscous_damping", "rate", 1.0, 1.3209, "s-1", 173.4),)
    text = said("not_in_library", beyond=beyond)
    assert "Viscous damping would have to go on beyond the range of the library: its rate ends at 1 s-1" in text
    assert "1.32 s-1 fits better (evidence 173)" in text and "range of the library" not in said("not_in_library")
    (read,) = json.loads(diagnosis_json(answer("not_in_library", beyond=beyond)))["beyond_range"]
    assert read["effect"] == "viscous_damping" and read["wanted"] == 1.3209


@pytest.mark.parametrize("rests_on", ["one window", "one recording", FITTED, REFIT, ""])
def test_a_refused_suspect_is_named_as_undecided(rests_on: str) -> None:
    suspect = Undecided("saturation", "saturation", 46.2, rests_on)
    found = answer("nothing_missing", p_value=LEAST_P, undecided=suspect)
    text = said("nothing_missing", p_value=LEAST_P, undecided=suspect)
    assert "chance, p" not in text and "nothing is missing" not in text
    assert "saturation gains 46" in text and "p < 1e-6" in text and rests_on in text
    assert ("held out are less likely with it" in text) == (rests_on == FITTED)
    assert ("no more than chance brings" in text) == (rests_on == REFIT)
    assert "not decided" in headline(found) and "saturation" in headline(found)
    read = json.loads(diagnosis_json(found))
    assert read["undecided"] == {
        "name": "saturation",
        "class": "saturation",
        "gain": 46.2,
        "rests_on": rests_on or None,
    }


def test_no_p_value_is_stated_below_the_floor() -> None:
    assert "far beyond chance, p < 1e-6" in said(p_value=LEAST_P)
    assert "p = 0.003" in said(p_value=0.003) and "beyond chance" not in said(p_value=0.003)


def test_a_suspicion_comes_first() -> None:
    wrong = {"train_1": ("rotation_1 has the wrong sign: is it turned?",), "test_1": ("its clock is out of step",)}
    for verdict in ("missing", "nothing_missing"):
        text = said(verdict, suspicions=wrong)
        assert text.startswith("Check this first: train_1: rotation_1 has the wrong sign: is it turned? Check")
        assert "test_1: its clock is out of step. " in text
    read = json.loads(diagnosis_json(answer(suspicions=wrong)))["suspicions"]
    assert [(s["recording"], s["suspicion"]) for s in read] == [(k, v) for k, (v,) in wrong.items()]


def test_what_looks_wrong_in_several_recordings_is_said_once() -> None:
    text = said(suspicions=dict.fromkeys(("train_1", "test_1"), ("its clock is out of step",)))
    assert text.startswith("Check this first: train_1, test_1: its clock is out of step. The model")


def test_a_model_that_explains_nothing_names_nothing() -> None:
    fit = Fit(2.03, 2.03, 0.01, 0.0)
    lost = {"effects": (), "unexplained": True, "train": fit, "holdout": None, "constancy": ()}
    text = said("not_in_library", **lost)
    assert "a name would mean nothing" in text and "not in the library" not in text and "is 2.030 of the signal" in text
    assert "does not explain" in headline(answer("not_in_library", **lost))


def test_a_search_stopped_before_its_first_answer_says_no_more() -> None:
    early = {"effects": (), "rivals": (), "finished": False, "p_value": None, "located": ()}
    text = said("cannot_tell_apart", **early)
    assert "stopped before anything was found" in text and "leaves something out" not in text
    assert headline(answer("cannot_tell_apart", **early)) == "Stopped before anything was found"
    late = answer("cannot_tell_apart", finished=False)
    assert headline(late) == "Stopped early; found so far: pivot inset"
    assert "stopped before its end" in said("cannot_tell_apart", finished=False)


def test_what_was_skipped_is_stated() -> None:
    assert said(skipped=("the bootstrap", "runs from rest")).endswith("left out: the bootstrap, runs from rest.")
    assert "left out" not in said()


def test_a_held_out_recording_without_noise_is_not_measured_by_it() -> None:
    fit = Fit(0.2, 0.012, 1e-4, 0.94)
    assert "(94% of what the noise allows)" in said(holdout=fit)
    assert "hardly bear" not in said(holdout=fit)
    poor = replace(fit, share_of_achievable=0.2)
    assert "so they hardly confirm the explanation" in said(holdout=poor)
    text = said(holdout=replace(fit, noise_free=True))
    assert "noise allows" not in text and "94% of it" in text and "no noise of their own" in text


def test_where_a_model_declares_no_ports_laws_outside_are_said_not_to_be_tested_for() -> None:
    said_so = "Laws outside the library are not tested for"
    found = answer("nothing_missing")
    assert said_so in statement(found, models.get("isolated"))
    assert not any(said_so in statement(found, models.get(name)) for name in ("housner", "stacked", "interface"))


def test_a_dependence_says_on_which_side() -> None:
    rubs = Constancy("coulomb_damping", "side", 40.0, "for theta < 0, to the left")
    text = said("not_in_library", constancy=(rubs,))
    assert "couple against the motion that depends on the side, stronger for theta < 0, to the left." in text
    damps = Constancy("viscous_damping", "side", 35.0, "for theta < 0, to the left")
    assert said("not_in_library", constancy=(rubs, damps)) == text
    late = replace(damps, depends_on="time", stronger="late")
    assert "angular velocity that depends on the time, stronger late" in said("not_in_library", constancy=(rubs, late))
    assert json.loads(diagnosis_json(answer("not_in_library", constancy=(rubs,))))["constancy"][0]["stronger"]


@pytest.mark.parametrize(
    ("gains", "expected"),
    [
        ({"a": 40.0, "b": 22.5}, "the recordings give: a 64%, b 36%."),
        ({"a": 3.0, "b": 57.0}, "give: b 95%, a 5%; without b it would not have been named."),
        ({name: float(k) for k, name in enumerate("abcdef", 10)}, "give: most f 20%, least a 13%."),
    ],
)
def test_what_every_recording_says_is_stated(gains: dict[str, float], expected: str) -> None:
    assert expected in said(provenance={"gain_by_recording": gains})
    assert "the recordings give" not in said(provenance={"gain_by_recording": dict(list(gains.items())[:1])})
    assert "the recordings give" not in said("nothing_missing", provenance={"gain_by_recording": gains})


def test_what_the_budget_did_not_reach_is_said_where_the_library_did_not_suffice() -> None:
    left = {"tilt": ENDED, "a second effect beside gain": ENDED, "vertical_acceleration": "no vertical motion"}
    text = said("not_in_library", not_tried=left)
    assert "ended before it had tried: tilt, a second effect beside gain." in text and "vertical" not in text
    assert "budget" not in said("not_in_library", not_tried={}) + said("missing", not_tried=left)


def test_a_suspect_that_the_budget_did_not_reach_is_said_beside_what_is_named() -> None:
    left = {
        "tilt": ENDED,
        "gain": ENDED,
        "offset": "no channel of it",
        "bounce": ENDED,
        "locking at other joints": ENDED,
    }
    (named,) = {effect.name for effect in diagnosis("missing").effects}
    scores = {named: 100.0, "tilt": 90.0, "gain": 21.0, "offset": 80.0, "bounce": 19.0}
    screen = tuple(Screened(name, name, score, None, None) for name, score in scores.items())
    assert "ended before it had tried: tilt, gain." in said("missing", not_tried=left, screen=screen)
    refitted = tuple(replace(line, gain=3.0) for line in screen)
    assert "budget" not in said("missing", not_tried=left, screen=refitted)


def test_of_several_effects_a_rival_is_said_with_the_one_that_it_would_replace() -> None:
    """Of one there is no other to confuse it with."""
    lean = Rival("eccentricity", "eccentricity", 0.12, "tilt")
    both = {"effects": (LOW, TILT), "rivals": (lean, Rival("delay", "delay", 1.0, "filter"))}
    text = said("cannot_tell_apart", **both)
    assert "cannot tell tilt apart from: eccentricity (0.1 less)." in text
    assert "cannot tell filter apart from: delay (1.0 less)." in text
    alone = {"effects": (TILT,), "rivals": (lean,)}
    assert "cannot tell it apart from: eccentricity (0.1 less)." in said("cannot_tell_apart", **alone)
    assert "Eccentricity would explain nearly as much." in said(**alone)
    text = said(**{**both, "rivals": (lean,)})
    assert "Eccentricity in the place of tilt would explain nearly as much." in text


def test_a_blow_is_said_with_its_instants() -> None:
    blow = Constancy(BLOW, FOR_A_WHILE, 84.0, "from 2.52 s to 2.64 s of shake_2")
    text = said("not_in_library", constancy=(blow,))
    assert "Something acts on it for a moment, from 2.52 s to 2.64 s of shake_2" in text


def test_what_changes_from_window_to_window_is_said() -> None:
    text = said("not_in_library", constancy=(Constancy("restitution", WINDOW, 40.0),))
    assert "at impacts that changes in the course of the recordings, from window to window." in text


def test_a_detail_of_a_strong_law_is_said_and_no_verdict() -> None:
    arm = Effect("tilt", "tilt", {"tilt": Estimate(0.01, 0.009, 0.011, "rad")}, 50_000.0, 1e-6)
    left = Constancy("viscous_damping", "size of the rotation", 61.0)
    threshold = {"constancy_threshold": 515.0}
    text = said("missing", effects=(arm,), detail=left, provenance=threshold)
    assert "(viscous damping, by size of the rotation; evidence 61, where a tenth of the force of the law named" in text
    assert "would have 515): it is taken for a detail of that law." in text
    outside = said("not_in_library", effects=(arm,), detail=left, provenance=threshold)
    assert "detail" not in outside + said("missing", effects=(arm,))


def test_what_begins_is_not_said_to_act_throughout() -> None:
    place = Located("shake_1", "rotation_1", 2.0, 6.0, ("everywhere",), 1.0, "tilt", 0.1, "rad s-2")
    tilt = Effect("tilt", "tilt", {"tilt": Estimate(0.01, 0.009, 0.011, "rad")}, 80.0, 1e-6)
    begins = replace(tilt, stages=(EffectStage("shake_1", 2.0, np.inf),))
    assert "Tilt acts throughout: in shake_1" in said(located=(place,), effects=(tilt,))
    assert "Tilt acts: in shake_1 from 2.0 s to 6.0 s" in said(located=(place,), effects=(begins,))


OSCILLATOR = ("frequency", "damping", "motion", "force")


def test_a_force_of_another_base_model_is_told_in_its_own_words() -> None:
    """What acts in the top joint of a wall is no force that the block it was taken for has."""
    acting = Constancy("stiffness_top", "side", 30.0, "for theta > 0, to the right")
    other = OtherModel("compliant_base", "interface", {}, {"base_stiffness": 5e7}, 200.0, (), True, False)
    found = replace(
        diagnosis(), verdict="not_in_library", constancy=(acting,), effects=(), rivals=(), missing_force=None,
        other_model=other,
    )  # fmt: skip
    (meaning,) = (f.meaning for f in identification_of(models.get("interface")).forces if f.name == acting.parameter)
    assert f"What acts is a {meaning} that depends on the side" in statement(found, models.get("housner"))
    law = {"terms": ({"meaning": "force"},), "oscillator": None, "stages": ()}
    for of, part in ((other, "is no part of extended.toml"), (None, "is part of extended.toml")):
        assert part in statement(replace(found, constancy=(), other_model=of, missing_force=law), models.get("housner"))
        numbers = {"estimate": 3.0, "low95": 2.9, "high95": 3.1}
        swings = {"terms": (), "stages": (), "oscillator": dict.fromkeys(OSCILLATOR, numbers)}
        swinging = replace(found, constancy=(), other_model=of, missing_force=swings)
        assert ("is part of extended.toml" in statement(swinging, models.get("housner"))) is (of is None)


def test_one_spell_seen_by_two_channels_is_one() -> None:
    first = Located("shake_1", "rotation_1", 1.0, 9.0, ("everywhere",), 0.6, "tilt", 0.01, "rad")
    other = replace(first, channel="displacement_1_x", start=1.05, share=0.4)
    later = replace(other, start=10.0, end=11.0)
    assert "in shake_1 from 1.0 s to 9.0 s (100% of it)" in said(located=(first, other), effects=(TILT,))
    assert "2 times" in said(located=(first, other, later), effects=(TILT,))


def test_recordings_of_which_none_gains_have_no_shares() -> None:
    """An effect of a state that was estimated anew may gain in neither: nothing is divided by that."""
    for gains in ({"shake_1": 0.0, "shake_2": -3.0}, {"shake_1": 10.0}):
        found = replace(diagnosis(), provenance={**diagnosis().provenance, "gain_by_recording": gains})
        assert "gain in likelihood" not in statement(found, models.get("housner"))
